"""Files of recorded people in a trial, converted to one table of crowdbot."""

from __future__ import annotations

import math
import re
from pathlib import Path

from crowdbot.core.exchange.companions import companion
from crowdbot.core.exchange.item import Item
from crowdbot.core.exchange.report import Report
from crowdbot.core.exchange.scene import Data, Draft
from crowdbot.core.exchange.source import source_of
from crowdbot.core.exchange.trial.law import Motion
from crowdbot.dsl.text.diagnostics import Diagnostic, Mark, Source
from crowdbot.errors import SpecError

_CELLS = re.compile(r"[,;]")
#: Columns of our tables.
HEADER = "t,id,x,y\n"


class Replays:
    """The replayed people of one trial.

    Args:
        beside: the trial's file.
        name: name of the table that the document names.
        words: variables in paths, such as ``{USER}``, and their values.
    """

    def __init__(self, beside: Path, name: str, words: dict[str, str]) -> None:
        self._beside, self._name, self._words = beside, name, words
        self._rows: list[str] = []

    def add(self, motion: Motion, row: Data, scene: Draft, report: Report) -> str:
        """Read the file of one person; set the start and goal in its row, return its policy.

        Raises:
            SpecError: the file is missing, or is not a table of numbers.
        """
        item, number = motion.file, len(scene.agents)
        assert item is not None
        text = item.text()
        for word, value in self._words.items():
            text = text.replace(word, value)
        path = companion(item, self._beside, text)
        source, content = source_of(path)
        points = read_columns(source, content, motion.columns, item)
        _name_others(source, content, motion.columns, item, report)
        self._rows += [f"{t!r},{number},{x!r},{y!r}\n" for t, x, y in points]
        _, row["x"], row["y"] = points[0]
        row["goals"] = [list(points[-1][1:])]
        row["start_time"] = max(0.0, points[0][0])
        row.pop("heading", None)
        scene.tables[self._name] = HEADER + "".join(self._rows)
        replay: Data = {"policy": {"kind": "replay", "file": self._name}, "costs": {}}
        return scene.policy(replay, "replay", item.mark)


def _name_others(
    source: Source, text: str, columns: dict[str, int], item: Item, report: Report
) -> None:  # fmt: skip
    """Record the columns that are not used."""
    most = max((len(_CELLS.split(line)) for line in text.split("\n")), default=0)
    for column in sorted(set(range(1, most + 1)) - {abs(n) for n in columns.values()}):
        other = Item(f"column {column}", Mark(source))
        other.parent = item
        report.left_out(other, "people follow their recorded places only")


def read_columns(
    source: Source, text: str, columns: dict[str, int], item: Item
) -> list[tuple[float, float, float]]:
    """Return t, x and y in our frame, from raw columns of Unity's X and Z.

    Args:
        source: the file.
        text: its content: cells apart by commas or semicolons, no header.
        columns: ``t``, ``x``, ``z`` -> number of the column from 1; 0: there is none; negative: the
            sign changes.
        item: element that names the file.

    Raises:
        SpecError: a cell is missing or is not a number, or times do not rise.
    """
    found: list[tuple[float, float, float]] = []
    for number, line in enumerate(text.split("\n")):
        if not line.strip():
            continue
        cells = _CELLS.split(line)
        t, x, z = (_cell(cells, columns[name], source, number) for name in ("t", "x", "z"))
        if found and t <= found[-1][0]:
            raise SpecError([_problem(source, number, "times have to rise from line to line")])
        found.append((t, z + 0.0, -x + 0.0))
    if not found:
        item.refuse("the file that it names has no lines")
    return found


def _cell(cells: list[str], column: int, source: Source, line: int) -> float:
    if column == 0:
        return 0.0
    at = abs(column) - 1
    try:
        value = float(cells[at])
    except (IndexError, ValueError):
        raise SpecError([_problem(source, line, f"no number in column {at + 1}")]) from None
    if not math.isfinite(value):
        raise SpecError([_problem(source, line, f"column {at + 1} is not finite")])
    return -value if column < 0 else value


def _problem(source: Source, line: int, message: str) -> Diagnostic:
    return Diagnostic("E402", message, Mark(source, line))
