"""Check a robot's limits against its drive's numbers: speed, acceleration, track."""

from __future__ import annotations

from collections.abc import Iterator

from crowdbot.core.robots.description import Description
from crowdbot.core.types.robot import DifferentialDrive, RobotModel

#: Share of a limit that a drive has to reach; what it lacks is told below.
_REACHED, _ACCELERATED = 0.95, 0.5
#: Wheels farther out than this many times the outline's reach are told.
_BEYOND = 1.5


def beyond_the_drive(
    model: RobotModel, drive: DifferentialDrive, described: Description
) -> Iterator[str]:
    """Yield a note for each limit that the wheels' joints contradict.

    Args:
        model: the robot.
        drive: its drive.
        described: its description.
    """
    wheels = [described.joint(name) for name in (drive.left_joint, drive.right_joint)]
    turns = min((j.velocity for j in wheels if j.velocity is not None), default=None)
    most = model.limits.v_max
    if turns is not None and turns * drive.command_radius < _REACHED * most:
        yield (
            f"its wheels' joints are limited to {turns:.3g} rad/s, which is "
            f"{turns * drive.command_radius:.3g} m/s; the limit is not kept: v_max is {most:.3g} "
            "m/s"
        )
    torque = sum(joint.effort or 0.0 for joint in wheels)
    reached = torque / drive.command_radius / model.mass
    if reached < _ACCELERATED * model.limits.a_max:
        yield (
            f"the torque of its wheels, together {torque:.3g} N m, accelerates its "
            f"{model.mass:.6g} kg by {reached:.2g} m/s^2 of a_max {model.limits.a_max:.3g} m/s^2 "
            "(masses are in kilograms)"
        )
    if 0.5 * drive.track > _BEYOND * model.footprint_radius:
        yield (
            f"its wheels are {drive.track:.3g} m apart, and its outline reaches "
            f"{model.footprint_radius:.3g} m from the middle (lengths are in metres)"
        )
