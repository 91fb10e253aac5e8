"""The point of the robot that is nearest to a person, and how fast it comes nearer.

A disc that turns moves no point of its surface towards anything; a long robot that turns on the
spot sweeps its ends sideways. Both follow from the velocity of the nearest point, v + w x r.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from crowdbot.core.geometry.footprint import Footprint
from crowdbot.core.trajectories.encounters import encounter, robot_of, robot_velocities
from crowdbot.core.trajectories.preprocess import inf_to_nan
from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.core.types.arrays import Array, Indices

#: Step of the numerical gradient of a gap, m.
_STEP = 1e-6


class TouchPoint(NamedTuple):
    """The nearest point in some samples, (K,) each.

    Attributes:
        nx, ny: direction from the point to the person, world frame; NaN: unknown.
        closing: the point's speed in this direction, m/s.
        speed: magnitude of its velocity, m/s; of a disc, that of its centre.
    """

    nx: Array
    ny: Array
    closing: Array
    speed: Array


def touch_point(
    run: Trajectories, sample: Indices, agent: Indices, jump_speed: float
) -> TouchPoint:
    """Return the robot's nearest point to a person in each of K samples.

    Args:
        run: a run with a robot.
        sample: (K,) samples.
        agent: (K,) columns of people.
        jump_speed: speed that detects teleports if none were recorded, m/s.
    """
    pair = encounter(run, jump_speed)
    vx, vy = (v[sample] for v in robot_velocities(run, jump_speed))
    px, py = pair.px[sample, agent], pair.py[sample, agent]
    if pair.footprint is not None:
        theta = pair.theta[sample]
        nx, ny, rx, ry = _nearest(pair.footprint, theta, px, py)
        turning = np.nan_to_num(inf_to_nan(robot_of(run).w)[sample])
        vx, vy = vx - turning * ry, vy + turning * rx
    else:
        distance = np.hypot(px, py)
        apart = distance > 0.0
        nx, ny = (np.divide(p, distance, out=np.zeros(p.shape), where=apart) for p in (px, py))
    return TouchPoint(nx, ny, vx * nx + vy * ny, np.hypot(vx, vy))


def _nearest(
    footprint: Footprint, theta: Array, px: Array, py: Array
) -> tuple[Array, Array, Array, Array]:
    """Return the outward direction and the point of the outline nearest to a person, world frame.

    The point is relative to the robot's centre.
    """
    c, s = np.cos(theta), np.sin(theta)
    x, y = c * px + s * py, c * py - s * px
    gap = footprint.gap(x, y)
    ux = (footprint.gap(x + _STEP, y) - footprint.gap(x - _STEP, y)) / (2.0 * _STEP)
    uy = (footprint.gap(x, y + _STEP) - footprint.gap(x, y - _STEP)) / (2.0 * _STEP)
    size = np.hypot(ux, uy)
    known = size > 0.0
    ux, uy = (np.divide(u, size, out=np.zeros(u.shape), where=known) for u in (ux, uy))
    nx, ny = c * ux - s * uy, c * uy + s * ux
    return nx, ny, px - gap * nx, py - gap * ny
