"""Reads CSV tables of trajectories into the columns that `Trajectories.from_arrays` takes."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from crowdbot.core.support.csv_columns import read_columns
from crowdbot.core.types.arrays import Array
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


def read_tables(
    robot: Path | None,
    agents: Path | None,
    trips: Path | None,
    *,
    contacts: Path | None,
    agent_radius: float,
    agent_mass: float,
) -> dict[str, ArrayLike | Mapping[str, Array]]:
    """Columns by the names of `Trajectories.from_arrays`; see `Trajectories.from_csv`.

    Raises:
        InputError: a file cannot be read, does not fit the others, or there is no table.
    """
    columns: dict[str, Any] = {}
    t = None
    if robot is not None:
        rows = read_columns(robot, ROBOT_COLUMNS, ROBOT_OPTIONAL)
        t = rows.pop("t")
        columns |= {f"robot_{name}": values for name, values in rows.items()}
    if agents is not None:
        rows = read_columns(agents, AGENT_COLUMNS, AGENT_OPTIONAL)
        t = _merged(rows["t"]) if t is None else t
        columns |= _agents(agents, rows, t, {"radius": agent_radius, "mass": agent_mass})
    if t is None:
        raise InputError("trajectories: neither a robot nor agents")
    if trips is not None:
        rows = read_columns(trips, TRIP_COLUMNS)
        columns |= {f"trip_{name}": values for name, values in rows.items()}
        columns["trip_reached"] = rows["reached"] != 0
    if contacts is not None:
        columns["contacts"] = _contacts(contacts)
    return {"t": t, **columns}


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
        raise InputError(f"{path}: t = {at:g} s is not a sample of the robot")
    cells, count = np.unique(k * len(ids) + column, return_counts=True)
    if np.any(count > 1):
        k_twice, i_twice = divmod(int(cells[count > 1][0]), len(ids))
        raise InputError(f"{path}: two rows of id {ids[i_twice]} at t = {t[k_twice]:g} s")
    columns: dict[str, Any] = {"agent_id": ids}
    for name in ("x", "y", "vx", "vy"):
        if name in rows:
            table = np.full((len(t), len(ids)), np.nan)
            table[k, column] = rows[name]
            columns[f"agent_{name}"] = table
    for name, default in defaults.items():
        values = np.full(len(ids), default)
        if name in rows:
            said = np.isfinite(rows[name])
            values[column[said]] = rows[name][said]
        columns[f"agent_{name}"] = values
    if "jump" in rows:
        jump = np.zeros((len(t), len(ids)), dtype=bool)
        jump[k, column] = np.nan_to_num(rows["jump"]) != 0
        columns["agent_jump"] = jump[1:]
    return columns
