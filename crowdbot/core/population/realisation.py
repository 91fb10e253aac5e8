"""Realisation: the sampled table of a scenario's agents, which a lock freezes."""

from __future__ import annotations

import csv
import hashlib
import io
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any, get_args

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.population.optional_columns import OPTIONAL
from crowdbot.core.types.arrays import Array
from crowdbot.dsl.scenario.crowd import AtGoal
from crowdbot.errors import InputError

Route = tuple[tuple[float, float], ...]

_NUMBERS = (
    "x", "y", "heading", "speed", "radius", "mass", "max_speed", "max_acceleration", "start_time",
    "attention",
)  # fmt: skip
COLUMNS = ("id", *_NUMBERS, "group", "policy", "at_goal", "portals", "goals", "goal_key")


@dataclass(frozen=True, slots=True, kw_only=True)
class Realisation:
    """One row per agent; world frame, SI.

    Attributes:
        id: (N,).
        x, y, heading: (N,) start, m and rad.
        speed: (N,) preferred speed, m/s.
        radius, mass: (N,) contact disc and mass, m and kg.
        max_speed, max_acceleration: (N,) m/s and m/s^2.
        start_time: (N,) time of entry, s.
        attention: (N,) rank of attention among people, 0 to 1. The least attentive ignore robots,
            the next notice them late; ``crowd.robot_response`` sets the fractions.
        group: (N,) number of the agent's group; -1: alone.
        policy: (N,) name in ``crowd.policies``; empty: the crowd's own policy.
        at_goal: (N,) behaviour at the end of the route: ``portal``, ``stop``, ``remove``, ``loop``,
            ``return``, ``onward``.
        portals: (N,) names of entrance and exit for ``portal``, else two empty texts.
        goals: (N,) points of the route, m; empty for ``portal``, whose goals are sampled on the
            way.
        goal_key: key of the counter-based draws on the way.
        goal_areas, origin, pauses, queue, height, leg_length, phase, look: (N,) each, see
            `crowdbot.core.population.optional_columns`; columns without values are omitted.
    """

    id: NDArray[np.int64]
    x: Array
    y: Array
    heading: Array
    speed: Array
    radius: Array
    mass: Array
    max_speed: Array
    max_acceleration: Array
    start_time: Array
    attention: Array
    group: NDArray[np.int64]
    policy: tuple[str, ...]
    at_goal: tuple[AtGoal, ...]
    portals: tuple[tuple[str, str], ...]
    goals: tuple[Route, ...]
    goal_key: int
    goal_areas: tuple[tuple[tuple[float, ...], ...], ...]
    origin: tuple[tuple[float, ...], ...]
    pauses: tuple[tuple[float, ...], ...]
    queue: NDArray[np.int64]
    height: Array
    leg_length: Array
    phase: Array
    look: tuple[str, ...]

    def __len__(self) -> int:
        """Return the number of agents."""
        return len(self.id)

    def to_csv(self) -> str:
        """Return the table as text, with exact decimals."""
        text = io.StringIO()
        more = {
            name: [column.write(value) for value in getattr(self, name)]
            for name, column in OPTIONAL.items()
        }
        used = {name: cells for name, cells in more.items() if any(cells)}
        rows = csv.writer(text, lineterminator="\n")
        rows.writerow((*COLUMNS, *used))
        rows.writerows(
            [*row, *(cells[i] for cells in used.values())] for i, row in enumerate(self._rows())
        )
        return text.getvalue()

    def _rows(self) -> Iterator[list[str]]:
        for i in range(len(self)):
            yield [
                str(int(self.id[i])),
                *(repr(float(getattr(self, name)[i])) for name in _NUMBERS),
                str(int(self.group[i])),
                self.policy[i],
                self.at_goal[i],
                ">".join(self.portals[i]) if any(self.portals[i]) else "",
                ";".join(f"{x!r} {y!r}" for x, y in self.goals[i]),
                str(self.goal_key),
            ]

    @property
    def hash(self) -> str:
        """Return the content hash of the table."""
        return f"cb1-sha256:{hashlib.sha256(self.to_csv().encode()).hexdigest()}"

    @classmethod
    def nobody(cls) -> Realisation:
        """Return the table of a scenario without a crowd."""
        return cls.from_rows([])

    @classmethod
    def from_csv(cls, text: str) -> Realisation:
        """Read a table written by `to_csv`.

        Raises:
            InputError: the text is not a table of agents (the message names the line).
        """
        rows = csv.reader(io.StringIO(text))
        header = next(rows, [])
        common, more = tuple(header[: len(COLUMNS)]), header[len(COLUMNS) :]
        if common != COLUMNS or more != [name for name in OPTIONAL if name in more]:
            raise InputError(
                f"line 1: an agents table has the columns {','.join(COLUMNS)}, "
                f"and those it needs of {','.join(OPTIONAL)}"
            )
        return cls.from_rows(
            [_checked(row, line, header) for line, row in enumerate(rows, start=2)]
        )

    @classmethod
    def from_rows(cls, rows: Sequence[dict[str, Any]]) -> Realisation:
        """Build a table from rows with the keys `COLUMNS` and any of `OPTIONAL`."""
        keys = {row["goal_key"] for row in rows}
        if len(keys) > 1:
            raise InputError("an agents table must have exactly one goal_key")

        columns: dict[str, Any] = {
            name: np.array([row[name] for row in rows], dtype=np.float64) for name in _NUMBERS
        }
        for name in ("id", "group"):
            columns[name] = np.array([row[name] for row in rows], dtype=np.int64)
        for name in ("policy", "at_goal", "portals", "goals"):
            columns[name] = tuple(row[name] for row in rows)
        for name, column in OPTIONAL.items():
            values = [row.get(name, column.missing) for row in rows]
            number = type(column.missing) in (int, float)
            dtype = np.int64 if column.missing == -1 else np.float64
            columns[name] = np.array(values, dtype=dtype) if number else tuple(values)
        return cls(**columns, goal_key=keys.pop() if keys else 0)


def _checked(row: Sequence[str], line: int, header: Sequence[str]) -> dict[str, Any]:
    """Return one row as values.

    Raises:
        InputError: it is not one (the message names the line).
    """
    try:
        cells = dict(zip(header, row, strict=True))
        values: dict[str, Any] = {name: float(cells[name]) for name in _NUMBERS}
        if not all(np.isfinite(v) for v in values.values()):
            raise ValueError("numbers must be finite")
        if cells["at_goal"] not in get_args(AtGoal):
            raise ValueError(f"unknown at_goal '{cells['at_goal']}'")
        entrance, _, out = cells["portals"].partition(">")
        points = [p.split(" ") for p in cells["goals"].split(";") if p]
        more = {n: c.read(cells[n]) for n, c in OPTIONAL.items() if cells.get(n)}
        for name in ("goal_areas", "pauses"):
            if name in more and len(more[name]) != len(points):
                raise ValueError(f"{name} has one entry for each of the {len(points)} goals")
        return (
            values
            | more
            | {
                "id": int(cells["id"]),
                "group": int(cells["group"]),
                "policy": cells["policy"],
                "at_goal": cells["at_goal"],
                "portals": (entrance, out),
                "goals": tuple((float(x), float(y)) for x, y in points),
                "goal_key": int(cells["goal_key"]),
            }
        )
    except ValueError as error:
        raise InputError(f"line {line}: {error}") from error
