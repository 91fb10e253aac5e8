"""RobotContacts: contact forces between robots, equal and opposite.

The force is that between people and robots (`crowdbot.core.crowd.contact.robot_contact`): Hunt and
Crossley's along the normal, without friction, never pulling. The default stiffness of shells is
that of a person's body (30 kN/m, proposed, not published), in series with both skins; a stiffer
contact needs shorter ticks. Kinematic robots push but are not pushed.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from itertools import combinations

import numpy as np
from pydrake.systems.framework import (
    BasicVector,
    Context,
    DiagramBuilder,
    DiscreteStateIndex,
    OutputPort,
    State,
)

from crowdbot.core.crowd.contact.robot_contact import (
    R_BODY,
    R_W,
    R_YAW,
    RELEASE_GAP,
    RVX,
    RVY,
    RX,
    RY,
    corners_of,
    extent_of,
)
from crowdbot.core.recording.run_log import RunLog
from crowdbot.core.sim import ports
from crowdbot.core.sim.block import Block
from crowdbot.core.sim.build_crowd import in_series
from crowdbot.core.sim.built_run import BuiltRun
from crowdbot.core.sim.contacts.bodies import SEEN, outlines_of, rows_of
from crowdbot.core.sim.contacts.outline_overlap import mark_within_reach, overlap_of_robots
from crowdbot.core.sim.control import ControlledRobot
from crowdbot.core.sim.robot_ending import RobotEnding
from crowdbot.core.sim.weak_callback import NO_ATTRIBUTES, weak_callback
from crowdbot.core.support.ticks import TICK
from crowdbot.core.types.arrays import Array
from crowdbot.core.types.robot import RobotModel

#: Stiffness of two rigid shells in contact, N/m, and their dissipation, s/m.
SHELL, DISSIPATION = 30000.0, 0.3
#: Number of robot k in a table of contacts: this minus k; -1 is a wall.
FIRST_ROBOT = -2


@dataclass(slots=True)
class _Touch:
    """An active contact; its bearings are those at its start, for each robot."""

    start: float
    end: float
    speed: float
    bearings: tuple[float, float]
    impulse: float = 0.0
    peak: float = 0.0


@dataclass(frozen=True, slots=True)
class RobotContactForces:
    """Contact forces of one tick between two robots.

    Attributes:
        depth: overlap, m.
        at: position, world frame, m.
        normal: away from the first robot.
        force: N.
        speed: relative, m/s.
    """

    depth: float
    at: tuple[float, float]
    normal: tuple[float, float]
    force: float
    speed: float


def touch(
    a: Array, outline_a: Array, b: Array, outline_b: Array, stiffness: float
) -> RobotContactForces | None:
    """Return the contact of two robots (rows and outlines as in `robot_contact`), or None."""
    depth, nx, ny, x, y = overlap_of_robots(a, outline_a, b, outline_b)
    if depth <= 0.0:
        return None
    vx, vy = (_velocity_at(b, x, y)[i] - _velocity_at(a, x, y)[i] for i in (0, 1))
    closing = -(vx * nx + vy * ny)
    force = max(0.0, stiffness * depth * (1.0 + DISSIPATION * closing))
    return RobotContactForces(depth, (x, y), (nx, ny), force, math.hypot(vx, vy))


def _velocity_at(row: Array, x: float, y: float) -> tuple[float, float]:
    return row[RVX] - row[R_W] * (y - row[RY]), row[RVY] + row[R_W] * (x - row[RX])


class RobotContacts(Block):
    """Inputs: states of all robots. Outputs: of each, force x, y and torque (`ports.ROBOT_PUSH`).

    The event is unrestricted, like the crowd's: both robots of a pair use one computation.
    """

    __slots__ = NO_ATTRIBUTES

    def __init__(
        self, models: Sequence[RobotModel], endings: Sequence[RobotEnding], logs: Sequence[RunLog]
    ) -> None:
        super().__init__()
        self._rows, self._endings, self._logs = rows_of(models), tuple(endings), tuple(logs)
        outlines = outlines_of(models)
        self._outlines = [outlines[k][: corners_of(outlines, k)] for k in range(len(models))]
        self._near = np.zeros((len(models), len(models)), dtype=np.bool_)
        self._reach = np.array([extent_of(o) for o in self._outlines]) + self._rows[:, R_BODY]
        self._stiffness = {
            (i, j): in_series(in_series(SHELL, models[i].skin_stiffness), models[j].skin_stiffness)
            for i, j in combinations(range(len(models)), 2)
        }
        self._going_on: dict[tuple[int, int], _Touch] = {}
        count = len(models)
        self._ports = [self.DeclareVectorInputPort(*ports.other_robot(k)) for k in range(count)]
        index = self.DeclareDiscreteState(count * ports.ROBOT_PUSH_SIZE)
        self._index, self._tick = DiscreteStateIndex(index), 0
        for k in range(count):
            self.DeclareVectorOutputPort(
                ports.of_robot(ports.ROBOT_PUSH, k),
                ports.ROBOT_PUSH_SIZE,
                partial(weak_callback(self._share), k),
                prerequisites_of_calc={self.all_state_ticket()},
            )
        self.DeclarePeriodicUnrestrictedUpdateEvent(TICK, 0.0, self._update)

    def on(self, k: int) -> OutputPort:
        """Return the port of the force on robot k."""
        return self.GetOutputPort(ports.of_robot(ports.ROBOT_PUSH, k))

    def _share(self, k: int, context: Context, output: BasicVector) -> None:
        forces: Array = context.get_discrete_state(self._index).value()
        output.get_mutable_value()[:] = forces.reshape(-1, ports.ROBOT_PUSH_SIZE)[k]

    def _update(self, context: Context, state: State) -> None:
        t = float(context.get_time())
        for row, port in zip(self._rows, self._ports, strict=True):
            row[SEEN] = port.Eval(context)[:6]
        flat = state.get_mutable_discrete_state().get_mutable_value(self._index)
        forces = flat.reshape(-1, ports.ROBOT_PUSH_SIZE)
        forces[:] = 0.0
        for i, j in self._candidates():
            if self._endings[i].gone or self._endings[j].gone:
                continue
            found = self._touch(i, j)
            self._keep(i, j, found, t)
            if found is not None:
                self._add(forces, i, j, found)

    def _candidates(self) -> list[tuple[int, int]]:
        """Return pairs that may touch, or were in contact, in the order of all pairs."""
        if mark_within_reach(self._rows, self._reach, self._near) == 0 and not self._going_on:
            return []
        near = zip(*np.nonzero(self._near), strict=True)
        return sorted({*((int(i), int(j)) for i, j in near), *self._going_on})

    def _touch(self, i: int, j: int) -> RobotContactForces | None:
        of = self._outlines
        return touch(self._rows[i], of[i], self._rows[j], of[j], self._stiffness[i, j])

    def _add(self, forces: Array, i: int, j: int, found: RobotContactForces) -> None:
        """Add equal and opposite forces at one point."""
        (x, y), (nx, ny) = found.at, found.normal
        fx, fy = found.force * nx, found.force * ny
        for k, sign in ((i, -1.0), (j, 1.0)):
            px, py = x - self._rows[k, RX], y - self._rows[k, RY]
            forces[k] += sign * np.array([fx, fy, px * fy - py * fx])

    def _keep(self, i: int, j: int, forces: RobotContactForces | None, t: float) -> None:
        """Record this pair's contact."""
        going_on = self._going_on.get((i, j))
        if forces is None:
            if going_on is not None and self._gap_exceeds(i, j):
                self._finish(i, j)
            return
        if going_on is None:
            sides = self._bearing(i, forces.at), self._bearing(j, forces.at)
            going_on = self._going_on[i, j] = _Touch(t, t, forces.speed, sides)
        going_on.end = t
        going_on.impulse += forces.force * TICK
        going_on.peak = max(going_on.peak, forces.force)

    def _bearing(self, k: int, at: tuple[float, float]) -> float:
        row = self._rows[k]
        side = math.atan2(at[1] - row[RY], at[0] - row[RX]) - row[R_YAW]
        return math.remainder(side, 2.0 * math.pi)

    def _gap_exceeds(self, i: int, j: int) -> bool:
        grown = self._rows[i].copy()
        grown[4] += RELEASE_GAP
        depth = overlap_of_robots(grown, self._outlines[i], self._rows[j], self._outlines[j])[0]
        return bool(depth <= 0.0)

    def finish(self, k: int) -> None:
        """End all ongoing contacts of robot k."""
        for i, j in list(self._going_on):
            if k in (i, j):
                self._finish(i, j)

    def _finish(self, i: int, j: int) -> None:
        c = self._going_on.pop((i, j))
        for mine, other in ((i, j), (j, i)):
            if self._endings[mine].ended and self._endings[mine].until < c.start:
                continue
            self._logs[mine].writer.contact(
                t0=c.start, t1=c.end, agent=FIRST_ROBOT - other, impulse=c.impulse,
                peak_force=c.peak, relative_speed=c.speed,
                bearing=c.bearings[mine == j],
            )  # fmt: skip


def add_robot_contacts(
    builder: DiagramBuilder,
    builts: Sequence[BuiltRun],
    robots: Sequence[ControlledRobot],
    endings: Sequence[RobotEnding],
    logs: Sequence[RunLog],
) -> RobotContacts | None:
    """Add the contacts of several robots with each other; pushes are connected elsewhere."""
    if len(robots) < 2:
        return None
    contacts = RobotContacts([built.model for built in builts], endings, logs)
    builder.AddNamedSystem("robot_contacts", contacts)
    for k, robot in enumerate(robots):
        builder.Connect(robot.port, contacts.GetInputPort(ports.other_robot(k)[0]))
    return contacts
