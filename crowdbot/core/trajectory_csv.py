"""Reads trajectories from CSV tables."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from crowdbot.core.commands import read_columns
from crowdbot.core.trajectory import Array, Trajectories
from crowdbot.errors import InputError

#: Two times closer than this are one sample, s.
SAME_TIME = 1e-6

ROBOT_COLUMNS = ("t", "x", "y", "theta", "v", "w")
ROBOT_OPTIONAL = ("vx", "vy")
AGENT_COLUMNS = ("t", "id", "x", "y")
AGENT_OPTIONAL = ("vx", "vy", "radius", "mass", "jump")
CONTACT_COLUMNS = ("t0", "t1", "agent", "impulse", "peak_force", "relative_speed")
CONTACT_OPTIONAL = ("bearing",)
TRIP_COLUMNS = ("agent", "t0", "t1", "reached")


def read_csv(
    robot: Path | str | None = None,
    agents: Path | str | None = None,
    trips: Path | str | None = None,
    *,
    agent_radius: float = 0.25,
    agent_mass: float = 70.0,
    contacts: Path | str | Mapping[str, ArrayLike] | None = None,
    **more: Any,
) -> Trajectories:
    """Read tables with a header row; SI units, radians, an empty cell is unknown.

    Args:
        robot: t, x, y, theta, v, w, optionally vx, vy: one row a sample. It sets the samples.
        agents: t, id, x, y, optionally vx, vy, radius, mass, jump: one row for each person and
            sample; no row, no person. ``jump`` is 1 where the person was teleported since the
            sample before. Times must be those of the robot, if there is one.
        trips: agent, t0, t1, reached (0 or 1): one row a trip.
        agent_radius: m, where the table does not say it.
        agent_mass: kg, where the table does not say it.
        contacts: t0, t1, agent (-1: a wall), impulse, peak_force, relative_speed, optionally
            bearing: one row a contact of the robot; or such columns.
        more: everything else that `Trajectories.from_arrays` takes; ``robot_radius`` and
            ``robot_mass`` are needed with a robot.

    Raises:
        InputError: a file cannot be read, does not fit the others, or no table was given.
    """
    given: dict[str, Any] = dict(more)
    t = None
    if robot is not None:
        rows = read_columns(Path(robot), ROBOT_COLUMNS, ROBOT_OPTIONAL)
        t = rows.pop("t")
        given |= {f"robot_{name}": column for name, column in rows.items()}
    if agents is not None:
        rows = read_columns(Path(agents), AGENT_COLUMNS, AGENT_OPTIONAL)
        t = _merged(rows["t"]) if t is None else t
        given |= _agents(Path(agents), rows, t, {"radius": agent_radius, "mass": agent_mass})
    if t is None:
        raise InputError("trajectories: neither a robot nor agents given")
    if trips is not None:
        rows = read_columns(Path(trips), TRIP_COLUMNS)
        given |= {f"trip_{name}": column for name, column in rows.items()}
        given["trip_reached"] = rows["reached"] != 0
    if isinstance(contacts, Path | str):
        contacts = _contacts(Path(contacts))
    given["contacts"] = contacts
    try:
        return Trajectories.from_arrays(t=t, **given)
    except TypeError as error:
        raise InputError(f"trajectories: {error}") from error


def _contacts(path: Path) -> dict[str, Array]:
    rows = read_columns(path, CONTACT_COLUMNS, CONTACT_OPTIONAL)
    if not np.all(np.isfinite(rows["agent"])):
        raise InputError(f"{path}: a row has no agent")
    return rows


def _merged(times: Array) -> Array:
    """All times, in order, each once."""
    ordered = np.unique(times)
    new = np.diff(ordered, prepend=-np.inf) > SAME_TIME
    return ordered[new]


def _agents(
    path: Path, rows: dict[str, Array], t: Array, defaults: dict[str, float]
) -> dict[str, Any]:
    for name in ("t", "id"):
        if not np.all(np.isfinite(rows[name])):
            raise InputError(f"{path}: a row has no {name}")
    ids, column = np.unique(rows["id"].astype(np.int64), return_inverse=True)
    k = np.clip(np.searchsorted(t, rows["t"] - SAME_TIME), 0, len(t) - 1)
    if np.any(np.abs(t[k] - rows["t"]) > SAME_TIME):
        at = rows["t"][np.abs(t[k] - rows["t"]) > SAME_TIME][0]
        raise InputError(f"{path}: t = {at:g} s is no sample of the robot")
    cells, count = np.unique(k * len(ids) + column, return_counts=True)
    if np.any(count > 1):
        k_twice, i_twice = divmod(int(cells[count > 1][0]), len(ids))
        raise InputError(f"{path}: two rows of id {ids[i_twice]} at t = {t[k_twice]:g} s")
    given: dict[str, Any] = {"agent_id": ids}
    for name in ("x", "y", "vx", "vy"):
        if name in rows:
            table = np.full((len(t), len(ids)), np.nan)
            table[k, column] = rows[name]
            given[f"agent_{name}"] = table
    for name, default in defaults.items():
        values = np.full(len(ids), default)
        if name in rows:
            said = np.isfinite(rows[name])
            values[column[said]] = rows[name][said]
        given[f"agent_{name}"] = values
    if "jump" in rows:
        jump = np.zeros((len(t), len(ids)), dtype=bool)
        jump[k, column] = np.nan_to_num(rows["jump"]) != 0
        given["agent_jump"] = jump[1:]
    return given
