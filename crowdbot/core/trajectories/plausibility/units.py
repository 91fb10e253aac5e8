"""Units of bodies, of slow motion and of rates of turning that are hardly SI units."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from crowdbot.core.trajectories.plausibility.jumps import steps_and_speeds
from crowdbot.core.types.arrays import Array

#: Largest radius, m, and mass, kg, of a person (a wheelchair or a cart included).
_PERSON_RADIUS, _PERSON_MASS = 2.0, 1000.0
#: Largest radius, m, and mass, kg, of a robot.
_ROBOT_RADIUS, _ROBOT_MASS = 10.0, 20_000.0
#: Slower than any drive, m/s; a body that goes one way so slowly is in a larger unit.
_CREEPING, _ONE_WAY = 0.005, 0.5
#: Samples that a finding needs, and the least rate of turning that is compared, rad/s.
_FEW, _TURNING = 5, 0.02


def bodies(run: Any) -> Iterator[str]:
    """Yield a sentence for implausible radii and masses.

    Args:
        run: the trajectories.
    """
    robot, people = run.robot, run.agents
    if robot is not None:
        yield from _size("robot_radius", robot.radius, _ROBOT_RADIUS)
        yield from _weight("robot_mass", robot.mass, _ROBOT_MASS)
    if people is not None and len(people.id):
        yield from _size("people: median radius", np.median(people.radius), _PERSON_RADIUS)
        yield from _weight("people: median mass", np.median(people.mass), _PERSON_MASS)


def _size(name: str, radius: float, most: float) -> Iterator[str]:
    if radius > most:
        unit = "millimetres" if radius > 100.0 * most else "centimetres"
        unit = "millimetres or centimetres" if name == "robot_radius" else unit
        yield f"{name} {radius:g} m: {unit}? Lengths are in metres"


def _weight(name: str, mass: float, most: float) -> Iterator[str]:
    if mass > most:
        yield f"{name} {mass:g} kg: grams? Masses are in kilograms"


def creeping(t: Array, name: str, x: Array, y: Array) -> Iterator[str]:
    """Yield a sentence for bodies that move straight on, but slower than bodies usually do.

    Args:
        t: times (N,), s.
        name: the robot or people, for the sentence.
        x, y: places (N,) or (N, M), m; NaN where absent.
    """
    if len(t) < _FEW:
        return
    x, y = x.reshape(len(t), -1), y.reshape(len(t), -1)
    steps, speeds = steps_and_speeds(t, x, y)
    moving = np.isfinite(speeds) & (steps > 0.0)
    if np.count_nonzero(moving) < _FEW:
        return
    speed = float(np.median(speeds[moving]))
    ways = np.nansum(steps, axis=0)
    net = np.array([_net(x[:, i], y[:, i]) for i in range(x.shape[1])])
    if speed < _CREEPING and float(np.sum(net)) > _ONE_WAY * float(np.sum(ways)):
        yield (
            f"{name}: median speed {speed:.2g} m/s, and straight on: kilometres, or longitude "
            "and latitude? Positions are in metres"
        )


def _net(x: Array, y: Array) -> float:
    """Return the distance from the first to the last known place, m."""
    known = np.flatnonzero(np.isfinite(x + y))
    if len(known) < 2:
        return 0.0
    a, b = known[0], known[-1]
    return float(np.hypot(x[b] - x[a], y[b] - y[a]))


def turning(run: Any) -> Iterator[str]:
    """Yield a sentence if the robot's rate of turning is in degrees and its heading is not.

    Args:
        run: the trajectories.
    """
    robot = run.robot
    if robot is None or robot.w is None or len(run.t) < _FEW:
        return
    with np.errstate(invalid="ignore"):
        rate = np.abs(np.gradient(np.unwrap(robot.theta), run.t))
        known = np.isfinite(rate + robot.w) & (rate > _TURNING)
    if np.count_nonzero(known) < _FEW:
        return
    turned, recorded = float(np.median(rate[known])), float(np.median(np.abs(robot.w[known])))
    if abs(np.radians(recorded) / turned - 1.0) < 0.2:
        yield (
            f"the robot: w is {recorded:.3g} rad/s (median) where the heading changes by "
            f"{turned:.2g} rad/s: degrees? 'w [deg/s]' as a column's name says so"
        )
