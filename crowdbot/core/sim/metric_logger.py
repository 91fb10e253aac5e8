"""MetricLogger: monitors the task every tick and logs the state at the log rate.

A publish event at tick k sees the state at k, before any update of that tick.
"""

from __future__ import annotations

import math
from collections.abc import Callable

from pydrake.common.value import Value
from pydrake.multibody.plant import ContactResults
from pydrake.systems.framework import (
    Context,
    DiagramBuilder,
    DiscreteValues,
    EventStatus,
    LeafSystem,
)

from crowdbot.core.geometry.polygon import distance_to, entry_fraction, inside
from crowdbot.core.recording.run_log import RunLog
from crowdbot.core.runs.outcome import ARRIVED, PLANNER_FAILED, TIMEOUT, TOPPLED
from crowdbot.core.sim import ports
from crowdbot.core.sim.built_run import BuiltRun
from crowdbot.core.sim.clearance_cache import ClearanceCache
from crowdbot.core.sim.control import ControlledRobot
from crowdbot.core.sim.crowd_system import CrowdSystem
from crowdbot.core.sim.fate import Fate
from crowdbot.core.sim.wall_contact import WallContacts, wall_force
from crowdbot.core.sim.weak_callback import NO_ATTRIBUTES
from crowdbot.core.support.ticks import TICK, TICKS_PER_SECOND, ticks
from crowdbot.core.types.arrays import Array
from crowdbot.core.types.ending import Ending
from crowdbot.core.types.robot import RobotState
from crowdbot.core.types.task import Task

_ROUNDING = 1e-9  # m; rounding of the distance to the goal zone
_TILT = RobotState._fields.index("tilt")
#: A robot that leans by more than this has toppled, rad.
LEANS = math.radians(60.0)


class MetricLogger(LeafSystem):
    """Inputs: robot state, crowd state, forces. Ends the run: arrived, toppled, out of time.

    Attributes:
        walls: contacts of the robot with walls.
        goal_time: time of arrival, s, or None.
        toppled_time: time of toppling, s, or None.
    """

    __slots__ = NO_ATTRIBUTES

    def __init__(
        self,
        log: RunLog,
        task: Task,
        walls: WallContacts,
        crowd: CrowdSystem | None,
        rate: float,
        *,
        felt: bool,
        fate: Fate | None = None,
        on_end: Callable[[], None] = lambda: None,
    ) -> None:
        """Monitor one robot.

        Args:
            felt: True if forces act on the robot's base.
            fate: ending of a fleet's robot, which does not end the run.
            on_end: callback at its end.
        """
        super().__init__()
        self._log, self._task, self.walls = log, task, walls
        self._ticks_per_sample = ticks(rate)
        self._last_tick = -1
        self._before: Array | None = None  # the robot's state one tick ago
        self._clearance = ClearanceCache()
        self.goal_time: float | None = None
        self.toppled_time: float | None = None
        self._fate, self._on_end = fate, on_end
        self._robot = self.DeclareVectorInputPort(ports.ROBOT_STATE, ports.ROBOT_STATE_SIZE)
        self._crowd = self._events = None
        if crowd is not None:
            self._crowd = self.DeclareVectorInputPort(ports.CROWD_STATE, crowd.state.size())
            self._events = self.DeclareVectorInputPort(ports.EVENTS, crowd.events.size())
        # Checking whether an input port has a value would compute the forces at every tick.
        self._forces = (
            self.DeclareAbstractInputPort(ports.FORCES, Value(ContactResults())) if felt else None
        )
        self.DeclarePeriodicPublishEvent(TICK, 0.0, self._publish)
        if felt:
            self.DeclarePeriodicDiscreteUpdateEvent(TICK, 0.0, self._feel)

    def _publish(self, context: Context) -> EventStatus | None:
        tick = round(context.get_time() * TICKS_PER_SECOND)
        if tick == self._last_tick:  # Initialize and the first step may both publish t = 0
            return None
        self._last_tick = tick
        if self._fate is not None and self._fate.ended:
            return None
        t = tick * TICK
        now, before = self._robot.Eval(context), self._before
        self._before = now
        if self.toppled_time is None and now.item(_TILT) > LEANS:
            self.toppled_time = t
        sampled = tick % self._ticks_per_sample == 0
        crowd = self._crowd_state(context, always=sampled)
        if crowd is not None:
            self._log.record_events(crowd)
        arrived = False
        if not self._clearance.is_clear(now.item(0), now.item(1)):
            arrived = self._look(t, RobotState(*now.tolist()), before)
        if sampled:
            self._log.sample(t, RobotState(*now.tolist()), crowd)
        if arrived:
            return self._end(context, t, ARRIVED, "centre inside the goal zone")
        if self._fate is not None and self._fate.failure:
            return self._end(context, t, PLANNER_FAILED, self._fate.failure)
        if self.toppled_time is not None or t >= self._task.time_limit:
            return self._end(context, t, *self.fate_without_arrival())
        return None

    def _feel(self, context: Context, _values: DiscreteValues | None = None) -> None:
        """Read the walls' forces during the plant's step, which needs them too.

        Read in ``_publish``, they would be computed again, since the people's update invalidates
        Drake's cache.
        """
        if self._forces is not None and self.walls.near:
            self.walls.feel(wall_force(self._forces.Eval(context)))

    def fate_without_arrival(self) -> tuple[Ending, str]:
        """Return status and reason of a robot that has not arrived, if its planner did not fail."""
        if self.toppled_time is not None:
            return TOPPLED, f"toppled at {self.toppled_time:.1f} s"
        return TIMEOUT, f"time limit of {self._task.time_limit:g} s"

    def _end(self, context: Context, t: float, status: str, reason: str) -> EventStatus | None:
        """End the robot, and the run unless it is a fleet's."""
        self._feel(context)  # there is no further step
        if self._fate is None:
            return EventStatus.ReachedTermination(self, reason)
        self._fate.end(status, reason, t, self.goal_time, self.toppled_time)
        self.finish(context, t)
        return None

    def finish(self, context: Context, t: float) -> None:
        """Record active contacts at the end; ``context`` is this system's own."""
        self.walls.finish()
        self._log.finish(t, None if self._crowd is None else self._crowd.Eval(context))
        self._on_end()

    def _crowd_state(self, context: Context, *, always: bool) -> Array | None:
        """Return the crowd if there is something to log, since every access copies it."""
        if self._crowd is None or self._events is None:
            return None
        if not always and self._log.has_recorded(self._events.Eval(context)):
            return None
        crowd: Array = self._crowd.Eval(context)
        return crowd

    def _look(self, t: float, robot: RobotState, before: Array | None) -> bool:
        """Check near walls and the goal; return True if the robot has arrived."""
        was = robot if before is None else RobotState(*before.tolist())
        speed = 0.0 if before is None else math.hypot(was.vx, was.vy)
        free = self.walls.watch(t, robot, speed)
        if self._forces is None:
            self.walls.feel(None)
        zone = self._task.goal_zone
        distance = distance_to(zone, robot.x, robot.y)
        self._clearance.reset(robot.x, robot.y, min(free, distance - _ROUNDING))
        if self.toppled_time is not None or distance > 0.0 or not inside(zone, robot.x, robot.y):
            return False
        fraction = entry_fraction(zone, was.x, was.y, robot.x, robot.y) if t > 0.0 else 1.0
        self.goal_time = t - (1.0 - fraction) * TICK
        return True


def add_metric_logger(
    builder: DiagramBuilder,
    built: BuiltRun,
    robot: ControlledRobot,
    crowd: CrowdSystem | None,
    log: RunLog,
    fate: Fate | None = None,
    on_end: Callable[[], None] = lambda: None,
) -> MetricLogger:
    """Add the task monitor and sampler to a diagram."""
    logger = MetricLogger(
        log,
        built.task,
        WallContacts(built.parts, built.model, log),
        crowd,
        built.scenario.rates.log,
        felt=robot.rig is not None,
        fate=fate,
        on_end=on_end,
    )
    builder.AddNamedSystem("metric_logger", logger)
    builder.Connect(robot.port, logger.GetInputPort(ports.ROBOT_STATE))
    if robot.rig is not None:
        forces = robot.rig.plant.get_contact_results_output_port()
        builder.Connect(forces, logger.GetInputPort(ports.FORCES))
    if crowd is not None:
        builder.Connect(crowd.state, logger.GetInputPort(ports.CROWD_STATE))
        builder.Connect(crowd.events, logger.GetInputPort(ports.EVENTS))
    return logger
