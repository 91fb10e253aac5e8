"""RobotStateSystem: the plant's state as the one vector that everything downstream reads."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray
from pydrake.systems.framework import BasicVector, Context, DiagramBuilder, LeafSystem

from crowdbot.core.interfaces import RobotState
from crowdbot.core.sim import ports
from crowdbot.core.sim.plant import RobotPlant

Array = NDArray[np.float64]


class RobotStateSystem(LeafSystem):
    """Input: the robot's positions and velocities. Output: `ports.ROBOT_STATE`."""

    def __init__(self, rig: RobotPlant) -> None:
        super().__init__()
        plant, drive = rig.plant, rig.robot.drive
        size = plant.num_positions(rig.model) + plant.num_velocities(rig.model)
        joints = [plant.GetJointByName(j) for j in (drive.left_joint, drive.right_joint)]
        base = plant.GetBodyByName(rig.robot.base, rig.model)
        self._quaternion = base.floating_positions_start()
        self._angular = base.floating_velocities_start_in_v() + plant.num_positions(rig.model)
        self._wheels = [j.position_start() for j in joints]
        self._port = self.DeclareVectorInputPort("plant_state", size)
        self.DeclareVectorOutputPort(
            ports.ROBOT_STATE,
            ports.ROBOT_STATE_SIZE,
            self._calc,
            prerequisites_of_calc={self._port.ticket()},
        )

    def _calc(self, context: Context, output: BasicVector) -> None:
        output.get_mutable_value()[:] = self.convert(self._port.Eval(context))

    def convert(self, state: Array) -> RobotState:
        """Plant state (quaternion w, x, y, z; position; …) as a `RobotState`."""
        values = state.tolist()  # Python floats: far cheaper one by one than numpy's
        w, x, y, z, px, py, pz = values[self._quaternion : self._quaternion + 7]
        _, _, wz, vx, vy, _ = values[self._angular : self._angular + 6]
        up = 1.0 - 2.0 * (x * x + y * y)  # cosine of the angle between body and world z
        return RobotState(
            x=px,
            y=py,
            yaw=math.atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z)),
            vx=vx,
            vy=vy,
            w=wz,
            tilt=math.acos(min(1.0, max(-1.0, up))),
            z=pz,
            left_angle=values[self._wheels[0]],
            right_angle=values[self._wheels[1]],
        )


def add_robot_state(builder: DiagramBuilder, rig: RobotPlant) -> RobotStateSystem:
    """Add the adaptor to a diagram and connect it to the plant."""
    state = RobotStateSystem(rig)
    builder.AddNamedSystem("robot_state", state)
    builder.Connect(rig.plant.get_state_output_port(rig.model), state.GetInputPort("plant_state"))
    return state
