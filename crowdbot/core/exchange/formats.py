"""Formats of scenes: how their files are recognised, and their readers."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from crowdbot.core.exchange.opened import OpenedScene, open_file_of_others
from crowdbot.core.exchange.report import Report
from crowdbot.core.exchange.rows import RowTable
from crowdbot.core.exchange.scene import Draft
from crowdbot.core.registry.registry import Registry
from crowdbot.core.trajectories.data_sets.homography import AS_STATED, VideoScale


@dataclass(frozen=True, slots=True)
class Context:
    """Input of a format's reader: report, components and name.

    Attributes:
        report: where each part is recorded.
        registry: the installed components.
        name: name of the document.
        opened: the files that were opened, by their resolved paths.
        scale: units of tables of recorded people.
    """

    report: Report
    registry: Registry
    name: str
    opened: dict[Path, OpenedScene] = field(default_factory=dict)
    scale: VideoScale = AS_STATED

    def open(self, path: Path) -> OpenedScene:
        """Open a file; one that is given and named by another is read once.

        Raises:
            SpecError: E401, it cannot be read or parsed.
        """
        where = path.resolve()
        if where not in self.opened:
            self.opened[where] = open_file_of_others(path, self.report)
        return self.opened[where]


Reader = Callable[[Sequence[OpenedScene], Context], list[Draft]]


@dataclass(frozen=True, slots=True)
class SceneFormat:
    """A file format of scenes: how it is recognised, and its reader.

    Attributes:
        name: short name.
        title: readable name, with its program.
        fits: True for a file of this format.
        read: returns the scenes of all its files together.
        tables: its conversion tables, for the documentation.
        loses: one sentence on what crowdbot cannot represent, for the documentation.
    """

    name: str
    title: str
    fits: Callable[[OpenedScene], bool]
    read: Reader
    tables: Sequence[RowTable]
    loses: str = ""
