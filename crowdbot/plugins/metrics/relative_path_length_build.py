"""Relative path length, computed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from crowdbot.core.interfaces import References
from crowdbot.core.preprocess import path_length
from crowdbot.core.score import Score
from crowdbot.core.score_label import ScoreLabel
from crowdbot.core.trajectory import RobotTrack, Trajectories
from crowdbot.plugins.metrics.arrival_ratio import arrival_ratio
from crowdbot.plugins.metrics.relative_path_length import RelativePathLengthSpec

LABEL = ScoreLabel(
    metric="relative_path_length",
    symbol="L_rp",
    category="path efficiency",
    unit="1",
    better="higher",
)


@dataclass(frozen=True, slots=True)
class RelativePathLength:
    """Needs ``robot_alone``."""

    spec: RelativePathLengthSpec

    def score(self, run: Trajectories, refs: References) -> Sequence[Score]:
        """``literal`` and ``corrected``."""
        return arrival_ratio(LABEL, self._length, run, refs, self.spec.zero_tol)

    def _length(self, run: Trajectories, robot: RobotTrack) -> float:
        return path_length(run.t, robot, self.spec.jump_speed)


def build(spec: RelativePathLengthSpec) -> RelativePathLength:
    """The metric of a spec."""
    return RelativePathLength(spec)
