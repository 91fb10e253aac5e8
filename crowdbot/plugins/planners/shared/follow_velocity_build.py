"""Commands that follow a wanted velocity: sideways, or by turning and driving ahead."""

from __future__ import annotations

import math

from crowdbot.plugin import Command, RobotLimits, kernel

#: Yaw rate per heading error, 1/s; error above which a robot turns on the spot, rad.
_GAIN, _TURN = 2.5, 1.2
#: Wanted velocities below this mean to stand, m/s.
_STILL = 0.02


@kernel
def slewed(value: float, target: float, change: float) -> float:
    """Return a value after one step towards a target, with a limited change."""
    return min(max(target, value - change), value + change)


def follow(
    velocity: tuple[float, float], yaw: float, facing: float, limits: RobotLimits
) -> Command:
    """Return the command with which a robot follows a velocity.

    Args:
        velocity: velocity in the frame of ``yaw``, m/s.
        yaw: the robot's, rad.
        facing: bearing of the goal from the robot, rad; a robot that stands, or that goes
            sideways, turns there.
        limits: the robot's.
    """
    speed = math.hypot(*velocity)
    if limits.vy_max > 0.0:
        off = math.atan2(velocity[1], velocity[0]) - yaw
        v, vy = speed * math.cos(off), speed * math.sin(off)
        share = min(
            1.0,
            limits.v_max / max(v, 1e-9) if v > 0.0 else limits.v_min / min(v, -1e-9),
            limits.vy_max / max(abs(vy), 1e-9),
        )
        return Command(v * share, _rate(facing, limits), vy * share)
    off = math.remainder(math.atan2(velocity[1], velocity[0]) - yaw, 2.0 * math.pi)
    if speed < _STILL:
        return Command(0.0, 0.0)
    v = speed * max(0.0, math.cos(off)) if abs(off) < _TURN else 0.0
    return Command(min(v, limits.v_max), _rate(off, limits))


def _rate(error: float, limits: RobotLimits) -> float:
    return max(-limits.w_max, min(limits.w_max, _GAIN * error))
