"""Scoring of the deviation from the path that the robot takes alone."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

import crowdbot.plugins.metrics.reference_path as specs
from crowdbot.plugin import Array, References, Score, Trajectories, truncate_at_arrival
from crowdbot.plugin.for_metrics import (
    inf_to_nan,
    least_warping,
    robot_of,
    spaced,
    valid_robot_steps,
)
from crowdbot.plugins.metrics.declared_build import RobotMetric, UndefinedError
from crowdbot.plugins.metrics.pairing_build import paired_samples


class AdeToReference(RobotMetric[specs.AdeToReferenceSpec]):
    """Scores ``ade_to_reference``: unweighted mean distance over the common samples.

    Up to the earlier arrival. Needs ``robot_alone``, sampled at the same times after the start.
    """

    def _scores(self, run: Trajectories, refs: References) -> Sequence[Score]:
        return [self.factory.ok("corrected", _apart(run, refs).mean())]


class FdeToReference(RobotMetric[specs.FdeToReferenceSpec]):
    """Scores ``fde_to_reference``: the distance at the last common sample.

    Needs ``robot_alone``, sampled at the same times after the start.
    """

    def _scores(self, run: Trajectories, refs: References) -> Sequence[Score]:
        return [self.factory.ok("corrected", _apart(run, refs)[-1])]


class Ndtw(RobotMetric[specs.NdtwSpec]):
    """Scores ``ndtw``: ``exp(-DTW / (points of the reference x threshold))``.

    Needs ``robot_alone``. Ilharco et al. 2019.
    """

    def _scores(self, run: Trajectories, refs: References) -> Sequence[Score]:
        return [self.factory.ok("corrected", _likeness(run, refs, self.spec))]


class Sdtw(RobotMetric[specs.SdtwSpec]):
    """Scores ``sdtw``: 0 without arrival, else ``ndtw``.

    Needs ``robot_alone``. Ilharco et al. 2019.
    """

    def _scores(self, run: Trajectories, refs: References) -> Sequence[Score]:
        arrived = robot_of(run).goal_time is not None
        return [self.factory.ok("corrected", _likeness(run, refs, self.spec) * arrived)]


def _likeness(run: Trajectories, refs: References, spec: specs.NdtwSpec | specs.SdtwSpec) -> float:
    """Compare both paths up to the arrival, at equal spacing, so that time has no effect."""
    paths = [_path(one, spec) for one in (_alone(refs), run)]
    if not all(len(path) for path in paths):
        raise UndefinedError("too_few_samples")
    cost = least_warping(*paths) / (len(paths[0]) * spec.dtw_threshold)
    return float(np.exp(-cost))


def _alone(refs: References) -> Trajectories:
    """Return the robot's run without people, up to its arrival."""
    if refs.robot_alone is None or refs.robot_alone.robot is None:
        raise UndefinedError("no_reference")
    return truncate_at_arrival(refs.robot_alone)


def _path(run: Trajectories, spec: specs.NdtwSpec | specs.SdtwSpec) -> Array:
    robot = robot_of(run)
    valid = valid_robot_steps(run.t, robot, spec.jump_speed)
    return spaced(inf_to_nan(robot.x), inf_to_nan(robot.y), valid, spec.dtw_spacing)


def _apart(run: Trajectories, refs: References) -> Array:
    """Return the distance between both positions at each common sample (K,), m."""
    alone = _alone(refs)
    i, j = paired_samples(run.t, alone.t)
    one, two = robot_of(run), robot_of(alone)
    apart = np.hypot(
        *(inf_to_nan(a)[i] - inf_to_nan(b)[j] for a, b in ((one.x, two.x), (one.y, two.y)))
    )
    apart = apart[np.isfinite(apart)]
    if not len(apart):
        raise UndefinedError("sampling_mismatch")
    return apart
