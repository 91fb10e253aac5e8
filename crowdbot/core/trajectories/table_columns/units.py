"""Units in the names of columns, and in comments of tables."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence

from crowdbot.core.trajectories.message_columns import nanosecond_halves
from crowdbot.core.trajectories.raw_table import Cells, RawTable

#: Vadere's columns end in the number of what wrote them: ``startX-PID1``.
_PROCESSOR = re.compile(r"-PID\d+$")
_LENGTHS = ("x", "y", "v", "vx", "vy", "v_user", "v_sc", "radius")
#: Columns that may be in another unit than ours, by themselves.
_OTHERS = ("t", "theta", "w", "w_user", "w_sc")
#: Unit of lengths -> metres.
_METRES = {"m": 1.0, "cm": 0.01, "mm": 0.001, "km": 1000.0, "ft": 0.3048}
#: Unit of times and angles -> seconds, rad.
_SCALES = {
    "s": 1.0, "sec": 1.0, "seconds": 1.0, "ms": 1e-3, "us": 1e-6, "µs": 1e-6, "ns": 1e-9,
    "rad": 1.0, "deg": math.pi / 180.0, "°": math.pi / 180.0, "degrees": math.pi / 180.0,
}  # fmt: skip
_UNIT = re.compile(
    rf"^(.*?)\s*(?:/|\[|\(|_in_)\s*({'|'.join([*_METRES, *_SCALES])})(?:/s)?\s*[\])]?$",
    re.IGNORECASE,
)
_UNIT_IN_TEXT = re.compile(
    r"\b(?:in|units?|lengths?|positions?)\s*(?:is|are|in|[:=])*\s*\(?"
    r"(mm|cm|m|millimet(?:er|re)s?|centimet(?:er|re)s?|met(?:er|re)s?)\b", re.IGNORECASE
)  # fmt: skip
#: A unit at the end of a name: ``t_ms``, ``yaw_deg``, ``pos_x_mm``, ``radius_cm``.
_ENDING = re.compile(
    r"^((?:t|time|timestamp|time_stamp|stamp|theta|yaw|heading|w|omega|yaw_rate)"
    r"(?=_(?:s|sec|ms|us|ns|rad|deg)$)"
    r"|(?:(?:pos_|position_|t)?[xy]|v[xy]|vel_[xy]|radius)(?=_(?:mm|cm|m)$))"
    r"_(s|sec|ms|us|ns|rad|deg|mm|cm|m)$",
    re.IGNORECASE,
)


def without_unit(column: str) -> str:
    """Return the name of a column without its unit: ``x/cm``, ``x [cm]``, ``x(cm)``."""
    column = _PROCESSOR.sub("", column)
    match = _UNIT.match(column) or _ENDING.match(column)
    return match[1] if match is not None and match[1] else column


def without_units(header: Sequence[str]) -> list[str]:
    """Return names of columns without units, but for nanoseconds that belong to seconds."""
    halves = nanosecond_halves(header)
    return [name if i in halves else without_unit(name) for i, name in enumerate(header)]


def unit_in(column: str) -> float | None:
    """Return the unit that a column's name states, in m, s or rad; None if it states none."""
    match = _UNIT.match(column) or _ENDING.match(column)
    if match is None:
        return length_unit(column)
    word = match[2].lower()
    return _METRES[word] if word in _METRES else _SCALES[word]


def length_unit(text: str) -> float | None:
    """Return metres in the unit that a comment states; None if it states none."""
    match = _UNIT_IN_TEXT.search(text)
    if match is None:
        match = _UNIT.match(text)
        return None if match is None else _METRES.get(match[2].lower())
    word = match[1].lower()
    return _METRES[word if word in _METRES else {"mi": "mm", "ce": "cm", "me": "m"}[word[:2]]]


def unit_of(ours: str, column: str, of_lengths: float) -> float:
    """Return the unit of a column in ours: its own, or that of all lengths of the table."""
    own = unit_in(column)
    return own if own is not None else of_lengths if ours in _LENGTHS else 1.0


def scaled(name: str, ours: str, cells: Cells, unit: float, lines: Sequence[int]) -> Cells:
    """Return a column in metres, seconds or rad, if it is in another unit."""
    if unit == 1.0 or ours not in (*_LENGTHS, *_OTHERS):
        return cells
    table = RawTable(name, {ours: cells}, lines)
    return table.numbers(ours) * unit
