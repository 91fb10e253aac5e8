"""A component: a spec type and, as text, the function that turns a spec into deeds."""

from __future__ import annotations

import importlib
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Generic, TypeVar

from crowdbot.dsl.base import ComponentSpec
from crowdbot.errors import PluginError

S_co = TypeVar("S_co", bound=ComponentSpec, covariant=True)


@dataclass(frozen=True, slots=True, kw_only=True)
class Component(Generic[S_co]):
    """Something pluggable.

    Attributes:
        spec: pydantic model whose ``kind`` is a Literal, e.g. ``Literal["acme.swarm"]``.
        build: ``"package.module:function"``; imported when something is simulated or scored.
        summary: one line, shown by ``crowdbot plugins``.
        spec_version: raised when the meaning of a field changes.
        examples: valid documents without ``kind``, fed to docs and conformance checks.
    """

    spec: type[S_co]
    build: str
    summary: str
    spec_version: int = 1
    examples: tuple[Mapping[str, Any], ...] = ({},)

    @property
    def kind(self) -> str:
        """The component's name in YAML."""
        (kind,) = self.spec.model_fields["kind"].annotation.__args__  # type: ignore[union-attr]
        return str(kind)

    @property
    def category(self) -> str:
        """What can be plugged: environment, robot, sensor and so on."""
        return self.spec.category

    def load_build(self) -> Callable[..., Any]:
        """Import the build function.

        Raises:
            PluginError: the reference does not resolve.
        """
        module, _, name = self.build.partition(":")
        try:
            function = getattr(importlib.import_module(module), name)
        except (ImportError, AttributeError) as error:
            raise PluginError(f"{self.kind}: build '{self.build}' not found: {error}") from error
        return function  # type: ignore[no-any-return]
