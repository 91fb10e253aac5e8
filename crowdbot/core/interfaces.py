"""What each category of component must be able to do.

All small and at numpy level: SI units, float64, read-only inputs, new outputs; world frame
x along the corridor, y left, z up, yaw counter-clockwise (REP-103).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import TYPE_CHECKING, NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from crowdbot.core.commands import Commands
    from crowdbot.core.questionnaires import Questionnaires
    from crowdbot.core.score import Score
    from crowdbot.core.sensing.scene import Scene
    from crowdbot.core.trajectory import Trajectories

Array = NDArray[np.float64]


class Pose(NamedTuple):
    """Pose in the plane."""

    x: float
    y: float
    yaw: float


class Command(NamedTuple):
    """Body velocity: v forward (m/s), w counter-clockwise (rad/s), vy to the left (m/s).

    Only a holonomic drive can give vy; for all others it is clamped to 0.
    """

    v: float
    w: float
    vy: float = 0.0


# ---------------------------------------------------------------- environment
@dataclass(frozen=True, slots=True, kw_only=True)
class EnvironmentParts:
    """Plain geometry; core makes plant boxes, ray targets, crowd obstacles and drawings of it.

    Attributes:
        walls: (S, 4) segments x0, y0, x1, y1, m; the free side is on their left.
        wall_heights: (S, 2) bottom and top, m.
        stops_robot: (S,) bool, the robot collides with the segment.
        stops_crowd: (S,) bool, people avoid the segment.
        zones: name -> (K, 2) polygon, counter-clockwise, m.
        portals: name -> (x0, x1, y0, y1), m.
        pillars: (P, 3) x, y and radius of round obstacles for robot and people, m.
        pillar_heights: (P, 2) bottom and top, m.
        solids: convex outlines (K, 2), counter-clockwise, of what the robot collides with as a
            whole, m; sensors and people meet their sides, which are among ``walls``.
        solid_heights: (B, 2) bottom and top, m.
        torus: (x0, x1, y0, y1) of a floor on which people who leave on one side come back on the
            other and see each other across the border, m; None for a floor with borders.
    """

    walls: Array
    wall_heights: Array
    stops_robot: NDArray[np.bool_]
    stops_crowd: NDArray[np.bool_]
    zones: Mapping[str, Array]
    portals: Mapping[str, tuple[float, float, float, float]]
    pillars: Array = field(default_factory=lambda: np.zeros((0, 3)))
    pillar_heights: Array = field(default_factory=lambda: np.zeros((0, 2)))
    solids: tuple[Array, ...] = ()
    solid_heights: Array = field(default_factory=lambda: np.zeros((0, 2)))
    torus: tuple[float, float, float, float] | None = None


# ---------------------------------------------------------------------- robot
@dataclass(frozen=True, slots=True, kw_only=True)
class RobotLimits:
    """A box of velocities and slew limits: m/s, rad/s, m/s^2, rad/s^2.

    |vy| is at most ``vy_max``, which is 0 where the drive does not go sideways. ``a_max`` limits
    the change of the vector (v, vy), in the robot's frame. A robot that gets no command for
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
    """Two driven wheels on one axis. ``command_radius`` turns commands into wheel rates."""

    left_joint: str
    right_joint: str
    command_radius: float
    track: float


@dataclass(frozen=True, slots=True, kw_only=True)
class HolonomicDrive:
    """A base that goes in every direction, such as one on omni wheels.

    The wheels themselves are not simulated: a force moves the base (control ``force``), or the
    command does (``kinematic``). What touches the floor must slide without friction.

    Attributes:
        max_force: the largest horizontal force, N, in any direction.
        max_torque: the largest torque about the vertical, N m.
        wheel_radius: of the measuring wheels that odometry counts, m: two that roll forward,
            ``track`` apart, and one under the base's frame that rolls to the left.
        track: m.
    """

    max_force: float
    max_torque: float
    wheel_radius: float = 0.035
    track: float = 0.23


@dataclass(frozen=True, slots=True, kw_only=True)
class RobotModel:
    """A robot's body and drive.

    Attributes:
        description: one robot in SDFormat or URDF. Joints with limits are held at zero; others
            roll freely, but for the driven wheels. `crowdbot.core.robot_description` reads it.
        base: name of the base link, which sensors are mounted on: x ahead, on the vertical of the
            drive axis, ``base_height`` above the floor.
        footprint_radius: radius of the physical disc, m; of a capsule with ``footprint``.
        footprint: outline of a robot that is no disc, in its own frame, m: (2, 2) is the segment
            of a capsule, (K, 2) with K > 2 a convex polygon, counter-clockwise.
        height: of the whole robot, m.
        force_height: height above the floor at which people push, m.
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


class RobotState(NamedTuple):
    """What everything downstream of the robot reads; world frame, SI.

    The last three are angles of wheels, driven or measuring: left, right, and one that rolls to
    the left, which only a robot with a holonomic drive has.
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


# --------------------------------------------------------------------- sensor
@dataclass(frozen=True, slots=True, kw_only=True)
class Pinhole:
    """A camera that looks along x of its frame; images are (height, width), top left first.

    Attributes:
        width, height: pixels.
        focal: focal length, pixels; pixels are square and the axis goes through the centre.
        colour: whether it takes colour images too.
    """

    width: int
    height: int
    focal: float
    colour: bool = False

    @property
    def centre(self) -> tuple[float, float]:
        """Column and row of the optical axis, counted from the centre of the first pixel."""
        return 0.5 * (self.width - 1), 0.5 * (self.height - 1)


@dataclass(frozen=True, slots=True, kw_only=True)
class SensorInfo:
    """What a planner or a recorder may know about a sensor.

    Attributes:
        category: ``lidar``, ``odometry``, ``ultrasound``, …
        mount: x, y, z, yaw from base_link (m, rad).
        shape: shape of a reading's values.
        angles: in the sensor frame, rad: (R,) of the beams of a lidar, (L, C, 2) azimuth and
            elevation of each beam of a multi-layer lidar, (2,) edges of the zone of an ultrasound
            or an infrared sensor; or None.
        sees: whether ``read`` looks at the people of the scene; if not, they may be out of date.
        memory: number of float64 the sensor keeps between readings (0: none).
        random: whether ``read`` draws from ``rng``; if not, it must leave it alone.
        camera: of a sensor whose readings are images. They are a pure function of what is seen
            at their instant and are kept out of the simulation's state; such a sensor has no
            memory.
        privileged: whether readings tell what no sensor of a real robot could; only planners
            that say that they are privileged may read them.
    """

    category: str
    frame: str
    mount: tuple[float, float, float, float]
    rate: float
    shape: tuple[int, ...]
    ros_type: str
    angles: Array | None = None
    range_min: float = 0.0
    range_max: float = float("inf")
    memory: int = 0
    random: bool = True
    sees: bool = True
    camera: Pinhole | None = None
    privileged: bool = False


class Reading(NamedTuple):
    """A sensor's latest values and the simulated time at which they were taken (s).

    Images are float32. ``colour`` is (height, width, 3) uint8 of a camera that has it.
    """

    stamp: float
    values: Array
    colour: NDArray[np.uint8] | None = None


class Sensor(Protocol):
    """A sensor without memory."""

    def info(self) -> SensorInfo:
        """Constant description."""
        ...

    def read(self, scene: Scene, pose: Pose, t: float, rng: np.random.Generator) -> Array:
        """Return new values of ``info().shape``. ``pose`` is base_link's, world frame."""
        ...


class SensorWithMemory(Protocol):
    """A sensor whose ``info().memory > 0``; it keeps all its state in ``memory``."""

    def info(self) -> SensorInfo:
        """Constant description."""
        ...

    def read(
        self, scene: Scene, pose: Pose, t: float, rng: np.random.Generator, memory: Array
    ) -> Array:
        """As `Sensor.read`; ``memory`` starts as zeros and is changed in place."""
        ...


class NoiseGenerator(Protocol):
    """One error of a proximity sensor.

    Attributes:
        random: whether ``errors`` draws from ``rng``; if not, it must leave it alone.
    """

    random: bool

    def errors(self, distance: Array, rng: np.random.Generator) -> Array:
        """What to add to distances (N,), m, finite; inf is a beam that hit nothing.

        As many numbers are drawn whatever the distances are. Errors of generators that come
        before are in ``distance`` already.
        """
        ...


# -------------------------------------------------------------------- planner
@dataclass(frozen=True, slots=True, kw_only=True)
class Task:
    """Start pose and goal, in the world frame, which the odometry frame equals at t = 0."""

    start: Pose
    goal: tuple[float, float]
    goal_zone: Array
    time_limit: float


def _ignore(name: str, value: float) -> None:
    del name, value


@dataclass(frozen=True, slots=True, kw_only=True)
class Observation:
    """What a planner sees in one step. No ground truth.

    Attributes:
        t: simulated time, s.
        pose: pose by wheel odometry (x, y, yaw).
        twist: forward speed (m/s) and yaw rate (rad/s) by wheel odometry.
        vy: speed to the left (m/s) by odometry that measures it (``holonomic_odometry``).
        goal, goal_zone: in the same frame as ``pose``.
        readings: latest reading of each sensor that was asked for.
        log: ``log(name, value)`` records a named signal of the run.
    """

    t: float
    pose: Pose
    twist: tuple[float, float]
    goal: tuple[float, float]
    goal_zone: Array
    vy: float = 0.0
    readings: Mapping[str, Reading] = field(default_factory=lambda: MappingProxyType({}))
    log: Callable[[str, float], None] = _ignore


class NoValidCommand(Exception):  # noqa: N818 - a word of the planner contract
    """A planner may raise this when it knows no command; the robot is told to stop."""


class Planner(Protocol):
    """The thing under test."""

    def reset(
        self, task: Task, limits: RobotLimits, sensors: Mapping[str, SensorInfo], seed: int
    ) -> None:
        """Called once before the first step."""
        ...

    def step(self, obs: Observation) -> Command:
        """Return the next command; may raise `NoValidCommand`."""
        ...


# --------------------------------------------------------------------- metric
@dataclass(frozen=True, slots=True, kw_only=True)
class References:
    """What a run is compared with, and what else was recorded of it; all may be missing.

    Attributes:
        robot_alone: the same robot without people.
        crowd_alone: the same people without robot.
        commands: the user's and the final commands of this run.
        commands_baseline: of a drive of the same user without shared control.
        questionnaires: what the user answered after this run.
    """

    robot_alone: Trajectories | None = None
    crowd_alone: Trajectories | None = None
    commands: Commands | None = None
    commands_baseline: Commands | None = None
    questionnaires: Questionnaires | None = None


class Metric(Protocol):
    """A pure function of trajectories."""

    def score(self, run: Trajectories, refs: References) -> Sequence[Score]:
        """One score per variant; a status instead of NaN."""
        ...
