"""Progress and outcome of a run, without Drake."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import NamedTuple

from crowdbot.core.recording.container.own_file import Written


class Progress(NamedTuple):
    """Progress of a run: simulated time and limit (s), real-time factor, distance to goal (m)."""

    stage: str
    t: float
    limit: float
    real_time_factor: float
    distance: float | None


@dataclass(frozen=True, slots=True, kw_only=True)
class Outcome:
    """The outcome of a run; times in s.

    Attributes:
        toppled_time: when the robot toppled, which ended the run; or None.
        clamped: number of commands clamped to the robot's limits.
        planner_step_time: mean and largest wall time of a planner step.
        robots: outcome of each of several robots; empty in a run of one.
        written: the recording, as the simulator wrote it.
    """

    status: str
    reason: str
    goal_time: float | None
    sim_time: float
    wall_time: float
    cpu_time: float
    toppled_time: float | None = None
    clamped: int = 0
    planner_step_time: Mapping[str, float] = field(default_factory=dict)
    robots: Mapping[str, Outcome] = field(default_factory=dict)
    written: Written | None = None

    @property
    def real_time_factor(self) -> float:
        """Return simulated time over wall time."""
        return self.sim_time / max(self.wall_time, 1e-9)
