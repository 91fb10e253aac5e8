"""Combine columns of flattened messages into one: stamps and headings.

Exports of bags split a stamp into seconds and nanoseconds, and give an orientation as a quaternion.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from itertools import takewhile

import numpy as np

from crowdbot.core.trajectories.raw_table import Cells, RawTable, as_number
from crowdbot.core.types.arrays import Array
from crowdbot.errors import InputError

#: Our names of a quaternion; x and y may be missing on a plane.
QUATERNION = ("qx", "qy", "qz", "qw")
_SECONDS = re.compile(r"^(.*?)(?<![a-z])(?:s|secs?|seconds)$", re.IGNORECASE)
_NANOSECONDS = re.compile(
    r"^(.*?)(?<![a-z])(?:ns|nsecs?|nanos|nanosecs?|nanoseconds)$", re.IGNORECASE
)
_ORIENTATION = re.compile(
    r"^(.*?)(?<![a-z])(?:orientation|ori|quaternion|quat|rotation|rot|q|o)(?:[._/ ](?:[a-z]+_)?)?"
    r"([xyzw])\s*(?:\[\s*\])?$",
    re.IGNORECASE,
)
_STAMP = re.compile(r"\s*\d{4}-\d\d-\d\d[T ]")
#: Seconds since 1970 from 1973 on; smaller ones count from any start.
_SINCE_1970 = 1e8
#: Least share of a ground robot's z axis that points up or down.
_UPRIGHT = 0.7
#: Quaternions have this length, but for rounding.
_LENGTHS = (0.9, 1.1)
#: A shorter one does not rotate, such as one of zeros, which was not filled in.
_NO_ROTATION = 0.5


def joined(
    table: RawTable,
    made: Mapping[str, int],
    cells: Callable[[int], Cells],
    known: Iterable[str],
) -> tuple[RawTable, set[int]]:
    """Return the table with a time and a heading combined from several columns, if it has none.

    Args:
        table: what was found under our names; its header has all names as the file spells them.
        made: our name -> place of its column.
        cells: returns the cells of a column by its place.
        known: our names.

    Returns:
        The table without quaternions, and the places of further columns that are used.

    Raises:
        InputError: a cell is not a number, or half a stamp is missing.
    """
    known = set(known)
    used: set[int] = set()
    if "t" in known:
        table, used = _with_stamps(table, made, cells)
    if "qw" in known:
        table, more = _with_heading(table, made, cells)
        used |= more
    return table, used


def _with_stamps(
    table: RawTable, made: Mapping[str, int], cells: Callable[[int], Cells]
) -> tuple[RawTable, set[int]]:
    """Join whole seconds and nanoseconds, unless a column has the time in numbers or stamps."""
    pairs = _pairs(table.header)
    if "t" in made and not _is_text(table.columns["t"]):
        pairs = [pair for pair in pairs if pair[0] == made["t"]]
    read = []
    for seconds, rest in pairs:
        both = RawTable(table.name, {"s": cells(seconds), "ns": cells(rest)}, table.lines)
        try:
            s, ns = both.numbers("s"), both.numbers("ns")
        except InputError:
            continue  # a text
        known = np.isfinite(s + ns)
        halves = (s == np.round(s)) & (ns == np.round(ns)) & (ns >= 0.0) & (ns < 1e9)
        if np.all(halves[known]):
            read.append((seconds, rest, s, ns))
    if not read:
        return table, set()
    place = _nearest(table.header, made, [seconds for seconds, *_ in read])
    seconds, rest, s, ns = read[place]
    for column, half in ((seconds, s), (rest, ns)):
        if np.isnan(half).any():
            where = table.where(int(np.argmax(np.isnan(half))))
            raise InputError(f"{where}: a row has no {table.header[column]}")
    since_1970 = len(s) and float(np.max(s)) > _SINCE_1970
    t = s.astype(np.int64) * 10**9 + ns.astype(np.int64) if since_1970 else s + 1e-9 * ns
    made_of = {**table.columns, "t": t}
    return replace(table, columns=made_of, counts_frames=False), {seconds, rest}


def _is_text(cells: Cells) -> bool:
    """Return True for texts other than times: ``2019/03/11/08:20:20``, or the name of a frame."""
    cell = next(iter(cells), None)
    if not isinstance(cell, str) or _STAMP.match(cell):
        return False
    try:
        as_number(cell)
    except ValueError:
        return True
    return False


def nanosecond_halves(header: Sequence[str]) -> set[int]:
    """Return the places of columns of nanoseconds beside one of seconds: ``t_s``, ``t_ns``."""
    return {rest for _, rest in _pairs(header)}


def _pairs(header: Sequence[str]) -> list[tuple[int, int]]:
    """Return places of columns of seconds and nanoseconds whose names begin alike."""
    rests = {m[1]: i for i, name in enumerate(header) if (m := _NANOSECONDS.match(name.strip()))}
    found = [(i, m[1]) for i, name in enumerate(header) if (m := _SECONDS.match(name.strip()))]
    return [(i, rests[start]) for i, start in found if start in rests]


def _with_heading(
    table: RawTable, made: Mapping[str, int], cells: Callable[[int], Cells]
) -> tuple[RawTable, set[int]]:
    """Compute the heading of quaternions, unless a column has it."""
    columns = {n: c for n, c in table.columns.items() if n not in QUATERNION}
    places = {n: made[n] for n in QUATERNION if n in made}
    if not {"qz", "qw"} <= set(places):
        places = _quaternion(table.header, made)
    bare = replace(table, columns=columns)
    used = set(places.values())
    if not places or "theta" in columns:
        return bare, used
    parts = RawTable(table.name, {n: cells(i) for n, i in places.items()}, table.lines)
    still = np.zeros(len(parts))
    x, y, z, w = (parts.numbers(n) if n in parts else still for n in QUATERNION)
    length = np.sqrt(x * x + y * y + z * z + w * w)
    usual = float(np.nanmedian(length)) if np.isfinite(length).any() else np.nan
    if not _LENGTHS[0] < usual < _LENGTHS[1]:
        names = ", ".join(table.header[i] for i in places.values())
        note = (
            f"{table.name}: {names} do not rotate: their length is {usual:.3g} (median) instead "
            "of 1; the heading is the direction of motion"
        )
        return replace(bare, notes=[*table.notes, note]), used
    up = (w * w + z * z - x * x - y * y) / np.where(length > 0.0, length, 1.0) ** 2
    if float(np.median(np.abs(up[length > _NO_ROTATION]))) < _UPRIGHT:
        note = (
            f"{table.name}: the rotated z axis points sideways, as a camera's or a drone's does; "
            "the heading is the direction of motion"
        )
        return replace(bare, notes=[*table.notes, note]), used
    return replace(bare, columns={**columns, "theta": _heading(x, y, z, w, length)}), used


def _heading(x: Array, y: Array, z: Array, w: Array, length: Array) -> Array:
    """Return directions (K,) of the rotated x axis in the plane, rad; NaN without a rotation."""
    theta = np.arctan2(2.0 * (w * z + x * y), w * w + x * x - y * y - z * z)
    heading: Array = np.where(length > _NO_ROTATION, theta, np.nan)
    return heading


def _quaternion(header: Sequence[str], made: Mapping[str, int]) -> dict[str, int]:
    """Return the places of an orientation's columns; empty without any."""
    found: dict[str, dict[str, int]] = {}
    for i, name in enumerate(header):
        match = _ORIENTATION.match(name.strip())
        if match is not None and i not in made.values():
            found.setdefault(match[1], {})[f"q{match[2].lower()}"] = i
    whole = [places for places in found.values() if {"qz", "qw"} <= set(places)]
    if not whole:
        return {}
    return whole[_nearest(header, made, [places["qw"] for places in whole])]


def _nearest(header: Sequence[str], made: Mapping[str, int], places: Sequence[int]) -> int:
    """Return which of several columns begins most like the column of x: the same message's."""
    x = header[made["x"]] if "x" in made else ""
    alike = [_alike(x, header[i]) for i in places]
    return int(np.argmax(alike))


def _alike(one: str, other: str) -> int:
    """Return the number of characters with which both names begin."""
    return sum(1 for _ in takewhile(lambda pair: pair[0] == pair[1], zip(one, other, strict=False)))
