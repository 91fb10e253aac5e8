"""The ending of one robot of a fleet."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(slots=True, kw_only=True)
class Fate:
    """A robot is active, or has ended: then it stands where it is, or has left.

    Updated at the start of each tick (`crowdbot.core.sim.metric_logger`), so that it is constant
    for all blocks during the tick.

    Attributes:
        leaves: True if it disappears when it has ended.
        status, reason: how it ended, or empty.
        goal_time: time of arrival, s, or None.
        toppled_time: time of toppling, s, or None.
        until: time of its end, s.
        failure: its planner's failure; the robot ends at the next tick.
    """

    leaves: bool = False
    status: str = ""
    reason: str = ""
    goal_time: float | None = None
    toppled_time: float | None = None
    until: float = 0.0
    failure: str = ""

    @property
    def ended(self) -> bool:
        """Return True if it has arrived, toppled, failed, or run out of time."""
        return bool(self.status)

    @property
    def gone(self) -> bool:
        """Return True if it has left."""
        return self.leaves and self.ended

    def end(
        self,
        status: str,
        reason: str,
        t: float,
        goal_time: float | None = None,
        toppled_time: float | None = None,
    ) -> None:
        """End the robot at ``t``, s."""
        self.status, self.reason, self.until = status, reason, t
        self.goal_time, self.toppled_time = goal_time, toppled_time
