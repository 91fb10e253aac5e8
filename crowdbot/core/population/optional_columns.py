"""Optional columns of an agents' table, which only some crowds need."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any, get_args

from crowdbot.dsl.scenario.people_kinds import AppearanceName

Numbers = tuple[float, ...]


@dataclass(frozen=True, slots=True)
class OptionalColumn:
    """One optional column: its default, and how it is written and read."""

    missing: Any
    write: Callable[[Any], str]
    read: Callable[[str], Any]


def _number(text: str) -> float:
    value = float(text)
    if not math.isfinite(value):
        raise ValueError("numbers must be finite")
    return value


def _write_numbers(values: Numbers) -> str:
    return " ".join(repr(float(v)) for v in values)


def _read_numbers(text: str) -> Numbers:
    return tuple(_number(word) for word in text.split(" "))


def _write_rows(rows: tuple[Numbers, ...]) -> str:
    return ";".join(_write_numbers(row) for row in rows)


def _read_rows(text: str) -> tuple[Numbers, ...]:
    return tuple(_read_numbers(part) for part in text.split(";"))


def _read_areas(text: str) -> tuple[Numbers, ...]:
    return _sized(_read_rows(text), 3, "goal_areas")


def _read_origin(text: str) -> Numbers:
    return _sized((_read_numbers(text),), 5, "origin")[0]


def _sized(rows: tuple[Numbers, ...], count: int, name: str) -> tuple[Numbers, ...]:
    if any(len(row) != count for row in rows):
        raise ValueError(f"{name} has {count} numbers each")
    return rows


def _read_look(text: str) -> str:
    if text not in get_args(AppearanceName):
        raise ValueError(f"'{text}' is not a look of people")
    return text


def _write_measure(value: float) -> str:
    return repr(float(value)) if value else ""


_MEASURE = OptionalColumn(0.0, _write_measure, _number)

#: In alphabetical order, after the other columns. ``goal_areas``: size along own x and y and
#: rotation of the area around each goal, m and rad; 0 0 0: a point. ``height``, ``leg_length``,
#: ``look``, ``phase``: the body seen by sensors, m and rad; 0: default. ``origin``: centre, size
#: and rotation of the entrance; ``pauses``: time at each goal, s; ``queue``: number of the queue in
#: which it stands behind the previous agent.
OPTIONAL: Mapping[str, OptionalColumn] = MappingProxyType(
    {
        "goal_areas": OptionalColumn((), _write_rows, _read_areas),
        "height": _MEASURE,
        "leg_length": _MEASURE,
        "look": OptionalColumn("", str, _read_look),
        "origin": OptionalColumn((), _write_numbers, _read_origin),
        "pauses": OptionalColumn((), _write_numbers, _read_numbers),
        "phase": _MEASURE,
        "queue": OptionalColumn(-1, lambda n: "" if n < 0 else str(int(n)), int),
    }
)
