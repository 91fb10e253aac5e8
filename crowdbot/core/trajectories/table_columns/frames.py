"""Numbers of frames in tables: checks, and conversion to seconds."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

import crowdbot.core.trajectories.plausibility.exchanged as exchanged
from crowdbot.core.support.arguments import number_of
from crowdbot.core.trajectories.plausibility.times import PERSON_SPEED
from crowdbot.core.trajectories.raw_table import Ids, RawTable
from crowdbot.core.types.arrays import Array
from crowdbot.errors import InputError


def whole_numbers(table: RawTable, *columns: str) -> None:
    """Require columns of whole numbers, where the order of columns is assumed.

    Raises:
        InputError: a frame or an id is not a whole number, so the columns have another order.
    """
    for name in columns:
        numbers = table.numbers(name)
        odd = np.flatnonzero(numbers != np.round(numbers))
        if len(odd):
            raise InputError(
                f"{table.where(int(odd[0]))}: nothing names the columns, and {numbers[odd[0]]:g} "
                f"cannot be {'an id' if name == 'id' else 'the number of a frame'}: write their "
                "names above them, such as '# id frame x/m y/m z/m'"
            )


def refuse_exchanged(table: RawTable, frames: Array) -> None:
    """Raise an error if ids and frames seem exchanged: people would move far less if they were.

    Args:
        table: t in s, id, x, y.
        frames: (K,).

    Raises:
        InputError: they seem exchanged, and people move faster than is possible.
    """
    columns = {name: table.numbers(name) for name in ("id", "x", "y")}
    found = exchanged.steps({**columns, "frame": frames})
    times = np.unique(table.numbers("t"))
    if found is None or found[0] is None or len(times) < 2:
        return
    speeds = [step / float(np.median(np.diff(times))) for step in found if step is not None]
    if speeds[0] > PERSON_SPEED:
        raise InputError(
            f"{table.name}: people move at {speeds[0]:.3g} m/s (median), and by {found[1]:.2g} m "
            f"from row to row instead of {found[0]:.2g} if columns of ids and frames are "
            "exchanged: exchange their names"
        )


def in_seconds(tables: Mapping[str, RawTable], frame_rate: float | None) -> Mapping[str, RawTable]:
    """Convert times in tables from frame numbers to s.

    Args:
        tables: tables by kind.
        frame_rate: frames per second; None: as the table states, else times are in seconds, or
            stamps.

    Raises:
        InputError: the rate is not positive or not known, or there are stamps.
    """
    if frame_rate is not None and number_of("frame_rate", frame_rate, "1/s") <= 0.0:
        raise InputError(f"frame_rate is a number of frames per second, not {frame_rate!r}")
    made = {}
    for name, table in tables.items():
        rate = frame_rate
        if rate is None and table.counts_frames:
            rate = table.frame_rate
            if rate is None:
                raise InputError(
                    f"{table.where(0)}: times are numbers of frames; a comment above the header, "
                    "'# framerate: 25', or frame_rate=25 (--frame-rate 25) says how many there "
                    "are in a second"
                )
        made[name] = table if rate is None else _without_frames(table, rate)
        if table.counts_frames and name == "agents" and {"id", "x", "y"} <= set(table.columns):
            ids = Ids(table).rows.astype(float)
            seconds = replace(made[name], columns={**made[name].columns, "id": ids})
            refuse_exchanged(seconds, table.times()[0])
    return made


def _without_frames(table: RawTable, frame_rate: float) -> RawTable:
    seconds = {}
    for name in {"t", "t0", "t1"} & set(table.columns):
        frames, stamped = table.times(name)
        if stamped:
            raise InputError(f"{table.where(0)}: {name} holds stamps; frame_rate is for frames")
        seconds[name] = frames / frame_rate
    return replace(table, columns={**table.columns, **seconds})
