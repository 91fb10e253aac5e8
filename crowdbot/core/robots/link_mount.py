"""Mount sensors on links of the robot's description."""

from __future__ import annotations

import math

from crowdbot.core.robots.description_file import read_description
from crowdbot.core.types.arrays import Array
from crowdbot.core.types.robot import RobotModel
from crowdbot.dsl.spec.component_specs import SensorSpec
from crowdbot.dsl.spec.spec import Mount, TiltableMount
from crowdbot.errors import InputError

#: Tilt of a link up to which a sensor that cannot be tilted counts as level, rad.
_LEVEL = 1e-3


def at_link(spec: SensorSpec, robot: RobotModel) -> SensorSpec:
    """Return a sensor whose mount is the pose of its link, with all joints at zero.

    Args:
        spec: a sensor; without a link it is returned as it is.
        robot: the robot that carries it.

    Raises:
        InputError: it has a mount as well, or none, or the link is tilted and the sensor cannot be.
        PluginError: there is no such link.
    """
    if spec.link is None:
        return spec
    field = type(spec).model_fields.get("mount")
    given = getattr(spec, "mount", None)
    if field is None or not isinstance(given, Mount):
        raise InputError(f"{spec.kind} is not mounted on a link: leave 'link: {spec.link}' out")
    if given != field.default:
        raise InputError(
            f"{spec.kind} on link '{spec.link}' has a mount, too; leave one of both out"
        )
    pose = read_description(robot.description).pose(spec.link, robot.base)
    return spec.model_copy(update={"mount": _mount(pose, type(given), spec)})


def _mount(pose: Array, kind: type[Mount], spec: SensorSpec) -> Mount:
    """Return a pose (4, 4) as a mount: Rz(yaw) Ry(pitch) Rx(roll)."""
    x, y, z = (round(float(v), 9) for v in pose[:3, 3])
    pitch = math.atan2(-pose[2, 0], math.hypot(pose[2, 1], pose[2, 2]))
    roll, yaw = math.atan2(pose[2, 1], pose[2, 2]), math.atan2(pose[1, 0], pose[0, 0])
    roll, pitch, yaw = (round(angle, 9) for angle in (roll, pitch, yaw))
    if issubclass(kind, TiltableMount):
        return kind(x=x, y=y, z=z, yaw=yaw, roll=roll, pitch=pitch)
    if max(abs(roll), abs(pitch)) > _LEVEL:
        raise InputError(
            f"link '{spec.link}' is tilted (roll {roll:.3g}, pitch {pitch:.3g} rad), and a "
            f"{spec.kind} cannot be"
        )
    return kind(x=x, y=y, z=z, yaw=yaw)
