"""PeopleLogger: samples people who are recorded once for several robots."""

from __future__ import annotations

from pydrake.systems.framework import Context, DiagramBuilder

from crowdbot.core.recording.run_log import RunLog
from crowdbot.core.sim import ports
from crowdbot.core.sim.block import Block
from crowdbot.core.sim.crowd_system import CrowdSystem
from crowdbot.core.sim.weak_callback import NO_ATTRIBUTES
from crowdbot.core.support.ticks import TICK, TICKS_PER_SECOND, ticks


class PeopleLogger(Block):
    """Inputs: crowd state and events.

    Add it after the robots' monitors: blocks publish in the order of addition.
    """

    __slots__ = NO_ATTRIBUTES

    def __init__(self, log: RunLog, crowd: CrowdSystem | None, rate: float) -> None:
        super().__init__()
        self._log = log
        self._ticks_per_sample, self._last_tick = ticks(rate), -1
        self._crowd = self._events = None
        if crowd is not None:
            self._crowd = self.DeclareVectorInputPort(ports.CROWD_STATE, crowd.state.size())
            self._events = self.DeclareVectorInputPort(ports.EVENTS, crowd.events.size())
        self.DeclarePeriodicPublishEvent(TICK, 0.0, self._publish)

    def _publish(self, context: Context) -> None:
        tick = round(context.get_time() * TICKS_PER_SECOND)
        if tick == self._last_tick:  # Initialize and the first step may both publish t = 0
            return
        self._last_tick = tick
        self._record_events(context)
        if tick % self._ticks_per_sample == 0:
            crowd = None if self._crowd is None else self._crowd.Eval(context)
            self._log.sample(tick * TICK, None, crowd)

    def _record_events(self, context: Context) -> None:
        if self._crowd is None or self._events is None:
            return
        if not self._log.has_recorded(self._events.Eval(context)):
            self._log.record_events(self._crowd.Eval(context))

    def finish(self, context: Context, t: float) -> None:
        """Record active trips at the end; ``context`` is this system's own."""
        self._log.finish(t, None if self._crowd is None else self._crowd.Eval(context))


def add_people_logger(
    builder: DiagramBuilder, crowd: CrowdSystem | None, log: RunLog, rate: float
) -> PeopleLogger:
    """Add a people logger to a diagram, after all monitors of robots."""
    logger = PeopleLogger(log, crowd, rate)
    builder.AddNamedSystem("people_logger", logger)
    if crowd is not None:
        builder.Connect(crowd.state, logger.GetInputPort(ports.CROWD_STATE))
        builder.Connect(crowd.events, logger.GetInputPort(ports.EVENTS))
    return logger
