"""Cases of fault that are not in the decision table, judged as a reasonable person would."""

from __future__ import annotations

import numpy as np
import pytest

from crowdbot.core.types.arrays import Array
from scripts.fault_cases.cases import PERSON, REACH, Case, T, Track
from tests.core.trajectories.fault.test_decision_table import first_is_at_fault

ZERO = np.zeros_like(T)


def path(speed: Array, start: float = 0.0) -> Array:
    """Positions (N,) after speeds (N,) at the samples, m."""
    return np.concatenate([[start], start + np.cumsum(speed[:-1] * np.diff(T))])


def braking(speed: float, begins: float, rate: float) -> Track:
    return Track(x=path(np.clip(speed - rate * (T - begins), 0.0, speed)), y=ZERO)


def still(x: float, y: float = 0.0) -> Track:
    return Track(x=ZERO + x, y=ZERO + y)


def pushed_along(robot: Track, x: float) -> Track:
    return Track(x=np.maximum.accumulate(np.maximum(x, robot.x + REACH - 0.005)), y=ZERO)


LATE = braking(0.6, 5.0, 1.5)
STOPS = braking(0.6, 4.0, 2.0)
STARTS = Track(x=path(np.clip(T - 4.0, 0.0, 0.5)), y=ZERO)
BACKS = Track(x=path(np.where(T > 2.0, -0.3, 0.0)), y=ZERO)
MAKES_WAY = Track(
    x=path(np.clip(0.4 - 0.5 * (T - 3.0), 0.0, 0.4)), y=np.interp(T, [1.5, 3.0], [0.0, -0.5])
)
YAW = np.interp(T, [3.0, 4.0], [0.0, 1.2])
ARC = Track(x=path(0.4 * np.cos(YAW)), y=path(0.4 * np.sin(YAW)), theta=YAW)
SPINS = Track(x=ZERO, y=ZERO, theta=np.interp(T, [4.0, 6.0], [0.0, 1.5]))
STROKES = Track(
    x=path(np.select([T < 1.0, T % 0.8 < 0.25, T % 0.8 < 0.6], [0.0, 0.4, -0.15])), y=ZERO
)


@pytest.mark.parametrize(
    ("description", "fault", "robot", "person", "outline"),
    [
        ("brakes hard, but late", True, LATE, still(LATE.x[84] + REACH), False),
        ("a person walks into its flank", False, Track(x=0.1 * T, y=ZERO),
         Track(x=ZERO + 0.45, y=np.maximum(5.0 - T, REACH - 0.02)), False),
        ("overtakes, and clips a shoulder", True, Track(x=0.6 * T, y=ZERO),
         Track(x=1.2 + 0.3 * T, y=ZERO + 0.25), False),
        ("stops at once before a close follower", False, STOPS,
         Track(x=np.minimum(0.6 * T - REACH - 0.2, STOPS.x - REACH + 0.005), y=ZERO), False),
        ("starts at a person", True, STARTS, pushed_along(STARTS, REACH + 0.1), False),
        ("backs away from a person who runs at it", False, BACKS,
         Track(x=np.maximum(4.0 - 1.2 * T, BACKS.x + REACH - 0.005), y=ZERO), False),
        ("turns left, and its rear swings out to the right", True, ARC, still(0.95, -0.52), True),
        ("is round and turns on the spot, leant on", False, SPINS,
         Track(x=np.maximum(2.0 - 0.5 * T, REACH - 0.005), y=ZERO), False),
        ("pushes in short strokes", True, STROKES, pushed_along(STROKES, REACH + 0.06), False),
        ("makes way early; the follower swerves to the same side", False, MAKES_WAY,
         Track(x=np.minimum(T - 2.5, MAKES_WAY.x - 0.3), y=np.interp(T, [2.6, 3.6], [0.0, -0.5])),
         False),
        ("is long and turns on the spot, leant on", True, SPINS,
         Track(x=ZERO + 0.4, y=np.maximum(
             3.0 - T, 0.3 + PERSON - 0.005 + 0.36 * np.tan(np.clip(SPINS.theta, 0.0, 1.0)))),
         True),
    ],
)  # fmt: skip
def test_the_robot(
    description: str, fault: bool, robot: Track, person: Track, outline: bool
) -> None:
    case = Case(name="", told=description, fault=fault, rule="", shown=(), outline=outline,
                robot=robot, people=(person,))  # fmt: skip
    assert first_is_at_fault(case.run()) is fault
