"""Recorded people: the original's recording, and the trajectories that UMANS writes."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from typing import NoReturn

import numpy as np

from crowdbot.core.exchange.formats import Context, SceneFormat
from crowdbot.core.exchange.item import LARGEST, Item
from crowdbot.core.exchange.opened import OpenedScene
from crowdbot.core.exchange.report import UNKNOWN, Report
from crowdbot.core.exchange.rows import Row, RowTable
from crowdbot.core.exchange.scene import Draft, around, id_of
from crowdbot.core.exchange.trial.replays import HEADER
from crowdbot.core.trajectories.data_sets.homography import VideoScale, projected
from crowdbot.core.trajectories.data_sets.people_files import holds_people, people_run, people_table
from crowdbot.core.trajectories.raw_table import Ids, RawTable, as_number
from crowdbot.core.trajectories.table_columns.units import without_unit
from crowdbot.dsl.text.diagnostics import Diagnostic, Mark
from crowdbot.errors import SpecError

#: Columns that follow from the places.
_FOLLOWING = {"yaw", "heading", "theta", "angle", "orientation", "vx", "vy", "vel_x", "vel_y",
              "velocity_x", "velocity_y", "speed", "ori_x", "ori_y"}  # fmt: skip
_NOTES = {
    "z": "people walk on one floor",
    "geometry": "give the floor with environment.kind: floor_plan and its WKT",
}
#: First columns of a file without a header: UMANS' time and place of one agent.
_BARE = ("t", "x", "y")
#: Later first times are those of a clock, not of a run, s.
_LATE = 3600.0
#: t (s), x and y (m).
Sample = tuple[float, float, float]
_NUMBERED = re.compile(r"(\d{1,9})$")
RECORDING = RowTable(
    "CSV with a header",
    (
        Row("time or frame, id, x, y", "crowd.policy replay.file"),
        Row("yaw, vx, vy and the like", "", "they follow from the places"),
        Row("id or entity robot", "", "a planner drives the robot here"),
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
        InputError: a table of people cannot be read; the message has its line.
    """
    people: dict[int, list[Sample]] = {}
    for file in files:
        bare = _is_bare(file)
        for ident, points in (
            _written(file, context) if bare else _recorded(file, context)
        ).items():
            if ident in people:
                raise SpecError([Diagnostic("E402", f"person {ident} is in two files", file.top)])
            people[ident] = points
    if not people:
        raise SpecError([Diagnostic("E402", "no person has two lines", files[0].top)])
    scene = Draft(id_of(files[0].path.stem))
    table = f"{context.name}.recorded.csv"
    rows = [(t, ident, x, y) for ident, points in people.items() for t, x, y in points]
    rows = _from_zero(rows, context.report, files[0])
    scene.tables[table] = HEADER + "".join(
        f"{t!r},{i},{x!r},{y!r}\n" for t, i, x, y in sorted(rows)
    )
    xs, ys = [row[2] for row in rows], [row[3] for row in rows]
    scene.environment["area"] = around(min(xs), max(xs), min(ys), max(ys))
    scene.policy({"policy": {"kind": "replay", "file": table}, "costs": {}}, "replay", files[0].top)
    scene.notes.append(f"Imported from recordings: {', '.join(f.path.name for f in files)}.")
    context.report.added("environment", "an open floor: a recording has no walls", files[0].top)
    return [scene]


def _from_zero(
    rows: list[tuple[float, int, float, float]], report: Report, file: OpenedScene
) -> list[tuple[float, int, float, float]]:
    """Return rows whose times count from the first where the clock is none of a run's."""
    first = min(row[0] for row in rows)
    if 0.0 <= first <= _LATE:
        return rows
    note = f"times are counted from the first, {first:.10g} s"
    report.interpreted(Item("t", file.top), RECORDING.rows[0].ours, note)
    return [(t - first, ident, x, y) for t, ident, x, y in rows]


def _recorded(file: OpenedScene, context: Context) -> dict[int, list[Sample]]:
    """Return the people of a table that names its columns, or of a data set."""
    table = people_table(file.path, context.scale)
    run = people_run(table, table.notes)
    assert run.agents is not None
    whole = Item(RECORDING.element, Mark(file.source))
    context.report.carried(whole, RECORDING.rows[0].ours)
    _record_unused(file, whole, table, context.report)
    found = {}
    for n, ident in enumerate(run.agents.id.tolist()):
        x, y = run.agents.x[:, n], run.agents.y[:, n]
        there = np.isfinite(x) & np.isfinite(y)
        points = np.column_stack([run.t[there], x[there], y[there]]).tolist()
        if len(points) > 1:
            found[ident] = [(t, x, y) for t, x, y in points]
            continue
        line = _first_line(table, ident)
        person = whole.add(Item(f"person {ident}", Mark(file.source, line)))
        context.report.left_out(person, "it has one line only: recorded people need two")
    return found


def _first_line(table: RawTable, ident: int) -> int:
    """Return the first line of a person, from 0."""
    row = int(np.argmax(Ids(table).rows == ident))
    return table.lines[row] - 1 if len(table.lines) else 0


def _record_unused(file: OpenedScene, whole: Item, table: RawTable, report: Report) -> None:
    """Record the columns that are not read, at the line that names them."""
    lines = file.text.split("\n")
    wanted = [name for name in table.header if name]
    top = next((n for n, line in enumerate(lines) if all(c in line for c in wanted)), 0)
    column = 0
    for name in table.header:
        column = max(column, lines[top].find(name, column))
        if name in table.unused:
            known = without_unit(name).lower()
            mark = Mark(file.source, top, column, max(1, len(name)))
            item = whole.add(Item(name or "column without a name", mark))
            notes = dict.fromkeys(_FOLLOWING, RECORDING.rows[1].note)
            report.left_out(item, (notes | _NOTES).get(known, UNKNOWN))
        column += len(name)


def _written(file: OpenedScene, context: Context) -> dict[int, list[Sample]]:
    """Return the person whose times and places a program has written without a header."""
    if context.scale.frame_rate is not None:
        raise SpecError([Diagnostic("E402", "its times are seconds: no --frame-rate", file.top)])
    number = _NUMBERED.search(file.path.stem)
    lines = [(at, line) for at, line in enumerate(file.text.split("\n")) if not _is_empty(line)]
    between = _separator(lines[0][1])
    width = len(lines[0][1].split(between))
    points: list[Sample] = []
    for at, line in lines:
        point = _sample(file, at, line.split(between), width)
        if points and point[0] <= points[-1][0]:
            _refuse(file, at, "the times of a person have to rise")
        points.append(point)
    whole = Item(WRITTEN.element, Mark(file.source))
    context.report.carried(whole, WRITTEN.rows[0].ours)
    for at in range(len(_BARE), width):
        item = whole.add(Item(f"column {at + 1}", Mark(file.source, lines[0][0])))
        context.report.left_out(item, WRITTEN.rows[1].note)
    return {int(number[1]) if number else 0: _in_metres(file, points, context.scale)}


def _sample(file: OpenedScene, at: int, cells: Sequence[str], width: int) -> Sample:
    """Return t, x and y of a line."""
    if len(cells) != width:
        _refuse(file, at, f"{len(cells)} cells, and the first line has {width}")
    found = []
    for name, cell in zip(_BARE, cells, strict=False):
        try:
            value = as_number(cell.strip().strip('"'))
        except ValueError:
            value = math.nan
        if not abs(value) <= LARGEST:
            _refuse(file, at, f"{name} is {cell.strip()[:40]!r}, and has to be a finite number")
        found.append(value)
    return found[0], found[1], found[2]


def _refuse(file: OpenedScene, line: int, message: str) -> NoReturn:
    """Raise a SpecError at a line."""
    raise SpecError([Diagnostic("E402", message, Mark(file.source, line))])


def _in_metres(file: OpenedScene, points: list[Sample], scale: VideoScale) -> list[Sample]:
    """Return points (t, x, y) with x and y in metres."""
    if scale.homography is None:
        return points
    rows = np.array(points)
    rows[:, 1:] = projected(file.path, scale.homography, rows[:, 1:])
    return [(t, x, y) for t, x, y in rows.tolist()]


def _is_empty(line: str) -> bool:
    """Return True for a line without cells: blank, or a comment."""
    return not line.strip() or line.lstrip().startswith("#")


def _separator(line: str) -> str | None:
    """Return the separator between the cells of a line; None if they are separated by blanks."""
    return next((mark for mark in "\t;," if mark in line), None)


def _is_bare(file: OpenedScene) -> bool:
    """Return True for rows of three or five numbers without names.

    Four numbers are a frame, a person and a place in other files.
    """
    first = next((line for line in file.text.split("\n") if not _is_empty(line)), "")
    between = _separator(first)
    cells = [cell.strip() for cell in first.split(between)]
    numbers = all(re.fullmatch(r"[-+0-9.eE]+", cell) for cell in cells)
    commented = any(line.lstrip().startswith("#") for line in file.text.split("\n", 5)[:5])
    return numbers and len(cells) in (3, 5) and between is not None and not commented


def _is_recording(file: OpenedScene) -> bool:
    return file.kind == "text" and (_is_bare(file) or holds_people(file.path, file.text))


RECORDINGS = SceneFormat(
    "recordings",
    "recorded people as CSV",
    _is_recording,
    read,
    (RECORDING, WRITTEN),
    "walls",
)
