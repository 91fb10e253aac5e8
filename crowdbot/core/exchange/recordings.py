"""Recorded people: the original's recording, and the trajectories that UMANS writes."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence

import numpy as np

from crowdbot.core.exchange.formats import Context, SceneFormat
from crowdbot.core.exchange.item import LARGEST, Item
from crowdbot.core.exchange.opened import OpenedScene
from crowdbot.core.exchange.report import UNKNOWN, Report
from crowdbot.core.exchange.rows import Row, RowTable
from crowdbot.core.exchange.scene import Draft, around, id_of
from crowdbot.core.exchange.trial.replays import HEADER
from crowdbot.core.trajectories.data_sets.homography import VideoScale, projected
from crowdbot.core.trajectories.raw_table import as_number
from crowdbot.core.trajectories.table_columns.names import FRAMES, USUAL_NAMES
from crowdbot.core.trajectories.table_columns.units import unit_of, without_unit
from crowdbot.core.trajectories.text_table import SEPARATOR_LINE
from crowdbot.dsl.text.diagnostics import Diagnostic, Mark
from crowdbot.errors import SpecError

_NAMES = {
    "t": ("t", *(name for name in USUAL_NAMES["t"] if name not in FRAMES)),
    "frame": FRAMES,
    **{name: (name, *USUAL_NAMES[name]) for name in ("id", "x", "y")},
    "entity": ("entity", "type", "kind"),
}
#: Columns that follow from the places.
_FOLLOWING = {"yaw", "heading", "theta", "angle", "orientation", "vx", "vy", "vel_x", "vel_y",
              "velocity_x", "velocity_y", "speed"}  # fmt: skip
#: Columns of a file without a header: UMANS' time, place and viewing direction of one agent.
_BARE = {"t": 0, "x": 1, "y": 2}
_NUMBERED = re.compile(r"(\d{1,9})$")
RECORDING = RowTable(
    "CSV with a header",
    (
        Row("time or frame, id, x, y", "crowd.policy replay.file"),
        Row("yaw, vx, vy and the like", "", "they follow from the places"),
        Row("entity robot", "", "a planner drives the robot here"),
    ),
)
WRITTEN = RowTable(
    "output_ID.csv",
    (
        Row("column 1 to 3", "crowd.policy replay.file", "time, x and y; ID is that of the name"),
        Row("column 4 and 5", "", "the viewing direction: people look where they walk"),
    ),
)


def read(files: Sequence[OpenedScene], context: Context) -> list[Draft]:
    """Return one scene in which all people of the files walk as recorded.

    Raises:
        SpecError: E402, a cell is not a number, or two files have the same person.
    """
    people: dict[int, list[tuple[float, float, float]]] = {}
    for file in files:
        for ident, points in _people(file, context.report, context.scale).items():
            if ident in people:
                raise SpecError([Diagnostic("E402", f"person {ident} is in two files", file.top)])
            people[ident] = points
    if not people:
        raise SpecError([Diagnostic("E402", "no person has two lines", files[0].top)])
    scene = Draft(id_of(files[0].path.stem))
    table = f"{context.name}.recorded.csv"
    rows = [(t, ident, x, y) for ident, points in people.items() for t, x, y in points]
    scene.tables[table] = HEADER + "".join(
        f"{t!r},{i},{x!r},{y!r}\n" for t, i, x, y in sorted(rows)
    )
    xs, ys = [row[2] for row in rows], [row[3] for row in rows]
    scene.environment["area"] = around(min(xs), max(xs), min(ys), max(ys))
    scene.policy({"policy": {"kind": "replay", "file": table}, "costs": {}}, "replay", files[0].top)
    scene.notes.append(f"Imported from recordings: {', '.join(f.path.name for f in files)}.")
    context.report.added("environment", "an open floor: a recording has no walls", files[0].top)
    return [scene]


def _people(
    file: OpenedScene, report: Report, scale: VideoScale
) -> dict[int, list[tuple[float, float, float]]]:
    lines = file.text.split("\n")
    top = _top(lines)
    between = _separator(lines[top])
    head = lines[top].split(between)
    columns = _columns(head)
    bare = not columns
    if columns and "t" not in columns and scale.frame_rate is None:
        mark = Mark(file.source, top, 0, max(1, len(lines[top])))
        message = "its times are numbers of frames; --frame-rate says how many a second has"
        raise SpecError([Diagnostic("E402", message, mark)])
    number = _NUMBERED.search(file.path.stem)
    names = _names([line.split(between) for line in lines[top + 1 :]], columns)
    units = {name: unit_of(name, head[at].strip().strip('"'), 1.0) for name, at in columns.items()}
    found: dict[int, list[tuple[float, float, float]]] = {}
    robots: list[_Row] = []
    marks: dict[int, Mark] = {}
    for at in range(top if bare else top + 1, len(lines)):
        if _is_empty(lines[at]):
            continue
        row = _Row(file, at, lines[at].split(between), columns or _BARE, units)
        if not bare and "entity" in columns and row.text("entity").lower().startswith("robot"):
            robots.append(row)
            continue
        row.end(len(head))
        ident = int(number[1]) if bare and number else row.person(names) if not bare else 0
        point = (row.time(scale.frame_rate), row.number("x"), row.number("y"))
        points = found.setdefault(ident, [])
        marks.setdefault(ident, row.mark)
        if points and point[0] <= points[-1][0]:
            row.refuse("the times of a person have to rise")
        points.append(point)
    whole = _record(file, report, head, bare, top)
    if robots:
        report.left_out(whole.add(Item("robot", robots[0].mark)), RECORDING.rows[2].note)
    for ident in (ident for ident, points in found.items() if len(points) == 1):
        person = whole.add(Item(f"person {ident}", marks[ident]))
        report.left_out(person, "it has one line only: recorded people need two")
    return {
        ident: _in_metres(file, points, scale) for ident, points in found.items() if len(points) > 1
    }


def _in_metres(
    file: OpenedScene, points: list[tuple[float, float, float]], scale: VideoScale
) -> list[tuple[float, float, float]]:
    """Return points (t, x, y) with x and y in metres."""
    if scale.homography is None:
        return points
    rows = np.array(points)
    rows[:, 1:] = projected(file.path, scale.homography, rows[:, 1:])
    return [(t, x, y) for t, x, y in rows.tolist()]


def _names(rows: Sequence[Sequence[str]], columns: Mapping[str, int]) -> dict[str, int]:
    """Return name -> number of people, in order of appearance; empty if all ids are numbers."""
    at = columns.get("id", 0)
    found = dict.fromkeys(row[at].strip().strip('"') for row in rows if len(row) > at)
    if not columns or not any(c.isalpha() for name in found for c in name):
        return {}
    return {name: number for number, name in enumerate(found)}


def _is_empty(line: str) -> bool:
    """Return True for a line without cells: blank, a comment, or a spreadsheet's ``sep=;``."""
    return (
        not line.strip()
        or line.lstrip().startswith("#")
        or SEPARATOR_LINE.fullmatch(line) is not None
    )


def _top(lines: Sequence[str]) -> int:
    """Return the number of the first line with cells; 0 if there is none."""
    return next((at for at, line in enumerate(lines) if not _is_empty(line)), 0)


def _separator(line: str) -> str | None:
    """Return the separator between the cells of a line; None if they are separated by blanks."""
    return next((mark for mark in "\t;," if mark in line), None)


def _columns(head: Sequence[str]) -> dict[str, int]:
    """Return our name -> column of a header; empty without a header."""
    names = [without_unit(cell.strip().strip('"')).lower() for cell in head]
    found = {
        ours: names.index(theirs)
        for ours, known in _NAMES.items()
        for theirs in known[::-1]
        if theirs in names
    }
    timed = "t" in found or "frame" in found
    return found if timed and {"id", "x", "y"} <= set(found) else {}


def _record(file: OpenedScene, report: Report, head: Sequence[str], bare: bool, top: int) -> Item:
    """Record the columns of a file; return an item that represents the file."""
    table = WRITTEN if bare else RECORDING
    whole = Item(table.element, Mark(file.source))
    report.carried(whole, table.rows[0].ours)
    used = set((_columns(head) or _BARE).values())
    column = 0
    for at, cell in enumerate(head):
        name = cell.strip().strip('"') or f"column {at + 1}"
        if at not in used:
            mark = Mark(file.source, top, column, max(1, len(cell)))
            known = bare or without_unit(name).lower() in _FOLLOWING
            other = whole.add(Item(f"column {at + 1}" if bare else name, mark))
            report.left_out(other, table.rows[1].note if known else UNKNOWN)
        column += len(cell) + 1
    return whole


class _Row:
    """One line of a table; errors in its cells name their position."""

    def __init__(
        self, file: OpenedScene, line: int, cells: Sequence[str], columns: dict[str, int],
        units: Mapping[str, float],
    ) -> None:  # fmt: skip
        self._file, self._line, self._cells, self._columns = file, line, cells, columns
        self._units = units

    def text(self, name: str) -> str:
        """Return a cell as text."""
        at = self._columns[name]
        if at >= len(self._cells):
            self.refuse(f"there is no column {at + 1} ({name})")
        return self._cells[at].strip().strip('"')

    def number(self, name: str) -> float:
        """Return a cell as a finite number."""
        try:
            value = as_number(self.text(name))
        except ValueError:
            value = math.nan
        if not abs(value) <= LARGEST:
            self.refuse(f"{name} is {self.text(name)[:40]!r}, and has to be a finite number")
        return value * self._units.get(name, 1.0)

    def time(self, frame_rate: float | None) -> float:
        """Return its time, s."""
        value = self.number("t" if "t" in self._columns else "frame")
        return value if frame_rate is None else value / frame_rate

    def person(self, names: Mapping[str, int]) -> int:
        """Return the number of its person, from names if people have some."""
        return names[self.text("id")] if names else self.whole("id")

    def whole(self, name: str) -> int:
        """Return a cell as a whole number that is not negative."""
        value = self.number(name)
        if value != int(value) or value < 0:
            self.refuse(f"{name} is {self.text(name)[:40]!r}, and has to be a whole number")
        return int(value)

    @property
    def mark(self) -> Mark:
        """Return its position in the file."""
        return Mark(self._file.source, self._line)

    def end(self, columns: int) -> None:
        """Refuse cells that the first line has no column for."""
        if any(cell.strip() for cell in self._cells[columns:]):
            self.refuse(f"{len(self._cells)} cells, and the first line has {columns}")

    def refuse(self, message: str) -> None:
        """Raise a SpecError at this line."""
        raise SpecError([Diagnostic("E402", message, self.mark)])


def _is_recording(file: OpenedScene) -> bool:
    if file.kind != "text":
        return False
    lines = file.text.split("\n")
    first = lines[_top(lines)]
    between = _separator(first)
    cells = [cell.strip() for cell in first.split(between)]
    numbers = all(re.fullmatch(r"[-+0-9.eE]+", cell) for cell in cells)
    # Four numbers are a frame, a person and a place in other files.
    bare = numbers and len(cells) in (3, 5) and between is not None
    return bool(_columns(cells)) or bare


RECORDINGS = SceneFormat(
    "recordings",
    "recorded people as CSV",
    _is_recording,
    read,
    (RECORDING, WRITTEN),
    "robots and walls",
)
