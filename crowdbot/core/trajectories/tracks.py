"""Arrays of a run: the robot, the agents, their trips and contacts."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.types.arrays import Array


@dataclass(frozen=True, slots=True, kw_only=True)
class RobotTrack:
    """The robot's track: x, y, theta, v, w are (N,); m, rad, m/s signed forward, rad/s.

    ``vx``, ``vy`` (N,) are the world velocity (m/s) of a robot that also moves sideways; without
    them it is ``v`` along ``theta``.
    """

    x: Array
    y: Array
    theta: Array
    v: Array
    w: Array
    radius: float
    mass: float
    goal_time: float | None
    goal: tuple[float, float] | None
    goal_radius: float
    vx: Array | None = None
    vy: Array | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class AgentTracks:
    """Tracks of people: id, radius, mass (M,); x, y, vx, vy (N, M), NaN = absent; jump (N-1, M)."""

    id: NDArray[np.int64]
    x: Array
    y: Array
    vx: Array
    vy: Array
    radius: Array
    mass: Array
    jump: NDArray[np.bool_] | None


@dataclass(frozen=True, slots=True, kw_only=True)
class Trips:
    """People's trips to one goal: agent (id), t0, t1 (s), reached; each (K,)."""

    agent: NDArray[np.int64]
    t0: Array
    t1: Array
    reached: NDArray[np.bool_]


@dataclass(frozen=True, slots=True, kw_only=True)
class ContactEvents:
    """Contacts of the robot, each (K,).

    t0, t1 (s), agent id (-1: a wall; -2, -3, …: another robot of the run), impulse (N s), peak
    force (N), relative speed before (m/s), bearing of the robot's first point of contact in its
    frame (rad; NaN: unknown), named by `crowdbot.core.geometry.footprint.body_side`.
    """

    t0: Array
    t1: Array
    agent: NDArray[np.int64]
    impulse: Array
    peak_force: Array
    relative_speed: Array
    bearing: Array
