"""A discovered plugin: its components, or the error that prevents them. A value."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from traceback import format_exception
from typing import Any

from crowdbot.core.registry.component_list import ComponentList
from crowdbot.dsl.spec.component import Component
from crowdbot.errors import CrowdbotError

#: The name of crowdbot's own plugin.
BUILTIN = "builtin"


@dataclass(frozen=True, slots=True, kw_only=True)
class Plugin:
    """One plugin, working or not.

    Attributes:
        name: name of its entry point; prefix of its components' kinds.
        distribution: name and version of the package, or the path it was loaded from.
        pinned: True if it comes from an installed distribution, identified by its version; False
            for an editable installation.
        given: True if the user named its path; such a plugin need not be installed.
        file: file of its module; empty if unknown.
        api: version of the hooks that it was written for; None if unknown.
        sha256: hash of the files of a plugin that is not pinned; empty otherwise.
        error: reason why it could not be loaded; empty if it was.
        traceback: traceback of the error, if there is one.
    """

    name: str
    distribution: str
    pinned: bool = True
    given: bool = False
    file: str = ""
    api: int | None = None
    sha256: str = ""
    components: Sequence[Component[Any]] = ()
    scenario_dirs: tuple[Any, ...] = ()
    error: str = ""
    traceback: str = field(default="", repr=False)

    @property
    def origin(self) -> str:
        """Return the distribution, and the file if different: for messages."""
        return f"{self.distribution} ({self.file})" if self.file else self.distribution

    @property
    def data(self) -> str:
        """SHA-256 of the files that its components declare as their data; empty without any."""
        listed = self.components
        return listed.data_digest if isinstance(listed, ComponentList) else ""

    def import_components(self) -> None:
        """Import all components that the plugin names as text; errors are in `failure`."""
        len(self.components)

    @property
    def failure(self) -> str:
        """Error of the plugin, or of the categories that it could not provide; or empty."""
        late = (f"{category}: {error}" for category, error in self._late_errors.items())
        return self.error or "; ".join(late)

    @property
    def failure_traceback(self) -> str:
        """Return the traceback of `failure`, where there is one."""
        late = (error.__cause__ or error for error in self._late_errors.values())
        return self.traceback or "\n".join("".join(format_exception(e)) for e in late)

    @property
    def _late_errors(self) -> Mapping[str, CrowdbotError]:
        return self.components.errors if isinstance(self.components, ComponentList) else {}
