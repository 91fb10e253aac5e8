"""RobotStateSystem: the plant's state as the vector read by everything downstream."""

from __future__ import annotations

import math

import numpy as np
from pydrake.systems.framework import (
    BasicVector,
    Context,
    DependencyTicket,
    DiagramBuilder,
    DiscreteStateIndex,
    DiscreteValues,
)

from crowdbot.core.sim import ports
from crowdbot.core.sim.block import Block
from crowdbot.core.sim.plant import RobotPlant
from crowdbot.core.sim.weak_callback import NO_ATTRIBUTES, weak_callback
from crowdbot.core.support.compiling.compile import kernel
from crowdbot.core.types.arrays import Array
from crowdbot.core.types.motion import Pose
from crowdbot.core.types.robot import HolonomicDrive, RobotState


class RobotStateSystem(Block):
    """Input: the robot's positions and velocities. Output: `ports.ROBOT_STATE`."""

    __slots__ = NO_ATTRIBUTES

    def __init__(self, rig: RobotPlant) -> None:
        super().__init__()
        plant = rig.plant
        size = plant.num_positions(rig.model) + plant.num_velocities(rig.model)
        quaternion = rig.root.floating_positions_start()
        angular = rig.root.floating_velocities_start_in_v() + plant.num_positions(rig.model)
        wheels: list[int] = [j.position_start() for j in rig.wheels]
        left, right = wheels if wheels else (-1, -1)
        self._where = quaternion, angular, left, right, rig.rise
        self._port = self.DeclareVectorInputPort("plant_state", size)
        self.DeclareVectorOutputPort(
            ports.ROBOT_STATE,
            ports.ROBOT_STATE_SIZE,
            weak_callback(self._calc),
            prerequisites_of_calc={self._port.ticket(), *self._kept()},
        )

    def _kept(self) -> set[DependencyTicket]:
        """Return further dependencies of the output."""
        return set()

    def _calc(self, context: Context, output: BasicVector) -> None:
        _convert(self._port.Eval(context), *self._where, output.get_mutable_value())

    def convert(self, state: Array) -> RobotState:
        """Convert a plant state (quaternion w, x, y, z; position; …) to a `RobotState`."""
        found = np.zeros(ports.ROBOT_STATE_SIZE)
        _convert(state, *self._where, found)
        return RobotState(*found.tolist())


@kernel
def _convert(
    state: Array, quaternion: int, angular: int, left: int, right: int, rise: float, out: Array
) -> None:
    """Write the fields of a `RobotState` in order; wheels at -1 do not exist."""
    q, v = quaternion, angular
    w, x, y, z = state[q], state[q + 1], state[q + 2], state[q + 3]
    up = 1.0 - 2.0 * (x * x + y * y)  # cosine of the tilt
    out[0], out[1] = state[q + 4], state[q + 5]
    out[2] = math.atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z))
    out[3], out[4], out[5] = state[v + 3], state[v + 4], state[v + 2]
    out[6], out[7] = math.acos(min(1.0, max(-1.0, up))), state[q + 6] + rise
    out[8] = state[left] if left >= 0 else 0.0
    out[9] = state[right] if right >= 0 else 0.0
    out[10] = 0.0


class MeasuredRobotState(RobotStateSystem):
    """Robot state of a base without driven wheels, with three virtual measuring wheels.

    State: pose and the three angles at the last tick.
    """

    __slots__ = NO_ATTRIBUTES

    def __init__(self, rig: RobotPlant) -> None:
        drive = rig.robot.drive
        assert isinstance(drive, HolonomicDrive)
        self._drive = drive
        super().__init__(rig)
        self.DeclarePeriodicDiscreteUpdateEvent(rig.plant.time_step(), 0.0, self._update)

    def _kept(self) -> set[DependencyTicket]:
        self._memory = DiscreteStateIndex(self.DeclareDiscreteState(6))
        return {self.discrete_state_ticket(self._memory)}

    def place(self, context: object, start: Pose) -> None:
        """Start counting the wheels at a pose."""
        mine = self.GetMyMutableContextFromRoot(context)
        mine.SetDiscreteState(self._memory, [*start, 0.0, 0.0, 0.0])

    def _calc(self, context: Context, output: BasicVector) -> None:
        output.get_mutable_value()[:] = self._measured(context)

    def _update(self, context: Context, values: DiscreteValues) -> None:
        now = self._measured(context)
        values.get_mutable_value(self._memory)[:] = (*now[:3], *now[-3:])

    def _measured(self, context: Context) -> RobotState:
        now = self.convert(self._port.Eval(context))
        x, y, yaw, left, right, side = context.get_discrete_state(self._memory).value().tolist()
        turn = math.remainder(now.yaw - yaw, 2.0 * math.pi)
        c, s = math.cos(yaw + 0.5 * turn), math.sin(yaw + 0.5 * turn)
        dx, dy = now.x - x, now.y - y
        ahead, across = c * dx + s * dy, 0.5 * self._drive.track * turn
        radius = self._drive.wheel_radius
        return now._replace(
            left_angle=left + (ahead - across) / radius,
            right_angle=right + (ahead + across) / radius,
            side_angle=side + (c * dy - s * dx) / radius,
        )


def add_robot_state(builder: DiagramBuilder, rig: RobotPlant) -> RobotStateSystem:
    """Add the system to a diagram and connect it to the plant."""
    state = RobotStateSystem(rig) if rig.wheels else MeasuredRobotState(rig)
    builder.AddNamedSystem("robot_state", state)
    builder.Connect(rig.plant.get_state_output_port(rig.model), state.GetInputPort("plant_state"))
    return state
