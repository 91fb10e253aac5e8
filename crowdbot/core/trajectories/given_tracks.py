"""Tracks out of the arguments of `Trajectories.from_arrays`, checked."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from crowdbot.core.support.arguments import mapping_of, number_of, point_of
from crowdbot.core.support.immutable import immutable
from crowdbot.core.trajectories.own_recordings import arrival
from crowdbot.core.trajectories.tracks import AgentTracks, ContactEvents, RobotTrack, Trips
from crowdbot.core.types.arrays import Array
from crowdbot.errors import InputError


def read_only(values: ArrayLike, dtype: Any = np.float64) -> NDArray[Any]:
    """Return a read-only array of numbers.

    Raises:
        InputError: a value is missing, or not of its kind.
    """
    if np.iscomplexobj(values):
        raise InputError("trajectories: complex numbers where real ones are wanted")
    try:
        array = np.asarray(values, dtype=dtype)
    except (TypeError, ValueError) as error:
        raise InputError(f"trajectories: not an array of numbers: {error}") from error
    return immutable(array if array.flags.forc else array.copy("K"))


def signals_of(signals: Mapping[str, ArrayLike]) -> dict[str, Array]:
    """Return signals by name.

    Raises:
        InputError: a signal is not a table of times and values.
    """
    found = {}
    for name, rows in mapping_of("signals", signals, "names to arrays").items():
        found[name] = read_only(rows)
        if found[name].size and (found[name].ndim != 2 or found[name].shape[1] != 2):
            raise InputError(
                f"trajectories: signal '{name}' has shape {found[name].shape}, expected (P, 2): "
                "times and values"
            )
    return found


def _require(arguments: Mapping[str, Any], *names: str) -> None:
    missing = [n for n in names if arguments[n] is None]
    if missing:
        raise InputError(f"trajectories: {', '.join(missing)} missing")


def given_arrival(arguments: Mapping[str, Any]) -> Any:
    """Return when the robot arrived, s, derived from goal or goal zone unless given.

    Raises:
        InputError: it is a text other than ``derived``.
    """
    given = arguments["robot_goal_time"]
    if not isinstance(given, str):
        return given
    if given != "derived":
        raise InputError(f"robot_goal_time is a time in s, None or 'derived', not {given!r}")
    goal, zone = arguments["robot_goal"], arguments["goal_zone"]
    if arguments["robot_x"] is None or (goal is None and zone is None):
        return None
    columns = {n: read_only(arguments[n]) for n in ("t", "robot_x", "robot_y")}
    if any(column.shape != columns["t"].shape for column in columns.values()):
        return None  # refused later
    radius = number_of("robot_goal_radius", arguments["robot_goal_radius"], "m")
    if radius == 0.0 and arguments["robot_radius"] is not None:
        radius = number_of("robot_radius", arguments["robot_radius"], "m")
    point = None if goal is None else point_of("robot_goal", goal)
    return arrival(columns, point, radius, zone)


def robot_track(arguments: Mapping[str, Any]) -> RobotTrack:
    """Return the track of the arguments ``robot_...``.

    Raises:
        InputError: a value is missing, or not of its kind.
    """
    _require(arguments, "robot_y", "robot_theta", "robot_radius", "robot_mass")
    goal_time, goal = arguments["robot_goal_time"], arguments["robot_goal"]
    rows = {k: read_only(arguments[f"robot_{k}"]) for k in ("x", "y", "theta")}
    unknown = np.full(rows["x"].shape, np.nan)
    rows["w"] = read_only(unknown if arguments["robot_w"] is None else arguments["robot_w"])
    v = arguments["robot_v"]
    if arguments["robot_vx"] is not None or arguments["robot_vy"] is not None:
        _require(arguments, "robot_vx", "robot_vy")
        rows |= {k: read_only(arguments[f"robot_{k}"]) for k in ("vx", "vy")}
        v = _forward(rows) if v is None else v
    return RobotTrack(
        **rows,
        v=read_only(unknown if v is None else v),
        radius=number_of("robot_radius", arguments["robot_radius"], "m"),
        mass=number_of("robot_mass", arguments["robot_mass"], "kg"),
        goal_time=None if goal_time is None else number_of("robot_goal_time", goal_time, "s"),
        goal=None if goal is None else point_of("robot_goal", goal),
        goal_radius=number_of("robot_goal_radius", arguments["robot_goal_radius"], "m"),
    )


def given_speed_limit(value: float | None) -> float | None:
    """Convert the limit to a number.

    Raises:
        InputError: it is not positive.
    """
    if value is None:
        return None
    limit = number_of("robot_speed_limit", value, "m/s")
    if limit <= 0.0:
        raise InputError(f"trajectories: robot_speed_limit is {value}, not a positive speed in m/s")
    return limit


def _forward(rows: Mapping[str, Array]) -> Array:
    """Return the forward speed of a robot given by its world velocity, m/s."""
    try:
        return read_only(rows["vx"] * np.cos(rows["theta"]) + rows["vy"] * np.sin(rows["theta"]))
    except ValueError as error:
        raise InputError(f"trajectories: robot_vx, robot_vy, robot_theta: {error}") from error


def agent_tracks(arguments: Mapping[str, Any]) -> AgentTracks:
    """Return the tracks of the arguments ``agent_...``.

    Raises:
        InputError: a value is missing, or not of its kind.
    """
    _require(arguments, "agent_y", "agent_radius", "agent_mass")
    x = read_only(arguments["agent_x"])
    count = x.shape[1] if x.ndim == 2 else 0
    absent = np.full(x.shape, np.nan)
    ids = arguments["agent_id"] if arguments["agent_id"] is not None else np.arange(count)
    jump = arguments["agent_jump"]
    return AgentTracks(
        id=read_only(ids, np.int64),
        x=x,
        y=read_only(arguments["agent_y"]),
        vx=read_only(absent if arguments["agent_vx"] is None else arguments["agent_vx"]),
        vy=read_only(absent if arguments["agent_vy"] is None else arguments["agent_vy"]),
        radius=read_only(np.broadcast_to(arguments["agent_radius"], (count,))),
        mass=read_only(np.broadcast_to(arguments["agent_mass"], (count,))),
        jump=None if jump is None else read_only(jump, np.bool_),
    )


def trips_of(arguments: Mapping[str, Any]) -> Trips:
    """Return the trips of the arguments ``trip_...``.

    Raises:
        InputError: a value is missing, or not of its kind.
    """
    _require(arguments, "trip_t0", "trip_t1", "trip_reached")
    return Trips(
        agent=read_only(arguments["trip_agent"], np.int64),
        t0=read_only(arguments["trip_t0"]),
        t1=read_only(arguments["trip_t1"]),
        reached=read_only(arguments["trip_reached"], np.bool_),
    )


def contact_events(table: Mapping[str, ArrayLike]) -> ContactEvents:
    """Return the contacts of a table: columns to arrays.

    Raises:
        InputError: a value is missing, or not of its kind.
    """
    table = mapping_of("contacts", table, "columns to arrays")
    names = [f.name for f in fields(ContactEvents)]
    if "bearing" not in table:  # in other tools' tables and older recordings
        table = {**table, "bearing": np.full(np.shape(table.get("t0", ())), np.nan)}
    if set(table) != set(names):
        raise InputError(f"trajectories: contacts needs the columns {', '.join(names)}")
    return ContactEvents(
        **{n: read_only(table[n], np.int64 if n == "agent" else np.float64) for n in names}
    )
