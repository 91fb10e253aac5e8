"""CrowdSystem: the crowd and its contact with the robot, advanced in one event.

The event is unrestricted, so it runs before the plant's discrete update: the force on the robot
and the reaction on people come from one computation on one state, and balance exactly
(docs/decisions/0004).
"""

from __future__ import annotations

from typing import Protocol

from pydrake.systems.framework import (
    Context,
    DiagramBuilder,
    DiscreteStateIndex,
    LeafSystem,
    OutputPort,
    State,
)

from crowdbot.core.crowd import CrowdEngine
from crowdbot.core.crowd import state as s
from crowdbot.core.geometry.footprint import footprint_of_model
from crowdbot.core.sim import ports
from crowdbot.core.sim.bodies import SEEN, rows_of
from crowdbot.core.sim.built_run import BuiltRun
from crowdbot.core.sim.control import ControlledRobot
from crowdbot.core.sim.control.controlled import Push
from crowdbot.core.sim.weak_callback import NO_ATTRIBUTES
from crowdbot.core.support.ticks import TICK
from crowdbot.core.types.robot import RobotModel

#: What of the crowd's header others are told: force, events, torque.
_NEWS = slice(s.ROBOT_FX, s.ROBOT_TORQUE + 1)


class CrowdOutputs(Protocol):
    """The people as one robot takes them."""

    @property
    def engine(self) -> CrowdEngine:
        """Who they are."""

    @property
    def state(self) -> OutputPort:
        """Their flat state."""

    @property
    def events(self) -> OutputPort:
        """How many of their trips, and of their contacts with the robot, have ended."""


class CrowdSystem(LeafSystem):
    """Input: robot state. Outputs: crowd state, events, force on the robot.

    Attributes:
        engine: the people.
    """

    __slots__ = NO_ATTRIBUTES

    def __init__(
        self,
        engine: CrowdEngine,
        push: Push,
        robot: RobotModel,
        margin: float,
        tick: float = TICK,
    ) -> None:
        """``margin``: how much larger than its body people take the robot for, m."""
        super().__init__()
        self._tick = tick
        self.engine, self._push = engine, push
        self._outline = footprint_of_model(robot).corners
        self._robot = rows_of([robot], margin)
        self._row = self._robot[0]
        self._port = self.DeclareVectorInputPort(ports.ROBOT_STATE, ports.ROBOT_STATE_SIZE)
        crowd = self.DeclareDiscreteState(engine.initial_state())
        force = self.DeclareDiscreteState(push.size)
        events = self.DeclareDiscreteState(1)
        self.DeclareStateOutputPort(ports.CROWD_STATE, crowd)
        self.DeclareStateOutputPort(ports.EVENTS, events)
        self.DeclareStateOutputPort(ports.ROBOT_FORCE, force)
        self._crowd, self._force = DiscreteStateIndex(crowd), DiscreteStateIndex(force)
        self._events = DiscreteStateIndex(events)
        self.DeclarePeriodicUnrestrictedUpdateEvent(tick, 0.0, self._update)

    def _update(self, context: Context, state: State) -> None:
        self._row[SEEN] = self._port.Eval(context)[:6]
        values = state.get_mutable_discrete_state()
        crowd = values.get_mutable_value(self._crowd)
        before = crowd[_NEWS].tolist()
        self.engine.advance(crowd, self._robot, self._outline, self._tick)
        news = crowd[_NEWS].tolist()
        if news == before:  # at most ticks: nobody touches the robot and nothing ends
            return
        fx, fy, contacts, trips, torque = news
        self._push.write(values.get_mutable_value(self._force), fx, fy, torque)
        values.get_mutable_value(self._events)[0] = contacts + trips

    @property
    def events(self) -> OutputPort:
        """How many trips and contacts have ended."""
        return self.GetOutputPort(ports.EVENTS)

    @property
    def state(self) -> OutputPort:
        """The crowd's flat state."""
        return self.GetOutputPort(ports.CROWD_STATE)


def add_crowd(
    builder: DiagramBuilder,
    built: BuiltRun,
    robot: ControlledRobot,
    engine: CrowdEngine | None,
    tick: float,
) -> CrowdSystem | None:
    """Add the people, if there are any, to a diagram; they and the robot push each other."""
    if engine is None:
        return None
    spec = built.scenario.crowd
    margin = spec.robot_response.margin if spec else 0.0
    crowd = CrowdSystem(engine, robot.push, built.model, margin, tick)
    builder.AddNamedSystem("crowd", crowd)
    builder.Connect(robot.port, crowd.GetInputPort(ports.ROBOT_STATE))
    if robot.push_port is not None:
        builder.Connect(crowd.GetOutputPort(ports.ROBOT_FORCE), robot.push_port)
    return crowd
