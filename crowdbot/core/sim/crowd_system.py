"""CrowdSystem: the crowd and its contact with the robot, advanced in one event.

The event is unrestricted, so it runs before the plant's discrete update: the force on the robot
and the reaction on people come from one computation on one state, and balance exactly
(docs/decisions/0004).
"""

from __future__ import annotations

import numpy as np
from pydrake.systems.framework import Context, DiscreteStateIndex, LeafSystem, State

from crowdbot.core.crowd import CrowdEngine
from crowdbot.core.crowd import state as s
from crowdbot.core.sim import ports
from crowdbot.core.sim.plant import RobotPlant
from crowdbot.core.ticks import TICK


class CrowdSystem(LeafSystem):
    """Input: robot state. Outputs: crowd state, generalised force on the plant."""

    def __init__(self, engine: CrowdEngine, rig: RobotPlant, perceived_radius: float) -> None:
        super().__init__()
        plant, robot = rig.plant, rig.robot
        self._engine = engine
        base = plant.GetBodyByName(robot.base, rig.model)
        self._start = base.floating_velocities_start_in_v()
        self._lever = robot.force_height - robot.base_height
        self._robot = np.array([[0.0, 0.0, 0.0, 0.0, robot.footprint_radius, perceived_radius]])
        self._port = self.DeclareVectorInputPort(ports.ROBOT_STATE, ports.ROBOT_STATE_SIZE)
        crowd = self.DeclareDiscreteState(engine.initial_state())
        force = self.DeclareDiscreteState(plant.num_velocities())
        self.DeclareStateOutputPort(ports.CROWD_STATE, crowd)
        self.DeclareStateOutputPort(ports.ROBOT_FORCE, force)
        self._crowd, self._force = DiscreteStateIndex(crowd), DiscreteStateIndex(force)
        self.DeclarePeriodicUnrestrictedUpdateEvent(TICK, 0.0, self._update)

    def _update(self, context: Context, state: State) -> None:
        x = self._port.Eval(context)
        row = self._robot[0]
        row[0], row[1], row[2], row[3] = x[0], x[1], x[3], x[4]
        values = state.get_mutable_discrete_state()
        crowd = values.get_mutable_value(self._crowd)
        self._engine.advance(crowd, self._robot)
        force = values.get_mutable_value(self._force)
        fx, fy, i = crowd[s.ROBOT_FX], crowd[s.ROBOT_FY], self._start
        force[i], force[i + 1] = -self._lever * fy, self._lever * fx
        force[i + 3], force[i + 4] = fx, fy
