"""Convert tables of a robot and of people to the arguments of `Trajectories.from_arrays`.

Missing values are derived here: heading from the direction of motion, arrival from the goal.
`preprocess` derives missing velocities before the metrics run.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.geometry.footprint import Footprint
from crowdbot.core.support.arguments import number_of
from crowdbot.core.trajectories.raw_table import Ids, RawTable
from crowdbot.core.trajectories.resample import interpolated, steady_times
from crowdbot.core.types.arrays import Array
from crowdbot.errors import InputError

#: Times closer than this are one sample, s.
SAME_TIME = 1e-6
#: Below this speed a body has no direction of motion, m/s.
STANDING = 0.02

ROBOT = ("t", "x", "y", "theta", "v", "w", "vx", "vy")
AGENT = ("t", "id", "x", "y", "vx", "vy", "radius", "mass", "jump")
TRIP = ("agent", "t0", "t1", "reached")
CONTACT = ("t0", "t1", "agent", "impulse", "peak_force", "relative_speed", "bearing")

_TWO_CLOCKS = "{}: one table has stamps, the other seconds: their clocks cannot be compared"
_LATEST = np.iinfo(np.int64).max
#: The sample times: the robot's, or times with a constant rate, Hz.
Samples = float | Literal["robot"] | None


def columns_of(
    robot: RawTable | None,
    agents: RawTable | None,
    trips: RawTable | None,
    contacts: RawTable | None,
    *,
    agent_radius: float,
    agent_mass: float,
    resample: Samples,
    clock_offset: float,
    max_gap: float,
) -> dict[str, Any]:
    """Return the arguments of `Trajectories.from_arrays`, by name.

    Args:
        robot, agents, trips, contacts: tables; each may be missing.
        agent_radius, agent_mass: defaults for people without a value in the table.
        resample: see `Samples`; None keeps the given times.
        clock_offset: added to the times of people, s.
        max_gap: longest gap between rows over which people are interpolated, s.

    Raises:
        InputError: tables are inconsistent, or there is no table.
    """
    _require("robot", robot, ROBOT[:3])
    _require("agents", agents, AGENT[:4])
    stamps = [t.stamps() for t in (robot, agents) if t is not None]
    if not stamps:
        raise InputError("trajectories: neither a robot nor agents")
    if len({columns is None for columns in stamps}) > 1:
        raise InputError(_TWO_CLOCKS.format(agents.name if agents else ""))
    origin = None if stamps[0] is None else int(stamps[0].min(initial=_LATEST))
    rows = None if robot is None else _robot_rows(robot, origin)
    ids = None
    people: dict[str, Any] | None = None
    if agents is not None:
        ids = Ids(agents)
        people = {n: agents.numbers(n) for n in AGENT[2:] if n in agents}
        people |= {"t": _seconds(agents, "t", origin) + clock_offset, "id": ids.rows}
    zero = 0.0 if origin is None else _zero(rows, people)
    for table in (rows, people):
        if table is not None:
            table["t"] = table["t"] - zero
    t = _samples(rows, people, resample)
    made: dict[str, Any] = {"t": t}
    if rows is not None:
        rows = _resampled_robot(rows, t) if resample is not None else rows
        made |= {f"robot_{n}": v for n, v in rows.items() if n != "t"}
    if agents is not None and people is not None:
        defaults = {"radius": agent_radius, "mass": agent_mass}
        gap = max_gap if resample is not None else None
        made |= _people_columns(agents, people, t, defaults, gap)
    if trips is not None:
        made |= _trips(trips, ids, origin, zero)
    if contacts is not None:
        made["contacts"] = _contacts(contacts, ids, origin, zero)
    return made


def _require(role: str, table: RawTable | None, columns: tuple[str, ...]) -> None:
    """Require columns, and velocities in both directions or none."""
    if table is not None:
        table.require(role, *columns)
        if ("vx" in table) != ("vy" in table):
            table.require(role, "vx", "vy")


def _seconds(table: RawTable, column: str, origin: int | None) -> Array:
    """Return times (K,), s; stamps are counted from ``origin``, ns since 1970."""
    times, stamped = table.times(column, origin or 0)
    if stamped != (origin is not None):
        raise InputError(_TWO_CLOCKS.format(table.name))
    return times


def _zero(rows: Mapping[str, Array] | None, people: Mapping[str, Array] | None) -> float:
    """Return the origin of stamps, s: the robot's first, else the first of all."""
    table = rows if rows is not None else people
    assert table is not None
    return float(np.min(table["t"]))


def _robot_rows(robot: RawTable, origin: int | None) -> dict[str, Array]:
    rows = {n: robot.numbers(n) for n in ROBOT[1:] if n in robot}
    rows["t"] = _seconds(robot, "t", origin)
    if not len(rows["t"]):
        raise InputError(f"{robot.name}: the table has no rows")
    back = np.flatnonzero(np.diff(rows["t"]) <= 0)
    if len(back):
        row = int(back[0]) + 1
        raise InputError(f"{robot.where(row)}: t does not increase: {rows['t'][row]:g} s")
    if "theta" not in rows:
        rows["theta"] = heading_of_motion(rows["t"], rows["x"], rows["y"])
    return rows


def heading_of_motion(t: Array, x: Array, y: Array) -> Array:
    """Return (N,) directions of motion, rad; at standstill, the last direction.

    Before a body first moves, it has its first direction; if it never moves, it faces along x.
    """
    if len(t) < 2:
        return np.zeros(len(t))
    vx, vy = np.gradient(x, t), np.gradient(y, t)
    moving = np.hypot(vx, vy) > STANDING
    if not moving.any():
        return np.zeros(len(t))
    theta = np.arctan2(vy, vx)
    last = np.maximum.accumulate(np.where(moving, np.arange(len(t)), -1))
    last = np.where(last < 0, int(np.argmax(moving)), last)
    heading: Array = theta[last]
    return heading


def _samples(
    rows: Mapping[str, Array] | None, people: Mapping[str, Array] | None, resample: Samples
) -> Array:
    """Return the times of the run, s."""
    tables = [table["t"] for table in (rows, people) if table is not None]
    if isinstance(resample, str):
        if resample != "robot":
            raise InputError(f"resample is 'robot' or a rate in Hz, not '{resample}'")
        if rows is None:
            raise InputError("resample='robot' needs a robot")
    elif resample is not None:
        ends = (tables[0].min(), tables[0].max())
        rate = number_of("resample", resample, "Hz")
        return steady_times(float(ends[0]), float(ends[1]), rate)
    if rows is not None:
        return rows["t"]
    ordered = np.unique(tables[0])
    merged: Array = ordered[np.diff(ordered, prepend=-np.inf) > SAME_TIME]
    return merged


def _resampled_robot(rows: Mapping[str, Array], t: Array) -> dict[str, Array]:
    """Interpolate all columns between their samples; headings turn the shorter way."""
    known = rows["t"]
    made = {n: interpolated(known, v, t) for n, v in rows.items() if n not in ("t", "theta")}
    finite = np.isfinite(rows["theta"])
    made["theta"] = interpolated(known[finite], np.unwrap(rows["theta"][finite]), t)
    return {**made, "t": t}


def _people_columns(
    table: RawTable,
    rows: Mapping[str, Any],
    t: Array,
    defaults: Mapping[str, float],
    gap: float | None,
) -> dict[str, Any]:
    ids, column = np.unique(rows["id"], return_inverse=True)
    made = {"agent_id": ids}
    for name, default in defaults.items():
        values = np.full(len(ids), default)
        if name in rows:
            given = np.isfinite(rows[name])
            values[column[given]] = rows[name][given]
        made[f"agent_{name}"] = values
    if gap is None:
        return made | _on_samples(table, rows, t, ids, column)
    _check_overlap(table, rows["t"], t)
    _check_steps(table, rows["t"], column, gap)
    places = [n for n in ("x", "y", "vx", "vy") if n in rows]
    tables = {n: np.full((len(t), len(ids)), np.nan) for n in places}
    for i in range(len(ids)):
        mine = np.flatnonzero(column == i)
        mine = mine[np.argsort(rows["t"][mine], kind="stable")]
        for name in places:
            tables[name][:, i] = interpolated(rows["t"][mine], rows[name][mine], t, gap)
    return made | {f"agent_{n}": v for n, v in tables.items()}


def _check_overlap(table: RawTable, people: Array, t: Array) -> None:
    """Refuse people who are never there at the times of the samples: clocks differ."""
    if not len(people) or (people.min() <= t[-1] and people.max() >= t[0]):
        return
    raise InputError(
        f"{table.name}: people are there from {people.min():.9g} to {people.max():.9g} s, and the "
        f"robot from {t[0]:.6g} to {t[-1]:.6g} s, at no time both: two clocks? "
        f"clock_offset={t[0] - people.min():.9g} would let both begin together"
    )


def _check_steps(table: RawTable, t: Array, column: NDArray[np.int64], gap: float) -> None:
    """Refuse rows so far apart that no one would be there between them."""
    order = np.lexsort((t, column))
    steps = np.diff(t[order])[np.diff(column[order]) == 0]
    if len(steps) and (step := float(np.median(steps))) > gap:
        raise InputError(
            f"{table.name}: the rows of a person are {step:g} s apart (median), and over more than "
            f"max_gap = {gap:g} s no one is there: times in another unit than the robot's? A unit "
            "after a name, such as t_ms, says which; else give a larger max_gap"
        )


def _on_samples(
    table: RawTable, rows: Mapping[str, Any], t: Array, ids: NDArray[np.int64], column: Any
) -> dict[str, Any]:
    """Return people whose rows lie on the samples."""
    k = np.clip(np.searchsorted(t, rows["t"] - SAME_TIME), 0, len(t) - 1)
    off = np.flatnonzero(np.abs(t[k] - rows["t"]) > SAME_TIME)
    if len(off):
        raise InputError(
            f"{table.where(int(off[0]))}: t = {rows['t'][off[0]]:g} s is not a sample of the "
            "robot; resample='robot' interpolates people there, resample=20 everything at 20 Hz"
        )
    cells = k * len(ids) + column
    found, count = np.unique(cells, return_counts=True)
    if np.any(count > 1):
        twice = int(found[count > 1][0])
        at, person = divmod(twice, len(ids))
        second = int(np.flatnonzero(cells == twice)[1])
        raise InputError(f"{table.where(second)}: two rows of id {ids[person]} at t = {t[at]:g} s")
    made: dict[str, Any] = {}
    for name in ("x", "y", "vx", "vy"):
        if name in rows:
            values = np.full((len(t), len(ids)), np.nan)
            values[k, column] = rows[name]
            made[f"agent_{name}"] = values
    if "jump" in rows:
        jump = np.zeros((len(t), len(ids)), dtype=bool)
        jump[k, column] = np.nan_to_num(rows["jump"]) != 0
        made["agent_jump"] = jump[1:]
    return made


def _trips(table: RawTable, ids: Ids | None, origin: int | None, zero: float) -> dict[str, Any]:
    table.require("trips", *TRIP)
    agent = table.numbers("agent").astype(np.int64) if ids is None else ids.of(table, "agent")
    return {
        "trip_agent": agent,
        "trip_t0": _seconds(table, "t0", origin) - zero,
        "trip_t1": _seconds(table, "t1", origin) - zero,
        "trip_reached": table.numbers("reached") != 0,
    }


def _contacts(table: RawTable, ids: Ids | None, origin: int | None, zero: float) -> dict[str, Any]:
    table.require("contacts", *CONTACT[:-1])
    columns: dict[str, Any] = {n: table.numbers(n) for n in CONTACT[3:] if n in table}
    columns |= {n: _seconds(table, n, origin) - zero for n in ("t0", "t1")}
    if ids is not None:
        return columns | {"agent": ids.of(table, "agent")}
    agent = table.numbers("agent")
    if not np.all(np.isfinite(agent)):
        raise InputError(f"{table.name}: a row has no agent")
    return columns | {"agent": agent}


def _corners(goal_zone: Any) -> Array:
    """Return the (K, 2) corners of a zone, m.

    Raises:
        InputError: it is not a zone.
    """
    try:
        corners = np.asarray(goal_zone, dtype=float)
    except (TypeError, ValueError):
        corners = np.zeros(0)
    if corners.ndim != 2 or corners.shape[1] != 2 or len(corners) < 3:
        raise InputError(f"goal_zone must be (K, 2) corners in m, K >= 3, not {goal_zone!r}")
    return corners


def arrival(
    columns: Mapping[str, Any],
    goal: tuple[float, float] | None,
    goal_radius: float,
    goal_zone: Any,
) -> float | None:
    """Return when the robot's centre first entered the goal, s; None: never, or no goal.

    Within ``goal_radius`` of the goal, or inside the zone; motion between samples is straight.

    Raises:
        InputError: the zone is not a polygon.
    """
    if "robot_x" not in columns:
        return None
    t, x, y = (np.asarray(columns[n], dtype=float) for n in ("t", "robot_x", "robot_y"))
    if goal is not None and goal_radius > 0.0:
        gap = np.hypot(x - goal[0], y - goal[1]) - goal_radius
    elif goal_zone is not None:
        gap = Footprint(_corners(goal_zone), 0.0).gap(x, y)
    else:
        return None
    inside = np.flatnonzero(gap <= 0.0)
    if not len(inside):
        return None
    k = int(inside[0])
    if k == 0 or not np.isfinite(gap[k - 1]):
        return float(t[k])
    part = gap[k - 1] / (gap[k - 1] - gap[k])
    return float(t[k - 1] + part * (t[k] - t[k - 1]))
