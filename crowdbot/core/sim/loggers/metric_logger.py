"""MetricLogger: monitors the task every tick and logs the state at the log rate.

A publish event at tick k sees the state at k, before any update of that tick.
"""

from __future__ import annotations

import math

from pydrake.common.value import Value
from pydrake.multibody.plant import ContactResults
from pydrake.systems.framework import (
    Context,
    DiagramBuilder,
    DiscreteValues,
    EventStatus,
)

from crowdbot.core.assistance.watch import PersonWatch
from crowdbot.core.geometry.polygon import distance_to, entry_fraction, inside
from crowdbot.core.recording.run_log import RunLog
from crowdbot.core.sim import ports
from crowdbot.core.sim.block import Block
from crowdbot.core.sim.built_run import BuiltRun
from crowdbot.core.sim.contacts.clearance_cache import ClearanceCache
from crowdbot.core.sim.contacts.wall_contact import WallContacts, wall_force
from crowdbot.core.sim.control import ControlledRobot
from crowdbot.core.sim.crowd_system import CrowdSystem
from crowdbot.core.sim.other_robots import OtherRobots
from crowdbot.core.sim.person_targets import watch_of
from crowdbot.core.sim.weak_callback import NO_ATTRIBUTES
from crowdbot.core.support.ticks import TICK, TICKS_PER_SECOND, ticks
from crowdbot.core.types.arrays import Array
from crowdbot.core.types.ending import Ending
from crowdbot.core.types.robot import RobotState

_ROUNDING = 1e-9  # m; rounding of the distance to the goal zone
_TILT, _VX, _VY = (RobotState._fields.index(name) for name in ("tilt", "vx", "vy"))
#: A robot that leans by more than this has toppled, rad.
LEANS = math.radians(60.0)


class MetricLogger(Block):
    """Inputs: robot state, crowd state, forces. Ends its robot: arrived, toppled, out of time.

    With the last robot of a run the run ends.

    Attributes:
        walls: contacts of the robot with walls.
    """

    __slots__ = NO_ATTRIBUTES

    def __init__(
        self,
        log: RunLog,
        built: BuiltRun,
        walls: WallContacts,
        crowd: CrowdSystem | None,
        *,
        felt: bool,
        others: OtherRobots,
    ) -> None:
        """Monitor one robot.

        Args:
            built: the robot with its task: a zone to reach, or a person with what to do.
            crowd: the people, if there are any.
            felt: True if the robot's base is one that forces act on.
            others: the other robots, and the ending of this one.
        """
        super().__init__()
        self._log, self._task, self.walls, self._person = log, built.task, walls, watch_of(built)
        self._ticks_per_sample = ticks(built.scenario.rates.log)
        self._last_tick = -1
        self._before: Array | None = None  # the robot's state one tick ago
        self._clearance = ClearanceCache()
        self._ending, self._others, self._finished = others.ending, others, False
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
        ending = self._ending
        if ending.ended:
            return None
        t = tick * TICK
        now, before = self._robot.Eval(context), self._before
        self._before = now
        if ending.toppled_time is None and now.item(_TILT) > LEANS:
            ending.toppled_time = t
        sampled = tick % self._ticks_per_sample == 0
        crowd = self._crowd_state(context, always=sampled)
        if crowd is not None:
            self._log.record_events(crowd)
        arrived = False
        if not self._clearance.is_clear(now.item(0), now.item(1)):
            arrived = self._look(t, RobotState(*now.tolist()), before)
        if sampled:
            self._log.sample(t, RobotState(*now.tolist()), crowd)
            if self._person is not None and crowd is not None:
                arrived = self._is_done(self._person, t, RobotState(*now.tolist()), crowd)
        ended = self._ended(t, arrived=arrived)
        return None if ended is None else self._end(context, t, *ended)

    def _ended(self, t: float, *, arrived: bool) -> tuple[Ending, str] | None:
        """Return how the robot has ended, and the reason: the first rule that applies."""
        ending = self._ending
        if arrived:
            reason = "centre inside the goal zone" if self._person is None else "task done"
            return Ending.ARRIVED, reason
        if ending.failure:
            return Ending.PLANNER_FAILED, ending.failure
        if ending.toppled_time is not None:
            return Ending.TOPPLED, f"toppled at {ending.toppled_time:.1f} s"
        if t >= self._task.time_limit:
            return Ending.TIMEOUT, f"time limit of {self._task.time_limit:g} s"
        return None

    def _feel(self, context: Context, _values: DiscreteValues | None = None) -> None:
        """Read the walls' forces during the plant's step, which needs them too.

        Read in ``_publish``, they would be computed again, since the people's update invalidates
        Drake's cache.
        """
        if self._forces is not None and self.walls.near:
            self.walls.feel(wall_force(self._forces.Eval(context)))

    def _end(self, context: Context, t: float, status: Ending, reason: str) -> EventStatus | None:
        """End the robot's run; if it is the last robot, finish the whole run."""
        self._feel(context)  # there is no further step
        self._ending.end(status, reason, t)
        if all(other.ended for other in self._others.endings):
            return EventStatus.ReachedTermination(self, reason)
        self.finish(context, t)
        return None

    def finish(self, context: Context, t: float) -> None:
        """Record ongoing contacts and trips, once; ``context`` is this system's own."""
        if self._finished:
            return
        self._finished = True
        self.walls.finish()
        self._log.finish(t, None if self._crowd is None else self._crowd.Eval(context))
        self._others.end_contacts()

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
        speed = 0.0 if before is None else math.hypot(before.item(_VX), before.item(_VY))
        free = self.walls.watch(t, robot, speed)
        if self._forces is None:
            self.walls.feel(None)
        if self._person is not None:
            self._clearance.reset(robot.x, robot.y, free)
            return False
        zone = self._task.goal_zone
        distance = distance_to(zone, robot.x, robot.y)
        self._clearance.reset(robot.x, robot.y, min(free, distance - _ROUNDING))
        toppled = self._ending.toppled_time is not None
        if toppled or distance > 0.0 or not inside(zone, robot.x, robot.y):
            return False
        was_x, was_y = (robot.x, robot.y) if before is None else before[:2].tolist()
        fraction = entry_fraction(zone, was_x, was_y, robot.x, robot.y) if t > 0.0 else 1.0
        self._ending.goal_time = t - (1.0 - fraction) * TICK
        return True

    def _is_done(self, person: PersonWatch, t: float, robot: RobotState, crowd: Array) -> bool:
        """Return True if the robot's task about a person is done."""
        if self._ending.toppled_time is not None or not person.is_done(t, robot, crowd):
            return False
        self._ending.goal_time = t
        return True


def add_metric_logger(
    builder: DiagramBuilder,
    built: BuiltRun,
    robot: ControlledRobot,
    crowd: CrowdSystem | None,
    log: RunLog,
    others: OtherRobots,
) -> MetricLogger:
    """Add what watches the task and takes samples to a diagram."""
    logger = MetricLogger(
        log,
        built,
        WallContacts(built.parts, built.model, log),
        crowd,
        felt=robot.rig is not None,
        others=others,
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
