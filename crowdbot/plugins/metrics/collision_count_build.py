"""Collision count, computed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from crowdbot.core.encounter import (
    contact_onsets,
    contact_runs,
    disc_problem,
    encounter,
    people,
)
from crowdbot.core.interfaces import References
from crowdbot.core.preprocess import cropped
from crowdbot.core.score import Score
from crowdbot.core.score_label import ScoreLabel
from crowdbot.core.trajectory import Trajectories
from crowdbot.plugins.metrics.collision_count import CollisionCountSpec

LABEL = ScoreLabel(
    metric="collision_count", symbol="C", category="collision", unit="1", better="lower"
)


@dataclass(frozen=True, slots=True)
class CollisionCount:
    """Needs no reference run."""

    spec: CollisionCountSpec

    def score(self, run: Trajectories, refs: References) -> Sequence[Score]:
        """``literal``: runs of samples in contact; ``corrected``: contacts of the motion."""
        del refs
        if problem := disc_problem(run):
            return [LABEL.undefined(variant, problem) for variant in ("literal", "corrected")]
        run = cropped(run)
        assert run.robot is not None
        pair = encounter(run.t, run.robot, people(run), self.spec.jump_speed)
        onsets = contact_onsets(
            pair, contact_tol=self.spec.contact_tol, release_gap=self.spec.release_gap
        )
        first = {"first_time": float(onsets.time[0])} if len(onsets.time) else {}
        return [
            LABEL.ok("literal", contact_runs(pair, self.spec.contact_tol)),
            LABEL.ok("corrected", len(onsets.time), first),
        ]


def build(spec: CollisionCountSpec) -> CollisionCount:
    """The metric of a spec."""
    return CollisionCount(spec)
