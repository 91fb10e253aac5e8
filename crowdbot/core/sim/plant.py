"""The multibody plant: floor, obstacles and one robot."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from pydrake.geometry import Box, Convex, Cylinder
from pydrake.math import RigidTransform, RollPitchYaw
from pydrake.multibody.parsing import Parser
from pydrake.multibody.plant import (
    AddMultibodyPlant,
    CoulombFriction,
    MultibodyPlant,
    MultibodyPlantConfig,
)
from pydrake.multibody.tree import (
    Joint,
    JointActuator,
    ModelInstanceIndex,
    PdControllerGains,
    RigidBody,
)
from pydrake.systems.framework import DiagramBuilder

from crowdbot.core.robots.description import Description
from crowdbot.core.robots.description_file import read_description
from crowdbot.core.robots.simplify import simplified
from crowdbot.core.sim.drake_failures import drake_failures
from crowdbot.core.support.ticks import TICK
from crowdbot.core.types.environment import EnvironmentParts
from crowdbot.core.types.motion import Pose
from crowdbot.core.types.robot import DifferentialDrive, RobotModel
from crowdbot.errors import PluginError

_WALL = CoulombFriction(0.3, 0.3)
_WALL_THICKNESS = 0.2  # m
#: Friction of a robot's convex pieces, which slide as all its shapes except driven wheels do.
_SLIDES = CoulombFriction(0.0, 0.0)


@dataclass(frozen=True, slots=True)
class RobotPlant:
    """The finished plant and its only robot.

    Attributes:
        root: the floating body, parent of the base.
        rise: height of the base's frame above the root's, m.
        wheels: the driven joints, left and right; empty for a holonomic drive.
    """

    plant: MultibodyPlant
    model: ModelInstanceIndex
    robot: RobotModel
    root: RigidBody
    rise: float
    wheels: tuple[Joint, ...]


def add_plant(
    builder: DiagramBuilder,
    parts: EnvironmentParts,
    robot: RobotModel,
    gains: PdControllerGains | None,
    tick: float = TICK,
) -> RobotPlant:
    """Add the plant to a diagram, ready for wiring; without gains the wheels roll freely.

    Args:
        tick: its time step, s.

    Raises:
        PluginError: Drake cannot parse the robot's description.
    """
    config = MultibodyPlantConfig(
        time_step=tick, discrete_contact_approximation="lagged", contact_model="point"
    )
    plant, _ = AddMultibodyPlant(config, builder)
    described = read_description(robot.description)
    drive = robot.drive
    driven = (drive.left_joint, drive.right_joint) if isinstance(drive, DifferentialDrive) else ()
    model = _parse(plant, described, driven)
    wheels = _motorised(plant, model, described, driven)
    world = plant.world_body()
    plant.RegisterCollisionGeometry(
        world, RigidTransform([0.0, 0.0, -1.0]), Box(1e3, 1e3, 2.0), "floor",
        floor_of(parts.floor_friction),
    )  # fmt: skip
    for s in np.flatnonzero(parts.stops_robot):
        pose, box = wall_box(parts.walls[s], parts.wall_heights[s])
        plant.RegisterCollisionGeometry(world, pose, box, f"wall{s}", _WALL)
    for b, outline in enumerate(parts.solids):
        prism = solid_prism(outline, parts.solid_heights[b], f"solid{b}")
        plant.RegisterCollisionGeometry(world, RigidTransform(), prism, f"solid{b}", _WALL)
    for p, (x, y, radius) in enumerate(parts.pillars):
        low, high = parts.pillar_heights[p]
        pose = RigidTransform([x, y, 0.5 * (low + high)])
        pillar = Cylinder(radius, high - low)
        plant.RegisterCollisionGeometry(world, pose, pillar, f"pillar{p}", _WALL)
    if gains is not None:
        for joint in wheels:
            motor_of(plant, joint).set_controller_gains(gains)
    # With sampled ports the crowd would see the plant after its update: action != reaction.
    plant.SetUseSampledOutputPorts(False)
    try:
        with drake_failures():
            plant.Finalize()
    except RuntimeError as error:
        raise PluginError(f"the robot cannot be simulated: {error}") from error
    rise = float(described.pose(robot.base, described.root)[2, 3])
    root = plant.GetBodyByName(described.root, model)
    return RobotPlant(plant, model, robot, root, rise, wheels)


def floor_of(friction: float) -> CoulombFriction:
    """Return the floor that gives this friction with a tyre, whose own coefficient is 1.

    Drake combines the coefficients a and b of two surfaces as 2 a b / (a + b).
    """
    own = friction / (2.0 - friction)
    return CoulombFriction(own, own)


def _parse(
    plant: MultibodyPlant, described: Description, driven: tuple[str, ...]
) -> ModelInstanceIndex:
    try:
        text, pieces = simplified(described, driven)
        with drake_failures():
            (model,) = Parser(plant).AddModelsFromString(text, described.format)
        for piece in pieces:
            body = plant.GetBodyByName(piece.link, model)
            hull = Convex(points=piece.corners.T, label=piece.name)
            plant.RegisterCollisionGeometry(body, RigidTransform(), hull, piece.name, _SLIDES)
    except (RuntimeError, ValueError) as error:
        raise PluginError(f"the robot's description cannot be read by Drake: {error}") from error
    return model


def _motorised(
    plant: MultibodyPlant,
    model: ModelInstanceIndex,
    described: Description,
    names: tuple[str, ...],
) -> tuple[Joint, ...]:
    """Return the driven wheels' joints, which have the only motors."""
    joints = tuple(plant.GetJointByName(name, model) for name in names)
    moved = set()
    for index in plant.GetJointActuatorIndices():  # that of one model is empty here
        motor = plant.get_joint_actuator(index)
        moved.add(motor.joint().name())
        if motor.joint().name() not in names:
            plant.RemoveJointActuator(motor)
    for name, joint in zip(names, joints, strict=True):
        if name not in moved:
            plant.AddJointActuator(name, joint, described.joint(name).effort)
    return joints


def motor_of(plant: MultibodyPlant, joint: Joint) -> JointActuator:
    """Return the actuator of a driven wheel's joint."""
    motors = (plant.get_joint_actuator(i) for i in plant.GetJointActuatorIndices())
    return next(m for m in motors if m.joint().index() == joint.index())


def wall_box(
    segment: NDArray[np.float64], heights: NDArray[np.float64]
) -> tuple[RigidTransform, Box]:
    """Return a box behind a wall segment: its face is the segment, seen from the left."""
    x0, y0, x1, y1 = segment
    low, high = heights
    length = float(np.hypot(x1 - x0, y1 - y0))
    yaw = float(np.arctan2(y1 - y0, x1 - x0))
    behind_x, behind_y = 0.5 * _WALL_THICKNESS * np.sin(yaw), -0.5 * _WALL_THICKNESS * np.cos(yaw)
    centre = [0.5 * (x0 + x1) + behind_x, 0.5 * (y0 + y1) + behind_y, 0.5 * (low + high)]
    pose = RigidTransform(RollPitchYaw(0.0, 0.0, yaw), centre)
    return pose, Box(length, _WALL_THICKNESS, high - low)


def solid_prism(outline: NDArray[np.float64], heights: NDArray[np.float64], name: str) -> Convex:
    """Return the upright prism over a convex outline (K, 2), between two heights."""
    corners = [(x, y, z) for x, y in outline for z in heights]
    return Convex(points=np.array(corners).T, label=name)


def place_robot(rig: RobotPlant, context: object, start: Pose) -> None:
    """Put the robot on the floor at its start pose, at rest."""
    height = rig.robot.base_height - rig.rise
    pose = RigidTransform(RollPitchYaw(0.0, 0.0, start.yaw), [start.x, start.y, height])
    rig.plant.SetFreeBodyPose(context, rig.root, pose)
