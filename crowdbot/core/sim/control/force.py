"""Force control: F = m dv/dt on the base, limited by the drive's force.

Source: CrowdBot D7.3, section 1.1 (control modes). Mass and inertia include everything that a force
at the base moves, such as driven wheels. A holonomic drive also gets a sideways force, at the
height of its centre of mass; the wheels of a differential drive hold it on its track.
"""

from __future__ import annotations

import math

import numpy as np
from pydrake.systems.framework import BasicVector, Context, DiagramBuilder

from crowdbot.core.sim import ports
from crowdbot.core.sim.block import Block
from crowdbot.core.sim.control.controlled import ControlledRobot, push_on
from crowdbot.core.sim.plant import RobotPlant, add_plant, motor_of, place_robot
from crowdbot.core.sim.robot_state import MeasuredRobotState, add_robot_state
from crowdbot.core.sim.weak_callback import NO_ATTRIBUTES, weak_callback
from crowdbot.core.types.environment import EnvironmentParts
from crowdbot.core.types.motion import Pose
from crowdbot.core.types.robot import DifferentialDrive, HolonomicDrive, RobotModel

_GRAVITY = 9.81  # m/s^2, as in the plant


class ForceDrive(Block):
    """Inputs: robot state, desired v, w and vy, force of people. Output: generalised force.

    The output depends directly on the state: with a delay of one tick, a gain of one would
    oscillate.
    """

    __slots__ = NO_ATTRIBUTES

    def __init__(self, rig: RobotPlant, friction: float = 1.0) -> None:
        super().__init__()
        size = rig.plant.num_velocities()
        self._start = push_on(rig).at or 0
        self._mass, self._inertia = moved(rig)
        self._sideways = isinstance(rig.robot.drive, HolonomicDrive)
        self._lever = _centre_above_root(rig) if self._sideways else 0.0
        self._most, self._most_torque = on_the_floor(strongest(rig), rig.robot.mass, friction)
        self._tick = rig.plant.time_step()
        self._robot = self.DeclareVectorInputPort(ports.ROBOT_STATE, ports.ROBOT_STATE_SIZE)
        self._desired = self.DeclareVectorInputPort(ports.DESIRED_STATE, 3)
        self._push = self.DeclareVectorInputPort(ports.ROBOT_FORCE, size)
        self.DeclareVectorOutputPort(
            "force",
            size,
            weak_callback(self._calc),
            prerequisites_of_calc={p.ticket() for p in (self._robot, self._desired, self._push)},
        )

    def _calc(self, context: Context, output: BasicVector) -> None:
        _, _, yaw, vx, vy, w, *_ = self._robot.Eval(context).tolist()
        wanted_v, wanted_w, wanted_vy = self._desired.Eval(context).tolist()
        c, s = math.cos(yaw), math.sin(yaw)
        force, aside = self._mass * (wanted_v - (c * vx + s * vy)) / self._tick, 0.0
        if self._sideways:
            aside = self._mass * (wanted_vy - (c * vy - s * vx)) / self._tick
            size = math.hypot(force, aside)
            share = min(1.0, self._most / size) if size else 1.0
            force, aside = share * force, share * aside
        force = _clamp(force, self._most)
        torque = _clamp(self._inertia * (wanted_w - w) / self._tick, self._most_torque)
        values = output.get_mutable_value()
        values[:] = self._push.Eval(context) if self._push.HasValue(context) else 0.0
        i = self._start
        fx, fy = c * force - s * aside, s * force + c * aside
        values[i : i + 5] += -self._lever * fy, self._lever * fx, torque, fx, fy


def _centre_above_root(rig: RobotPlant) -> float:
    """Return the height of the centre of mass above the root's frame, m.

    The force acts there. Lower, it would also tilt the robot, and its base would respond as if it
    were lighter: the speed of a tall robot would oscillate.
    """
    context = rig.plant.CreateDefaultContext()
    centre = rig.plant.CalcCenterOfMassPositionInWorld(context, [rig.model])
    root = rig.plant.EvalBodyPoseInWorld(context, rig.root).translation()
    return float(centre[2] - root[2])


def _clamp(value: float, most: float) -> float:
    return min(most, max(-most, value))


def moved(rig: RobotPlant) -> tuple[float, float]:
    """Return mass (kg) and yaw inertia (kg m^2) that a force at the base moves.

    The wheels roll along.
    """
    plant, drive = rig.plant, rig.robot.drive
    matrix = plant.CalcMassMatrix(plant.CreateDefaultContext())
    start = rig.root.floating_velocities_start_in_v()
    mass, inertia = float(matrix[start + 3, start + 3]), float(matrix[start + 2, start + 2])
    if isinstance(drive, DifferentialDrive):
        turned = (j.velocity_start() for j in rig.wheels)
        rolling = sum(float(matrix[k, k]) for k in turned) / drive.command_radius**2
        return mass + rolling, inertia + rolling * (0.5 * drive.track) ** 2
    return mass, inertia


def strongest(rig: RobotPlant) -> tuple[float, float]:
    """Return the largest force (N) and torque (N m) of the drive, with both motors."""
    drive = rig.robot.drive
    if isinstance(drive, HolonomicDrive):
        return drive.max_force, drive.max_torque
    efforts = [motor_of(rig.plant, joint).effort_limit() for joint in rig.wheels]
    force = float(np.sum(efforts)) / drive.command_radius
    return force, force * 0.5 * drive.track


def on_the_floor(drive: tuple[float, float], mass: float, friction: float) -> tuple[float, float]:
    """Return force (N) and torque (N m) of a drive, limited by a slippery floor.

    The force is at most the friction of the whole weight; torque is scaled alike. On a floor with
    the default friction, 1, drives do not slip.
    """
    force, torque = drive
    share = min(1.0, friction * mass * _GRAVITY / force) if friction < 1.0 else 1.0
    return share * force, share * torque


def add_force(
    builder: DiagramBuilder, parts: EnvironmentParts, model: RobotModel, tick: float
) -> ControlledRobot:
    """Add a force on the base; the wheels roll freely."""
    rig = add_plant(builder, parts, model, None, tick)
    plant = rig.plant
    state = add_robot_state(builder, rig)
    drive = builder.AddNamedSystem("force_drive", ForceDrive(rig, parts.floor_friction))
    builder.Connect(state.GetOutputPort(ports.ROBOT_STATE), drive.GetInputPort(ports.ROBOT_STATE))
    builder.Connect(drive.GetOutputPort("force"), plant.get_applied_generalized_force_input_port())

    def place(context: object, start: Pose) -> None:
        place_robot(rig, plant.GetMyMutableContextFromRoot(context), start)
        if isinstance(state, MeasuredRobotState):
            state.place(context, start)

    return ControlledRobot(
        state=state,
        desired=drive.GetInputPort(ports.DESIRED_STATE),
        desire=lambda v, w, vy: (v, w, vy),
        desired_size=3,
        push=push_on(rig),
        push_port=drive.GetInputPort(ports.ROBOT_FORCE),
        place=place,
        rig=rig,
    )
