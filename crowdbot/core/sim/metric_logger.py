"""MetricLogger: watches the task every tick and logs the state at the log rate.

A publish event at tick k sees the state at k, before any update of that tick.
"""

from __future__ import annotations

import math

from pydrake.common.value import Value
from pydrake.multibody.plant import ContactResults
from pydrake.systems.framework import Context, EventStatus, LeafSystem

from crowdbot.core.arrival import distance_to, entry_fraction, inside
from crowdbot.core.interfaces import Array, RobotState, Task
from crowdbot.core.run_log import RunLog
from crowdbot.core.sim import ports
from crowdbot.core.sim.leash import Leash
from crowdbot.core.sim.wall_contact import WallContacts, wall_force
from crowdbot.core.ticks import TICK, TICKS_PER_SECOND, ticks

_ROUNDING = 1e-9  # m; of the distance to the goal zone


class MetricLogger(LeafSystem):
    """Inputs: robot state, crowd state, forces. Ends the run on arrival and at the time limit."""

    def __init__(
        self,
        log: RunLog,
        task: Task,
        walls: WallContacts,
        crowd_size: int,
        rate: float,
        *,
        felt: bool,
    ) -> None:
        """``felt``: whether the robot's base is one that forces act on."""
        super().__init__()
        self._log, self._task, self._walls = log, task, walls
        self._ticks_per_sample = ticks(rate)
        self._last_tick = -1
        self._before: Array | None = None  # the robot one tick ago
        self._leash = Leash()
        self.goal_time: float | None = None
        self._robot = self.DeclareVectorInputPort(ports.ROBOT_STATE, ports.ROBOT_STATE_SIZE)
        self._crowd = self._events = None
        if crowd_size:
            self._crowd = self.DeclareVectorInputPort(ports.CROWD_STATE, crowd_size)
            self._events = self.DeclareVectorInputPort(ports.EVENTS, 1)
        # Asking an input port whether it has a value would compute the forces at every tick.
        self._forces = (
            self.DeclareAbstractInputPort(ports.FORCES, Value(ContactResults())) if felt else None
        )
        self.DeclarePeriodicPublishEvent(TICK, 0.0, self._publish)

    def _publish(self, context: Context) -> EventStatus | None:
        tick = round(context.get_time() * TICKS_PER_SECOND)
        if tick == self._last_tick:  # Initialize and the first step may both publish t = 0
            return None
        self._last_tick = tick
        t = tick * TICK
        now, before = self._robot.Eval(context), self._before
        self._before = now
        sampled = tick % self._ticks_per_sample == 0
        crowd = self._crowd_state(context, always=sampled)
        if crowd is not None:
            self._log.book(crowd)
        arrived = False
        if not self._leash.holds(now.item(0), now.item(1)):
            arrived = self._look(context, t, RobotState(*now.tolist()), before)
        if sampled:
            self._log.sample(t, RobotState(*now.tolist()), crowd)
        if arrived:
            return EventStatus.ReachedTermination(self, "arrived")
        if t >= self._task.time_limit:
            return EventStatus.ReachedTermination(self, "time limit")
        return None

    def _crowd_state(self, context: Context, *, always: bool) -> Array | None:
        """The crowd, where there is something to log: it is copied each time it is looked at."""
        if self._crowd is None or self._events is None:
            return None
        if not always and int(self._events.Eval(context)[0]) == self._log.events:
            return None
        crowd: Array = self._crowd.Eval(context)
        return crowd

    def _look(self, context: Context, t: float, robot: RobotState, before: Array | None) -> bool:
        """Watch walls and goal, one of which may be near; returns whether the robot is there."""
        was = robot if before is None else RobotState(*before.tolist())
        forces = self._forces
        felt = None if forces is None else lambda: wall_force(forces.Eval(context))
        speed = 0.0 if before is None else math.hypot(was.vx, was.vy)
        free = self._walls.watch(t, robot, speed, felt)
        zone = self._task.goal_zone
        distance = distance_to(zone, robot.x, robot.y)
        self._leash.tie(robot.x, robot.y, min(free, distance - _ROUNDING))
        if distance > 0.0 or not inside(zone, robot.x, robot.y):
            return False
        fraction = entry_fraction(zone, was.x, was.y, robot.x, robot.y) if t > 0.0 else 1.0
        self.goal_time = t - (1.0 - fraction) * TICK
        return True
