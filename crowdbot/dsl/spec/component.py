"""A component: a spec type and, as text, its build function."""

from __future__ import annotations

import sys
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Generic, TypeVar

from crowdbot.dsl.spec.spec import ComponentSpec
from crowdbot.errors import PluginError

if TYPE_CHECKING:
    from importlib.resources.abc import Traversable

S_co = TypeVar("S_co", bound=ComponentSpec, covariant=True)


@dataclass(frozen=True, slots=True, kw_only=True)
class Component(Generic[S_co]):
    """A plugin's component: a spec, the name of its build function, a summary.

    Attributes:
        spec: pydantic model whose ``kind`` is a Literal, e.g. ``Literal["acme.swarm"]``.
        build: ``"package.module:function"``; imported when something is simulated or scored.
            Default: ``build`` beside the spec; that of ``package.x:XSpec`` is
            ``package.x_build:build``.
        summary: one line, shown by ``crowdbot plugins``.
        spec_version: raised when the meaning of a field changes.
        examples: valid documents without ``kind``, fed to docs and conformance checks.
        experimental: True if its meaning may still change; such metrics are scored on request.
        successor: replacement of this retired kind, named in the error for using it.
        card: explanation of a metric's numbers; Markdown, or ``"package:folder/name.md"``, a file
            of a package. Default: ``cards/NAME.md`` beside the spec's module, where NAME is the
            kind without the plugin's name. A metric without a card is refused.
        exceptions: conformance check -> why this component cannot pass it; then it must fail.
    """

    spec: type[S_co]
    build: str = ""
    summary: str
    spec_version: int = 1
    examples: tuple[Mapping[str, Any], ...] = ({},)
    experimental: bool = False
    successor: str = ""
    card: str = ""
    exceptions: Mapping[str, str] = field(default_factory=dict)

    def __post_init__(self) -> None:
        """Fill in the default build function."""
        if not self.build:
            object.__setattr__(self, "build", f"{self.spec.__module__}_build:build")

    @property
    def kind(self) -> str:
        """Return the component's name in YAML."""
        (kind,) = self.spec.model_fields["kind"].annotation.__args__  # type: ignore[union-attr]
        return str(kind)

    @property
    def category(self) -> str:
        """Return the category: environment, robot, sensor and so on."""
        return self.spec.category

    @property
    def card_place(self) -> str:
        """Return the card's location: ``package:path``; empty if it is the Markdown itself."""
        if self.card:
            return "" if any(c.isspace() for c in self.card) else self.card
        package = getattr(sys.modules.get(self.spec.__module__), "__package__", None)
        return f"{package}:cards/{self.kind.rpartition('.')[2]}.md" if package else ""

    def has_card(self) -> bool:
        """Return True if the component has a card; accesses the file system once."""
        if not self.card_place:
            return bool(self.card)
        try:
            return self._card_file().is_file()
        except (ImportError, TypeError):
            return False

    def read_card(self) -> str:
        """Return the card as Markdown.

        Raises:
            PluginError: there is none, or it cannot be read.
        """
        if not self.has_card():
            raise PluginError(
                f"{self.kind}: no card{f' {self.card_place}' * bool(self.card_place)}"
            )
        try:
            return self._card_file().read_text(encoding="utf-8") if self.card_place else self.card
        except (OSError, UnicodeDecodeError) as error:
            raise PluginError(f"{self.kind}: the card cannot be read: {error}") from error

    def _card_file(self) -> Traversable:
        from importlib.resources import files

        package, _, path = self.card_place.partition(":")
        return files(package).joinpath(path)
