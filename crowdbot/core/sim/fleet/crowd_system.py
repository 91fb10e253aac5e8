"""FleetCrowdSystem: people, and their contacts with several robots, advanced in one event.

As `crowdbot.core.sim.crowd_system`, which it is for one robot. Each robot has a view of the crowd
in which it is the one that is touched: whatever reads that vector need not know of the others.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np
from pydrake.systems.framework import (
    BasicVector,
    Context,
    DiagramBuilder,
    DiscreteStateIndex,
    LeafSystem,
    OutputPort,
    State,
)

from crowdbot.core.crowd import CrowdEngine
from crowdbot.core.crowd import state as s
from crowdbot.core.crowd.contact.robot_contact import FELT, TOUCH
from crowdbot.core.sim import ports
from crowdbot.core.sim.bodies import SEEN, outlines_of, rows_of
from crowdbot.core.sim.build_crowd import in_series
from crowdbot.core.sim.built_run import BuiltRun
from crowdbot.core.sim.control import ControlledRobot
from crowdbot.core.sim.fate import Fate
from crowdbot.core.sim.weak_callback import NO_ATTRIBUTES, weak_callback
from crowdbot.core.support.ticks import TICK
from crowdbot.core.types.arrays import Array

_FX, _FY, _CONTACTS, _TORQUE = (
    FELT.tolist().index(entry) for entry in (s.ROBOT_FX, s.ROBOT_FY, s.CONTACTS, s.ROBOT_TORQUE)
)


@dataclass(frozen=True, slots=True)
class RobotsCrowd:
    """The crowd as one robot takes it: `crowdbot.core.sim.crowd_system.CrowdOutputs`."""

    engine: CrowdEngine
    state: OutputPort
    events: OutputPort


class FleetCrowdSystem(LeafSystem):
    """Inputs: states of all robots. Outputs: crowd state; for each robot state, events, force.

    Attributes:
        engine: the people.
    """

    __slots__ = NO_ATTRIBUTES

    def __init__(
        self,
        engine: CrowdEngine,
        builts: Sequence[BuiltRun],
        robots: Sequence[ControlledRobot],
        fates: Sequence[Fate],
    ) -> None:
        super().__init__()
        self.engine, self._fates = engine, tuple(fates)
        self._pushes = [robot.push for robot in robots]
        scenario, models = builts[0].scenario, [built.model for built in builts]
        margin = scenario.crowd.robot_response.margin if scenario.crowd else 0.0
        self._rows, self._outlines = rows_of(models, margin), outlines_of(models)
        self._stiffness = np.array(
            [in_series(scenario.contact.stiffness, model.skin_stiffness) for model in models]
        )
        count, books = len(models), engine.initial_books(len(models))
        self._ports = [self.DeclareVectorInputPort(*ports.other_robot(k)) for k in range(count)]
        crowd = self.DeclareDiscreteState(engine.initial_state())
        self._books_shape = books.shape
        book = self.DeclareDiscreteState(books.ravel())
        self.DeclareStateOutputPort(ports.CROWD_STATE, crowd)
        self._crowd, self._books = DiscreteStateIndex(crowd), DiscreteStateIndex(book)
        known = {"prerequisites_of_calc": {self.all_state_ticket()}}
        self.DeclareVectorOutputPort(ports.EVENTS, 1, weak_callback(self._trips), **known)
        for k, push in enumerate(self._pushes):
            for port, size, calc in (
                (ports.CROWD_STATE, s.size(len(engine.agents)), self._seen),
                (ports.EVENTS, 1, self._count),
                (ports.ROBOT_FORCE, push.size, self._push),
            ):
                self.DeclareVectorOutputPort(
                    ports.of_robot(port, k), size, partial(weak_callback(calc), k), **known
                )
        self.DeclarePeriodicUnrestrictedUpdateEvent(TICK, 0.0, self._update)

    def _update(self, context: Context, state: State) -> None:
        for row, port in zip(self._rows, self._ports, strict=True):
            row[SEEN] = port.Eval(context)[:6]
        here = [not fate.gone for fate in self._fates]
        values = state.get_mutable_discrete_state()
        books = values.get_mutable_value(self._books).reshape(self._books_shape)
        felt = books[here]
        self.engine.advance(
            values.get_mutable_value(self._crowd), self._rows[here], self._outlines[here],
            books=felt, stiffnesses=self._stiffness[here],
        )  # fmt: skip
        books[here] = felt
        books[np.logical_not(here), _FX] = books[np.logical_not(here), _FY] = 0.0
        books[np.logical_not(here), _TORQUE] = 0.0

    def _book(self, context: Context, k: int) -> Array:
        books: Array = context.get_discrete_state(self._books).value()
        book: Array = books.reshape(self._books_shape)[k]
        return book

    def _seen(self, k: int, context: Context, output: BasicVector) -> None:
        book, flat = self._book(context, k), output.get_mutable_value()
        flat[:] = context.get_discrete_state(self._crowd).value()
        header, people = s.view(flat)
        header[FELT] = book[: len(FELT)]
        people[:, TOUCH] = book[len(FELT) :].reshape(-1, len(TOUCH))

    def _count(self, k: int, context: Context, output: BasicVector) -> None:
        output.get_mutable_value()[0] = self._book(context, k)[_CONTACTS]

    def _push(self, k: int, context: Context, output: BasicVector) -> None:
        book, values = self._book(context, k), output.get_mutable_value()
        values[:] = 0.0
        self._pushes[k].write(values, book[_FX], book[_FY], book[_TORQUE])

    def _trips(self, context: Context, output: BasicVector) -> None:
        flat = context.get_discrete_state(self._crowd).value()
        output.get_mutable_value()[0] = flat[s.TRIPS]

    @property
    def state(self) -> OutputPort:
        """The crowd's flat state, which tells nothing of contacts with robots."""
        return self.GetOutputPort(ports.CROWD_STATE)

    @property
    def events(self) -> OutputPort:
        """How many trips have ended."""
        return self.GetOutputPort(ports.EVENTS)

    def view(self, k: int) -> RobotsCrowd:
        """The crowd as robot k takes it."""
        names = (ports.of_robot(name, k) for name in (ports.CROWD_STATE, ports.EVENTS))
        return RobotsCrowd(self.engine, *map(self.GetOutputPort, names))


def add_fleet_crowd(
    builder: DiagramBuilder,
    engine: CrowdEngine | None,
    builts: Sequence[BuiltRun],
    robots: Sequence[ControlledRobot],
    fates: Sequence[Fate],
) -> FleetCrowdSystem | None:
    """Add the people, if there are any, to a diagram; their pushes are connected elsewhere."""
    if engine is None:
        return None
    crowd = FleetCrowdSystem(engine, builts, robots, fates)
    builder.AddNamedSystem("crowd", crowd)
    for k, robot in enumerate(robots):
        builder.Connect(robot.port, crowd.GetInputPort(ports.other_robot(k)[0]))
    return crowd
