"""Recorded trajectories of people: read from a CSV file, interpolated at any time."""

from __future__ import annotations

import csv
import io
import math
from collections import defaultdict
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from crowdbot.core.crowd.agents import REMOVE, Agents
from crowdbot.core.support.text_files import input_text
from crowdbot.core.types.arrays import Array
from crowdbot.errors import InputError

COLUMNS = ("t", "id", "x", "y")


@dataclass(frozen=True, slots=True)
class RecordedCrowd:
    """Positions of recorded people over time.

    Attributes:
        time: id -> (K,) increasing times, s.
        place: id -> (K, 2) positions at these times, m.
    """

    time: dict[int, Array]
    place: dict[int, Array]

    def at(self, person: int, t: float) -> Array:
        """Return the position (2,) of one person at a time, m, interpolated linearly.

        Outside the record it is the first or last sample.
        """
        time, place = self.time[person], self.place[person]
        return np.array([np.interp(t, time, place[:, 0]), np.interp(t, time, place[:, 1])])

    def agents(self, **same_for_all: Any) -> Agents:
        """Return agents that enter at the start of their record and leave at its end.

        Preferred speed is the mean of the recorded one.

        Args:
            same_for_all: other columns of `Agents.of`.
        """
        ids = sorted(self.time)
        starts = np.array([self.place[i][0] for i in ids]).reshape(-1, 2)
        return Agents.of(
            id=ids,
            x=starts[:, 0],
            y=starts[:, 1],
            preferred_speed=[self._speed(i) for i in ids],
            start_time=[self.time[i][0] for i in ids],
            at_goal=REMOVE,
            routes=[[tuple(self.place[i][-1])] for i in ids],
            **same_for_all,
        )

    def _speed(self, person: int) -> float:
        time, place = self.time[person], self.place[person]
        if len(time) < 2:
            return 0.0
        way = np.hypot(*np.diff(place, axis=0).T)
        return float(np.sum(way) / (time[-1] - time[0]))


def read_record(path: Path) -> RecordedCrowd:
    """Read a CSV file with the columns t (s), id, x, y (m), in any order of rows.

    Raises:
        InputError: it cannot be read, or a row is invalid (the message names the line).
    """
    rows: dict[int, dict[float, tuple[float, float]]] = defaultdict(dict)
    try:
        with io.StringIO(input_text(path), newline="") as file:
            table = csv.reader(file)
            header = tuple(name.strip() for name in next(table, []))
            if header != COLUMNS:
                raise InputError(f"{path}:1: a record has the columns {','.join(COLUMNS)}")
            for cells in table:
                if cells:
                    t, person, x, y = _numbers(cells, f"{path}:{table.line_num}")
                    if t in rows[person]:
                        raise InputError(
                            f"{path}:{table.line_num}: id {person} is in two places at t = {t:g}"
                        )
                    rows[person][t] = (x, y)
    except csv.Error as error:
        raise InputError(f"{path}: cannot be read: {error}") from error
    if not rows:
        raise InputError(f"{path}: the record is empty")
    return RecordedCrowd(
        {person: np.array(sorted(found)) for person, found in rows.items()},
        {person: np.array([found[t] for t in sorted(found)]) for person, found in rows.items()},
    )


def _numbers(cells: list[str], where: str) -> tuple[float, int, float, float]:
    try:
        t, person, x, y = (float(cell) for cell in cells)
        if not all(math.isfinite(v) for v in (t, person, x, y)) or person != int(person):
            raise ValueError
    except ValueError:
        raise InputError(f"{where}: '{','.join(cells)}' is not t,id,x,y") from None
    return t, int(person), x, y
