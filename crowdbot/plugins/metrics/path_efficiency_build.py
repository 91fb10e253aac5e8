"""Scoring of the robot's time, path and jerk: the value alone divided by that in the crowd."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import numpy as np

import crowdbot.plugins.metrics.path_efficiency as specs
from crowdbot.plugin import (
    Array,
    References,
    Score,
    ScoreFactory,
    Trajectories,
    forward_speed,
    path_length,
    travel_time,
    truncate_at_arrival,
    yaw_rate,
)
from crowdbot.plugin.for_metrics import heading_changes, inf_to_nan, robot_of, valid_robot_steps
from crowdbot.plugins.metrics.common_reference_build import shortest_time
from crowdbot.plugins.metrics.declared_build import DeclaredMetric, UndefinedError

#: Variants that compare with the planner's own run alone.
_OWN = ("literal", "corrected")
#: Tolerance for comparing sampling rates, so that rounding does not decide.
RATE_TOLERANCE = 1e-9


class RelativeTimeToGoal(DeclaredMetric[specs.RelativeTimeToGoalSpec]):
    """Scores ``relative_time_to_goal``: time alone over time in the crowd.

    ``common``: time of the shortest path at full speed over time in the crowd. Needs
    ``robot_alone``.
    """

    def _scores(self, run: Trajectories, refs: References) -> Sequence[Score]:
        scores = _alone_over_crowded(self.factory, self._time, run, refs, self.spec, _OWN)
        return [*scores, self._common(run)]

    def _common(self, run: Trajectories) -> Score:
        """Score the time of the shortest path at full speed over the time taken."""
        try:
            shortest = shortest_time(run)
        except UndefinedError as error:
            return self.factory.undefined("common", str(error))
        run = truncate_at_arrival(run)
        return _grows(self.factory, "common", shortest, self._time(run), run, self.spec.zero_tol)

    def _time(self, run: Trajectories) -> float:
        return travel_time(run, robot_of(run))


class RelativePathLength(DeclaredMetric[specs.RelativePathLengthSpec]):
    """Scores ``relative_path_length``: path alone over path in the crowd.

    Needs ``robot_alone``.
    """

    def _scores(self, run: Trajectories, refs: References) -> Sequence[Score]:
        return _alone_over_crowded(self.factory, self._length, run, refs, self.spec, _OWN)

    def _length(self, run: Trajectories) -> float:
        return path_length(run.t, robot_of(run), self.spec.jump_speed)


class RelativeJerk(DeclaredMetric[specs.RelativeJerkSpec]):
    """Scores ``relative_jerk``: ``literal`` with its sign, and total variations.

    Needs ``robot_alone``, sampled as often as the run.
    """

    def _scores(self, run: Trajectories, refs: References) -> Sequence[Score]:
        if reason := obstacle(run, refs):
            raise UndefinedError(reason)
        assert refs.robot_alone is not None
        alone, run = truncate_at_arrival(refs.robot_alone), truncate_at_arrival(run)
        if min(len(alone.t), len(run.t)) < 3:
            raise UndefinedError("too_few_samples")
        j_alone, j_run = self._jerk(alone), self._jerk(run)
        scores = [self._literal(j_alone["literal"], j_run["literal"], run)]
        others = self.factory.variants[1:]
        if self._mismatch(alone.t, run.t):
            return scores + self.factory.all_undefined("sampling_mismatch", others)
        return scores + [self._ratio(v, j_alone[v], j_run[v], run) for v in others]

    def _ratio(self, variant: str, alone: float, crowded: float, run: Trajectories) -> Score:
        """Score alone over crowded; undefined for turning if the reference does not turn."""
        zero_tol = self.spec.jerk_zero_tol
        if variant == "angular" and alone <= zero_tol:
            return self.factory.undefined(variant, "reference_does_not_turn")
        return _grows(self.factory, variant, alone, crowded, run, zero_tol)

    def _literal(self, alone: float, crowded: float, run: Trajectories) -> Score:
        if robot_of(run).goal_time is None:
            return self.factory.undefined("literal", "goal_not_reached")
        if abs(crowded) <= self.spec.jerk_zero_tol:
            return self.factory.undefined("literal", "zero_denominator")
        return self.factory.ok("literal", alone / crowded, {"alone": alone, "crowded": crowded})

    def _mismatch(self, a: Array, b: Array) -> bool:
        """Return True if the median time steps differ by more than the tolerance of the larger."""
        one, two = float(np.median(np.diff(a))), float(np.median(np.diff(b)))
        return abs(one - two) > (self.spec.sampling_tol + RATE_TOLERANCE) * max(one, two)

    def _jerk(self, run: Trajectories) -> Mapping[str, float]:
        """Return the value of each variant, from forward speed v and yaw rate w."""
        t, robot, dt = run.t, robot_of(run), np.diff(run.t)
        v = forward_speed(t, robot, self.spec.jump_speed)
        w = yaw_rate(t, robot, self.spec.jump_speed)
        a, alpha = np.diff(v) / dt, np.diff(w) / dt
        linear, angular = _variation(a), _variation(w)
        return {
            "literal": _change(a) + _change(w),
            "corrected": linear + self.spec.jerk_weight * angular,
            "linear": linear,
            "angular": angular,
            "norm": _sum(np.hypot(np.diff(a), np.diff(alpha))),
            "legacy": self._second_differences(run),
        }

    def _second_differences(self, run: Trajectories) -> float:
        """Return the sum of second differences of x, y and heading over valid steps, without dt."""
        robot = robot_of(run)
        valid = valid_robot_steps(run.t, robot, self.spec.jump_speed)
        turn = heading_changes(run.t, robot, self.spec.jump_speed)
        steps = [np.where(valid, np.diff(inf_to_nan(p)), np.nan) for p in (robot.x, robot.y)]
        return sum(_sum(np.abs(np.diff(s))) for s in (*steps, turn))


def obstacle(run: Trajectories, refs: References) -> str:
    """Return why the run cannot be compared with its reference, or ""."""
    if run.robot is None:
        return "invalid_no_robot"
    if refs.robot_alone is None or refs.robot_alone.robot is None:
        return "no_reference"
    if refs.robot_alone.robot.goal_time is None:
        return "reference_goal_not_reached"
    return ""


def _alone_over_crowded(
    factory: ScoreFactory,
    measure: Callable[[Trajectories], float],
    run: Trajectories,
    refs: References,
    spec: specs.RelativeTimeToGoalSpec | specs.RelativePathLengthSpec,
    variants: Sequence[str],
) -> list[Score]:
    """Score ``literal`` and ``corrected``, which differ if the robot never arrived."""
    if reason := obstacle(run, refs):
        return factory.all_undefined(reason, variants)
    assert refs.robot_alone is not None
    run = truncate_at_arrival(run)
    alone, crowded = measure(truncate_at_arrival(refs.robot_alone)), measure(run)
    corrected = _grows(factory, "corrected", alone, crowded, run, spec.zero_tol)
    if robot_of(run).goal_time is None:
        return [factory.undefined("literal", "goal_not_reached"), corrected]
    both = {"alone": alone, "crowded": crowded}
    return [factory.ratio("literal", alone, crowded, spec.zero_tol, both), corrected]


def _grows(
    factory: ScoreFactory,
    variant: str,
    alone: float,
    crowded: float,
    run: Trajectories,
    zero_tol: float,
) -> Score:
    """Score alone over crowded; without arrival, a bound, since the quantity only grows."""
    both = {"alone": alone, "crowded": crowded}
    if robot_of(run).goal_time is not None:
        return factory.ratio(variant, alone, crowded, zero_tol, both)
    upper = alone / crowded if crowded > zero_tol else None
    return factory.censored(variant, "goal_not_reached", lower=0.0, upper=upper, extras=both)


def _sum(values: Array) -> float:
    """Return the sum of the known values."""
    return float(values[np.isfinite(values)].sum())


def _variation(values: Array) -> float:
    return _sum(np.abs(np.diff(values)))


def _change(values: Array) -> float:
    """Return the last known value minus the first."""
    known = values[np.isfinite(values)]
    return float(known[-1] - known[0]) if len(known) else 0.0
