"""How far the crowd pushes the robot off the path it takes alone, computed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from crowdbot.core.interfaces import (
    Array,
    References,
    Score,
    ScoreFactory,
    Trajectories,
    truncate_at_arrival,
)
from crowdbot.core.trajectories.encounters import robot_of
from crowdbot.core.trajectories.preprocess import inf_to_nan
from crowdbot.plugins.metrics.pairing_build import paired_samples
from crowdbot.plugins.metrics.reference_path import (
    ADE_TO_REFERENCE,
    FDE_TO_REFERENCE,
    AdeToReferenceSpec,
    FdeToReferenceSpec,
)


@dataclass(frozen=True, slots=True)
class AdeToReference:
    """Needs ``robot_alone``, sampled at the same times after the start."""

    spec: AdeToReferenceSpec

    def score(self, run: Trajectories, refs: References) -> Sequence[Score]:
        """Unweighted mean over the common samples, up to the earlier arrival."""
        apart = _apart(ScoreFactory(ADE_TO_REFERENCE), run, refs)
        if isinstance(apart, list):
            return apart
        return [ScoreFactory(ADE_TO_REFERENCE).ok("corrected", apart.mean())]


@dataclass(frozen=True, slots=True)
class FdeToReference:
    """Needs ``robot_alone``, sampled at the same times after the start."""

    spec: FdeToReferenceSpec

    def score(self, run: Trajectories, refs: References) -> Sequence[Score]:
        """At the last common sample."""
        apart = _apart(ScoreFactory(FDE_TO_REFERENCE), run, refs)
        if isinstance(apart, list):
            return apart
        return [ScoreFactory(FDE_TO_REFERENCE).ok("corrected", apart[-1])]


def _apart(factory: ScoreFactory, run: Trajectories, refs: References) -> Array | list[Score]:
    """Distance between both positions at each common sample (K,), m; or why there is none."""
    if run.robot is None:
        return factory.all_undefined("invalid_no_robot")
    if refs.robot_alone is None or refs.robot_alone.robot is None:
        return factory.all_undefined("no_reference")
    run, alone = truncate_at_arrival(run), truncate_at_arrival(refs.robot_alone)
    i, j = paired_samples(run.t, alone.t)
    one, two = robot_of(run), robot_of(alone)
    apart = np.hypot(
        *(inf_to_nan(a)[i] - inf_to_nan(b)[j] for a, b in ((one.x, two.x), (one.y, two.y)))
    )
    apart = apart[np.isfinite(apart)]
    return apart if len(apart) else factory.all_undefined("sampling_mismatch")
