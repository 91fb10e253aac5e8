"""A plugin as it was found: what it provides, or why it provides nothing. A value."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

from crowdbot.dsl.spec.component import Component

#: The name under which crowdbot's own components are registered.
BUILTIN = "builtin"


@dataclass(frozen=True, slots=True, kw_only=True)
class Plugin:
    """One plugin, healthy or not.

    Attributes:
        name: of its entry point; the kinds of its components begin with it.
        distribution: name and version of the package, or the path it was loaded from.
        pinned: whether it comes from an installed distribution, whose version says what it is;
            one that was installed to be edited is not.
        given: whether somebody named its path; it need not be installed.
        file: the file of its module, empty where nothing is known.
        api: the version of the hooks that it was written for; None if that is not known.
        sha256: of the files of a plugin that is not pinned; empty otherwise.
        data: SHA-256 of the files that its components declare as their data; empty without any.
        error: why it provides nothing; empty for a healthy one.
        traceback: of the error, where there is one.
    """

    name: str
    distribution: str
    pinned: bool = True
    given: bool = False
    file: str = ""
    api: int | None = None
    sha256: str = ""
    data: str = ""
    components: Sequence[Component[Any]] = ()
    scenario_dirs: tuple[Any, ...] = ()
    error: str = ""
    traceback: str = field(default="", repr=False)

    @property
    def origin(self) -> str:
        """The distribution, and the file where it is another one: for messages."""
        return f"{self.distribution} ({self.file})" if self.file else self.distribution
