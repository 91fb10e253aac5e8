"""CrowdSystem: people and their contacts with all robots, advanced in one event.

The event is unrestricted, so it runs before the plant's discrete update: the force on a robot
and the reaction on people come from one computation on one state, and balance exactly
(docs/decisions/0004).
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from pydrake.systems.framework import (
    BasicVector,
    Context,
    DiagramBuilder,
    DiscreteStateIndex,
    OutputPort,
    State,
)

from crowdbot.core.assistance.led import LedPeople
from crowdbot.core.crowd import CrowdEngine
from crowdbot.core.crowd import state as s
from crowdbot.core.sim import ports
from crowdbot.core.sim.block import Block
from crowdbot.core.sim.build_crowd import in_series
from crowdbot.core.sim.built_run import BuiltRun
from crowdbot.core.sim.contacts.bodies import SEEN, outlines_of, rows_of
from crowdbot.core.sim.control import ControlledRobot
from crowdbot.core.sim.control.controlled import Push
from crowdbot.core.sim.foresight import Foresight
from crowdbot.core.sim.person_targets import led_in
from crowdbot.core.sim.robot_ending import RobotEnding
from crowdbot.core.sim.weak_callback import NO_ATTRIBUTES, weak_callback
from crowdbot.core.support.ticks import TICK
from crowdbot.core.types.arrays import Array
from crowdbot.core.types.robot import RobotModel

#: Contact output for other blocks, per robot: force x and y, torque, number of contacts.
_NEWS = (s.ROBOT_FX, s.ROBOT_FY, s.ROBOT_TORQUE, s.CONTACTS)


class CrowdSystem(Block):
    """Inputs: states of all robots. Outputs: crowd state, events, force on each robot.

    Attributes:
        engine: the people.
    """

    __slots__ = NO_ATTRIBUTES

    def __init__(
        self,
        engine: CrowdEngine,
        models: Sequence[RobotModel],
        pushes: Sequence[Push],
        endings: Sequence[RobotEnding],
        margin: float,
        tick: float = TICK,
        led: Sequence[LedPeople] = (),
    ) -> None:
        """Connect people and robots.

        Args:
            pushes: how the force on each robot is written.
            endings: which robots have left.
            margin: how much larger than its body people take a robot for, m.
            tick: s.
            led: people who follow robots.
        """
        super().__init__()
        self.engine, self._pushes, self._endings = engine, tuple(pushes), tuple(endings)
        self._tick, count, self._led = tick, len(models), tuple(led)
        self._rows, self._outlines = rows_of(models, margin), outlines_of(models)
        body = engine.world.stiffness
        self._stiffnesses = np.array([in_series(body, model.skin_stiffness) for model in models])
        self._here = np.arange(count)
        self._ports = [
            self.DeclareVectorInputPort(
                ports.of_robot(ports.ROBOT_STATE, k), ports.ROBOT_STATE_SIZE
            )
            for k in range(count)
        ]
        initial = engine.initial_state(count)
        news = [s.TRIPS, *(s.felt_at(initial, k, e) for k in range(count) for e in _NEWS)]
        self._news = tuple(news)
        self._leaving = [k for k in range(count) if self._endings[k].leaves]
        crowd, events = self.DeclareDiscreteState(initial), self.DeclareDiscreteState(1 + count)
        self._crowd, self._events = DiscreteStateIndex(crowd), DiscreteStateIndex(events)
        # Drake copies a state to its port number by number, which takes 23 µs for 200 people.
        self.DeclareVectorOutputPort(
            ports.CROWD_STATE, len(initial), weak_callback(self._show),
            prerequisites_of_calc={self.discrete_state_ticket(self._crowd)},
        )  # fmt: skip
        self.DeclareStateOutputPort(ports.EVENTS, events)
        self._forces = [self._declare_force(k, push.size) for k, push in enumerate(pushes)]
        self.DeclarePeriodicUnrestrictedUpdateEvent(tick, 0.0, self._update)

    def _declare_force(self, k: int, size: int) -> DiscreteStateIndex:
        force = self.DeclareDiscreteState(size)
        self.DeclareStateOutputPort(ports.of_robot(ports.ROBOT_FORCE, k), force)
        return DiscreteStateIndex(force)

    def _show(self, context: Context, output: BasicVector) -> None:
        output.get_mutable_value()[:] = context.get_discrete_state(self._crowd).value()

    def _update(self, context: Context, state: State) -> None:
        for row, port in zip(self._rows, self._ports, strict=True):
            row[SEEN] = port.Eval(context)[:6]
        values = state.get_mutable_discrete_state()
        crowd = values.get_mutable_value(self._crowd)
        before = [*map(crowd.item, self._news)]
        if self._leaving:
            self._take_out(crowd)
        if self._led and int(crowd[s.TICK]) % self.engine.ticks_per_decision == 0:
            for people in self._led:
                people.set_goals(crowd, *self._rows[people.robot][:2].tolist())
        self._advance(crowd)
        news = [*map(crowd.item, self._news)]
        if news == before:  # at most ticks: nothing touches a robot and nothing ends
            return
        events = values.get_mutable_value(self._events)
        events[0] = news[0]
        for k, push in enumerate(self._pushes):
            fx, fy, torque, events[1 + k] = news[1 + 4 * k : 5 + 4 * k]
            push.write(values.get_mutable_value(self._forces[k]), fx, fy, torque)

    def _take_out(self, crowd: Array) -> None:
        """Stop forces on robots that have left since the last tick."""
        for k in [k for k in self._leaving if self._endings[k].gone]:
            felt, _ = s.contact_with(crowd, k)
            felt[[s.ROBOT_FX, s.ROBOT_FY, s.ROBOT_TORQUE]] = 0.0
            self._here = self._here[self._here != k]
            self._leaving.remove(k)

    def _advance(self, crowd: Array) -> None:
        here, all_here = self._here, len(self._here) == len(self._rows)
        self.engine.advance(
            crowd,
            self._rows if all_here else self._rows[here],
            self._outlines if all_here else self._outlines[here],
            self._tick,
            numbers=here,
            stiffnesses=self._stiffnesses if all_here else self._stiffnesses[here],
        )

    @property
    def foresight(self) -> Foresight | None:
        """Return the predictor of people; None if they depend on more than the crowd's state."""
        foreign = any(group.foreign for group in self.engine.groups)
        if len(self._rows) != 1 or self._led or foreign:
            return None
        return Foresight(self.engine, self._rows[0], self._outlines, float(self._stiffnesses[0]))

    @property
    def events(self) -> OutputPort:
        """Return the port of the numbers of ended trips, and of ended contacts with each robot."""
        return self.GetOutputPort(ports.EVENTS)

    @property
    def state(self) -> OutputPort:
        """Return the port of the crowd's flat state."""
        return self.GetOutputPort(ports.CROWD_STATE)

    def force_on(self, k: int) -> OutputPort:
        """Return the port of people's force on robot k, in its control mode's layout."""
        return self.GetOutputPort(ports.of_robot(ports.ROBOT_FORCE, k))


def add_crowd(
    builder: DiagramBuilder,
    builts: Sequence[BuiltRun],
    robots: Sequence[ControlledRobot],
    engine: CrowdEngine | None,
    endings: Sequence[RobotEnding],
    tick: float = TICK,
) -> CrowdSystem | None:
    """Add the people, if there are any, to a diagram; their forces are connected elsewhere."""
    if engine is None:
        return None
    spec, models = builts[0].scenario.crowd, [built.model for built in builts]
    margin = spec.robot_response.margin if spec else 0.0
    pushes = [robot.push for robot in robots]
    crowd = CrowdSystem(engine, models, pushes, endings, margin, tick, led_in(builts))
    builder.AddNamedSystem("crowd", crowd)
    for k, robot in enumerate(robots):
        builder.Connect(robot.port, crowd.GetInputPort(ports.of_robot(ports.ROBOT_STATE, k)))
    return crowd
