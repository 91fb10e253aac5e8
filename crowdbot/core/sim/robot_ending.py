"""RobotEnding: how one robot of a run has ended, if it has."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(slots=True, kw_only=True)
class RobotEnding:
    """A robot goes on, or has ended: then it stands where it is, or has left.

    Watched at the beginning of each tick, by `crowdbot.core.sim.loggers.metric_logger`, so that all
    blocks agree on it during the tick.

    Attributes:
        leaves: True if it is out of everyone's way once it has ended.
        status, reason: how it ended; empty before.
        goal_time: when it arrived, s, or None.
        toppled_time: when it toppled, s, or None.
        until: when it ended, s.
        failure: what its planner failed with; the robot ends at the next tick.
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
        """True if the robot has arrived, toppled, failed, or run out of time."""
        return bool(self.status)

    @property
    def gone(self) -> bool:
        """True if the robot has left the world."""
        return self.leaves and self.ended

    def end(self, status: str, reason: str, t: float) -> None:
        """End the robot's run at ``t``, s."""
        self.status, self.reason, self.until = status, reason, t
