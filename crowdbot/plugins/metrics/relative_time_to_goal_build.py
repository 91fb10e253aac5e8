"""Relative time to goal, computed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from crowdbot.core.interfaces import References
from crowdbot.core.preprocess import travel_time
from crowdbot.core.score import Score
from crowdbot.core.score_label import ScoreLabel
from crowdbot.core.trajectory import Trajectories
from crowdbot.plugins.metrics.arrival_ratio import arrival_ratio
from crowdbot.plugins.metrics.relative_time_to_goal import RelativeTimeToGoalSpec

LABEL = ScoreLabel(
    metric="relative_time_to_goal",
    symbol="T_rtg",
    category="path efficiency",
    unit="1",
    better="higher",
)


@dataclass(frozen=True, slots=True)
class RelativeTimeToGoal:
    """Needs ``robot_alone``."""

    spec: RelativeTimeToGoalSpec

    def score(self, run: Trajectories, refs: References) -> Sequence[Score]:
        """``literal`` and ``corrected``."""
        return arrival_ratio(LABEL, travel_time, run, refs, self.spec.zero_tol)


def build(spec: RelativeTimeToGoalSpec) -> RelativeTimeToGoal:
    """The metric of a spec."""
    return RelativeTimeToGoal(spec)
