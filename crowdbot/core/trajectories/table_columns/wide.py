"""Wide tables, with two columns for each person, as tables in rows."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from crowdbot.core.trajectories.raw_table import Cells, RawTable, as_number
from crowdbot.core.trajectories.table_columns.names import refuse_twins
from crowdbot.errors import InputError

#: Columns of a wide table: x1, x_1, x[1], 1_x, ped1_x, 1.x.
_WIDE = (
    re.compile(r"^(?P<axis>[xy])[_\[( ]?(?P<who>\d+)[\])]?$", re.IGNORECASE),
    re.compile(r"^(?P<axis>[xy])_(?P<who>\w+)$", re.IGNORECASE),
    re.compile(r"^(?P<who>\w+)[_. ](?P<axis>[xy])$", re.IGNORECASE),
)
#: What has x and y, and is not a person of a wide table.
_NO_PERSON = re.compile(
    r"^(?:pos(?:ition)?|loc(?:ation)?|(?:v|vel(?:ocity)?|speed|acc(?:el(?:eration)?)?|force)"
    r"|goal|target|orientation|q|quat(?:ernion)?|dir(?:ection)?|size|offset|gaze|head)s?\d*$",
    re.IGNORECASE,
)
#: Prefixes of numbers of people.
_PERSON = re.compile(r"^(?:p|ped|pedestrian|person|agent|id|human)_?(\d+)$", re.IGNORECASE)


def columns_of_people(table: RawTable, header: Sequence[str]) -> dict[str, dict[str, str]]:
    """Return x and y of each person, if the table of people has two columns for each."""
    if any(name in table for name in ("id", "x", "y")) or "t" not in table:
        return {}
    people: dict[str, dict[str, str]] = {}
    for column in header:
        match = next((m for pattern in _WIDE if (m := pattern.match(column))), None)
        if match is not None and not _NO_PERSON.match(match["who"]):
            people.setdefault(match["who"], {})[match["axis"].lower()] = column
    _refuse_halves(table.name, header, people)
    return {person: axes for person, axes in people.items() if len(axes) == 2}


def in_rows(
    table: RawTable,
    people: Mapping[str, Mapping[str, str]],
    cells: Callable[[str], Cells],
    unit: float,
) -> RawTable:
    """Return one row for each person and time."""
    tracks = [
        (_number(person), cells(axes["x"]), cells(axes["y"])) for person, axes in people.items()
    ]
    rows = [
        (k, person, x[k], y[k])
        for k in range(len(table))
        for person, x, y in tracks
        if _is_there(x[k]) and _is_there(y[k])
    ]
    times = table.columns["t"]
    places = {"x": [row[2] for row in rows], "y": [row[3] for row in rows]}
    lines = [table.lines[row[0]] for row in rows] if len(table.lines) else []
    long = RawTable(table.name, {
        "t": times[[row[0] for row in rows]] if isinstance(times, np.ndarray)
        else [times[row[0]] for row in rows],
        "id": [row[1] for row in rows], **places,
    }, lines)  # fmt: skip
    if unit != 1.0:
        long = replace(long, columns={**long.columns, **{n: long.numbers(n) * unit for n in "xy"}})
    return replace(table, columns=long.columns, lines=lines)


def _refuse_halves(
    name: str, header: Sequence[str], people: Mapping[str, Mapping[str, str]]
) -> None:
    columns = [(person, axes, axis) for person, axes in people.items() for axis in axes]
    refuse_twins(name, header, [header.index(axes[axis]) for _, axes, axis in columns])
    if not any(len(axes) == 2 for axes in people.values()):
        return
    for person, axes, axis in columns:
        if len(axes) == 1 and _number(person).isdigit():
            other = "y" if axis == "x" else "x"
            raise InputError(f"{name}:1: column '{axes[axis]}' has none for {other} beside it")


def _number(person: str) -> str:
    match = _PERSON.match(person)
    return match[1] if match is not None else person


def _is_there(cell: Any) -> bool:
    try:
        return not math.isnan(as_number(cell))
    except (TypeError, ValueError):
        return True  # its line is named when it is read
