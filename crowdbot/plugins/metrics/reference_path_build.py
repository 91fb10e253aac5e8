"""Scoring of the deviation from the path that the robot takes alone."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from crowdbot.plugin import (
    Array,
    References,
    Score,
    ScoreFactory,
    Trajectories,
    truncate_at_arrival,
)
from crowdbot.plugin.for_metrics import (
    inf_to_nan,
    least_warping,
    robot_of,
    spaced,
    valid_robot_steps,
)
from crowdbot.plugins.metrics.pairing_build import paired_samples
from crowdbot.plugins.metrics.reference_path import (
    ADE_TO_REFERENCE,
    FDE_TO_REFERENCE,
    NDTW,
    SDTW,
    AdeToReferenceSpec,
    FdeToReferenceSpec,
    NdtwSpec,
    SdtwSpec,
)


@dataclass(frozen=True, slots=True)
class AdeToReference:
    """Scores ``ade_to_reference``.

    Needs ``robot_alone``, sampled at the same times after the start.
    """

    spec: AdeToReferenceSpec

    def score(self, run: Trajectories, refs: References) -> Sequence[Score]:
        """Score the unweighted mean over the common samples, up to the earlier arrival."""
        apart = _apart(ScoreFactory(ADE_TO_REFERENCE), run, refs)
        if isinstance(apart, list):
            return apart
        return [ScoreFactory(ADE_TO_REFERENCE).ok("corrected", apart.mean())]


@dataclass(frozen=True, slots=True)
class FdeToReference:
    """Scores ``fde_to_reference``.

    Needs ``robot_alone``, sampled at the same times after the start.
    """

    spec: FdeToReferenceSpec

    def score(self, run: Trajectories, refs: References) -> Sequence[Score]:
        """Score the distance at the last common sample."""
        apart = _apart(ScoreFactory(FDE_TO_REFERENCE), run, refs)
        if isinstance(apart, list):
            return apart
        return [ScoreFactory(FDE_TO_REFERENCE).ok("corrected", apart[-1])]


@dataclass(frozen=True, slots=True)
class Ndtw:
    """Scores ``ndtw``. Needs ``robot_alone``. Ilharco et al. 2019."""

    spec: NdtwSpec

    def score(self, run: Trajectories, refs: References) -> Sequence[Score]:
        """Score ``exp(-DTW / (points of the reference x threshold))``."""
        return _likeness(ScoreFactory(NDTW), run, refs, self.spec)


@dataclass(frozen=True, slots=True)
class Sdtw:
    """Scores ``sdtw``. Needs ``robot_alone``. Ilharco et al. 2019."""

    spec: SdtwSpec

    def score(self, run: Trajectories, refs: References) -> Sequence[Score]:
        """Score 0 without arrival, else ``ndtw``."""
        factory = ScoreFactory(SDTW)
        found = _likeness(factory, run, refs, self.spec)
        if found[0].value is None or robot_of(run).goal_time is not None:
            return found
        return [factory.ok("corrected", 0.0)]


def _likeness(
    factory: ScoreFactory, run: Trajectories, refs: References, spec: NdtwSpec | SdtwSpec
) -> list[Score]:
    """Compare both paths up to the arrival, at equal spacing, so that time has no effect."""
    if run.robot is None:
        return factory.all_undefined("invalid_no_robot")
    if refs.robot_alone is None or refs.robot_alone.robot is None:
        return factory.all_undefined("no_reference")
    paths = [_path(truncate_at_arrival(r), spec) for r in (refs.robot_alone, run)]
    if not all(len(path) for path in paths):
        return factory.all_undefined("too_few_samples")
    cost = least_warping(*paths) / (len(paths[0]) * spec.dtw_threshold)
    return [factory.ok("corrected", np.exp(-cost))]


def _path(run: Trajectories, spec: NdtwSpec | SdtwSpec) -> Array:
    robot = robot_of(run)
    valid = valid_robot_steps(run.t, robot, spec.jump_speed)
    return spaced(inf_to_nan(robot.x), inf_to_nan(robot.y), valid, spec.dtw_spacing)


def _apart(factory: ScoreFactory, run: Trajectories, refs: References) -> Array | list[Score]:
    """Return the distance between both positions at each common sample (K,), m; or why not."""
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
