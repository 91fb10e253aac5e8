"""A robot's model, limits, and state."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal, NamedTuple

from crowdbot.core.types.arrays import Array


@dataclass(frozen=True, slots=True, kw_only=True)
class RobotLimits:
    """A box of velocities and slew limits: m/s, rad/s, m/s^2, rad/s^2.

    ``|vy|`` is at most ``vy_max``, which is 0 if the drive cannot go sideways. ``a_max`` limits the
    change of the vector (v, vy), in the robot's frame. A robot that gets no command for
    ``command_timeout`` seconds brakes to a stop.
    """

    v_min: float
    v_max: float
    w_max: float
    a_max: float
    alpha_max: float
    command_timeout: float = math.inf
    vy_max: float = 0.0


@dataclass(frozen=True, slots=True, kw_only=True)
class DifferentialDrive:
    """Two driven wheels on one axis. ``command_radius`` converts commands to wheel rates."""

    left_joint: str
    right_joint: str
    command_radius: float
    track: float


@dataclass(frozen=True, slots=True, kw_only=True)
class HolonomicDrive:
    """An omnidirectional base, such as one on omni wheels.

    The wheels are not simulated: a force (control ``force``) or the command (``kinematic``) moves
    the base. Shapes that touch the floor must slide without friction.

    Attributes:
        max_force: the largest horizontal force, N, in any direction.
        max_torque: the largest torque about the vertical, N m.
        wheel_radius: radius of the virtual wheels that odometry counts, m: two that roll forward,
            ``track`` apart, and one under the base's frame that rolls to the left.
        track: distance between the wheels, m.
    """

    max_force: float
    max_torque: float
    wheel_radius: float = 0.035
    track: float = 0.23


@dataclass(frozen=True, slots=True, kw_only=True)
class RobotModel:
    """A robot's body and drive.

    Attributes:
        description: one robot in SDFormat or URDF. Joints with limits are held at zero; others roll
            freely, except the driven wheels. `crowdbot.core.robot_description` reads it.
        base: name of the base link, on which sensors are mounted: x ahead, on the vertical of the
            drive axis, ``base_height`` above the floor.
        footprint_radius: radius of the physical disc, m; with ``footprint``, of the capsule.
        footprint: outline of a robot that is not a disc, in its own frame, m: (2, 2) is the segment
            of a capsule, (K, 2) with K > 2 a convex polygon, counter-clockwise.
        height: height of the whole robot, m.
        force_height: height above the floor at which people push, m.
        skin_stiffness: of what people touch, in series with their own bodies, N/m; infinite of a
            rigid shell.
        notes: what was simplified to make it; a run prints them once.
    """

    description: str
    base: str
    base_height: float
    drive: DifferentialDrive | HolonomicDrive
    limits: RobotLimits
    footprint_radius: float
    height: float
    force_height: float
    mass: float
    footprint: Array | None = None
    skin_stiffness: float = math.inf
    notes: tuple[str, ...] = ()

    @property
    def wheels(self) -> tuple[float, float]:
        """Return radius and track of the wheels that odometry counts, m."""
        drive = self.drive
        radius = drive.wheel_radius if isinstance(drive, HolonomicDrive) else drive.command_radius
        return radius, drive.track


@dataclass(frozen=True, slots=True, kw_only=True)
class RobotBody:
    """The planner's data about its robot.

    Attributes:
        drive: ``differential``, or ``holonomic``, which also goes sideways.
        radius: radius of the disc or capsule, or of the circle around a polygon, m.
        footprint: outline of a robot that is not a disc, in its own frame (x forward), m: (2, 2)
            is the segment of a capsule, (K, 2) with K > 2 a convex polygon. None: a disc.
        front, back, half_width: extent ahead, behind and to either side of the drive axis's centre,
            m.
    """

    drive: Literal["differential", "holonomic"]
    radius: float
    footprint: Array | None
    front: float
    back: float
    half_width: float

    @property
    def reach(self) -> float:
        """Return the radius of the circle around the drive axis's centre that holds the robot."""
        if self.footprint is None:
            return self.radius
        corners = max(math.hypot(x, y) for x, y in self.footprint.tolist())
        return corners + (self.radius if len(self.footprint) == 2 else 0.0)


def robot_body(model: RobotModel) -> RobotBody:
    """Return the planner's data about a robot."""
    drive: Literal["differential", "holonomic"] = (
        "holonomic" if isinstance(model.drive, HolonomicDrive) else "differential"
    )
    points = [[0.0, 0.0]] if model.footprint is None else model.footprint.tolist()
    rim = model.footprint_radius if len(points) < 3 else 0.0
    return RobotBody(
        drive=drive,
        radius=model.footprint_radius,
        footprint=model.footprint,
        front=max(x for x, _ in points) + rim,
        back=rim - min(x for x, _ in points),
        half_width=max(abs(y) for _, y in points) + rim,
    )


class RobotState(NamedTuple):
    """The robot's state for all downstream users; world frame, SI.

    The last three are angles of driven or virtual wheels: left, right, and one that rolls to the
    left, for holonomic drives only.
    """

    x: float
    y: float
    yaw: float
    vx: float
    vy: float
    w: float
    tilt: float
    z: float
    left_angle: float
    right_angle: float
    side_angle: float = 0.0
