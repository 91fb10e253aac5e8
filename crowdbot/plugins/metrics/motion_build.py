"""Scoring of the robot's own motion, independent of people."""

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
    duration,
    forward_speed,
    path_length,
    time_weights,
    truncate_at_arrival,
    yaw_rate,
)
from crowdbot.plugin.for_metrics import heading_changes, robot_of, robot_velocities, wrap
from crowdbot.plugins.metrics.motion import (
    ACCELERATION,
    CUMULATIVE_HEADING_CHANGE,
    DIMENSIONLESS_JERK,
    JERK,
    PATH_IRREGULARITY,
    SPEED,
    STALLED_TIME,
    TIME_NOT_MOVING,
    AccelerationSpec,
    CumulativeHeadingChangeSpec,
    DimensionlessJerkSpec,
    JerkSpec,
    PathIrregularitySpec,
    SpeedSpec,
    StalledTimeSpec,
    TimeNotMovingSpec,
)


@dataclass(frozen=True, slots=True)
class TimeNotMoving:
    """Scores ``time_not_moving``. Needs no reference run."""

    spec: TimeNotMovingSpec

    def score(self, run: Trajectories, refs: References) -> Sequence[Score]:
        """Score the time in which the robot neither drives nor turns."""
        del refs
        factory = ScoreFactory(TIME_NOT_MOVING)
        if run.robot is None:
            return factory.all_undefined("invalid_no_robot")
        run = truncate_at_arrival(run)
        speed = np.hypot(*robot_velocities(run, self.spec.jump_speed))
        turning = np.abs(yaw_rate(run.t, robot_of(run), self.spec.jump_speed))
        still = (speed < self.spec.still_speed) & (turning < self.spec.still_turn)
        return [factory.ok("corrected", time_weights(run.t) @ still)]


@dataclass(frozen=True, slots=True)
class StalledTime:
    """Scores ``stalled_time``. Needs no reference run."""

    spec: StalledTimeSpec

    def score(self, run: Trajectories, refs: References) -> Sequence[Score]:
        """Score the time in which the robot hardly drives, turning or not."""
        del refs
        factory = ScoreFactory(STALLED_TIME)
        if run.robot is None:
            return factory.all_undefined("invalid_no_robot")
        run = truncate_at_arrival(run)
        speed = np.hypot(*robot_velocities(run, self.spec.jump_speed))
        return [factory.ok("corrected", time_weights(run.t) @ (speed < self.spec.stall_speed))]


@dataclass(frozen=True, slots=True)
class CumulativeHeadingChange:
    """Scores ``cumulative_heading_change``. Needs no reference run."""

    spec: CumulativeHeadingChangeSpec

    def score(self, run: Trajectories, refs: References) -> Sequence[Score]:
        """Score the sum of heading changes over the valid steps."""
        del refs
        factory = ScoreFactory(CUMULATIVE_HEADING_CHANGE)
        if run.robot is None:
            return factory.all_undefined("invalid_no_robot")
        return [
            factory.ok("corrected", _all_turning(truncate_at_arrival(run), self.spec.jump_speed))
        ]


@dataclass(frozen=True, slots=True)
class PathIrregularity:
    """Scores ``path_irregularity``. Needs no reference run."""

    spec: PathIrregularitySpec

    def score(self, run: Trajectories, refs: References) -> Sequence[Score]:
        """Score the turning beyond the turn from the first heading to the last, per metre."""
        del refs
        factory, jump = ScoreFactory(PATH_IRREGULARITY), self.spec.jump_speed
        if run.robot is None:
            return factory.all_undefined("invalid_no_robot")
        run = truncate_at_arrival(run)
        robot = robot_of(run)
        theta = robot.theta[np.isfinite(robot.theta)]
        needed = float(np.abs(wrap(theta[-1:] - theta[:1])).sum())
        extra = max(0.0, _all_turning(run, jump) - needed)
        length = path_length(run.t, robot, jump)
        return [factory.ratio("corrected", extra, length, self.spec.zero_tol)]


@dataclass(frozen=True, slots=True)
class Speed:
    """Scores ``speed``. Needs no reference run."""

    spec: SpeedSpec

    def score(self, run: Trajectories, refs: References) -> Sequence[Score]:
        """Score the magnitude of the velocity; ``avg`` is the mean over time."""
        del refs
        if run.robot is None:
            return ScoreFactory(SPEED).all_undefined("invalid_no_robot")
        run = truncate_at_arrival(run)
        speed = np.hypot(*robot_velocities(run, self.spec.jump_speed))
        return _spread(ScoreFactory(SPEED), speed, time_weights(run.t))


@dataclass(frozen=True, slots=True)
class Acceleration:
    """Scores ``acceleration``. Needs no reference run."""

    spec: AccelerationSpec

    def score(self, run: Trajectories, refs: References) -> Sequence[Score]:
        """Score the change of forward speed from step to step."""
        del refs
        if run.robot is None:
            return ScoreFactory(ACCELERATION).all_undefined("invalid_no_robot")
        run = truncate_at_arrival(run)
        dt = np.diff(run.t)
        v = forward_speed(run.t, robot_of(run), self.spec.jump_speed)
        return _spread(ScoreFactory(ACCELERATION), np.abs(np.diff(v) / dt), dt)


@dataclass(frozen=True, slots=True)
class Jerk:
    """Scores ``jerk``. Needs no reference run."""

    spec: JerkSpec

    def score(self, run: Trajectories, refs: References) -> Sequence[Score]:
        """Score the change of acceleration between neighbouring steps."""
        del refs
        if run.robot is None:
            return ScoreFactory(JERK).all_undefined("invalid_no_robot")
        run = truncate_at_arrival(run)
        return _spread(ScoreFactory(JERK), *_jerk(run, self.spec.jump_speed))


@dataclass(frozen=True, slots=True)
class DimensionlessJerk:
    """Scores ``dimensionless_jerk``. Needs no reference run.

    Balasubramanian et al. 2015, without logarithm and sign.
    """

    spec: DimensionlessJerkSpec

    def score(self, run: Trajectories, refs: References) -> Sequence[Score]:
        """Score T³/v_peak² times the integral of the squared jerk."""
        del refs
        factory = ScoreFactory(DIMENSIONLESS_JERK)
        if run.robot is None:
            return factory.all_undefined("invalid_no_robot")
        run = truncate_at_arrival(run)
        jerk, dt = _jerk(run, self.spec.jump_speed)
        if not np.isfinite(jerk).any():
            return factory.all_undefined("too_few_samples")
        v = forward_speed(run.t, robot_of(run), self.spec.jump_speed)
        peak = float(np.nanmax(np.abs(v)))
        total = float(np.where(np.isfinite(jerk), jerk, 0.0) ** 2 @ dt)
        scale = duration(run.t) ** 3
        return [factory.ratio("corrected", total * scale, peak**2, self.spec.zero_tol**2)]


def _all_turning(run: Trajectories, jump_speed: float) -> float:
    turn = np.abs(heading_changes(run.t, robot_of(run), jump_speed))
    return float(turn[np.isfinite(turn)].sum())


def _jerk(run: Trajectories, jump_speed: float) -> tuple[Array, Array]:
    """Return the jerk's magnitude (N-2,), m/s³, and the time between the steps' middles, s."""
    dt = np.diff(run.t)
    v = forward_speed(run.t, robot_of(run), jump_speed)
    middle = (dt[1:] + dt[:-1]) / 2.0
    return np.abs(np.diff(np.diff(v) / dt)) / middle, middle


def _spread(factory: ScoreFactory, values: Array, weights: Array) -> list[Score]:
    """Score ``min``, ``avg`` and ``max`` of the known values."""
    known = np.isfinite(values)
    values, weights = values[known], weights[known]
    if not len(values):
        return factory.all_undefined("too_few_samples")
    least, most = factory.ok("min", values.min()), factory.ok("max", values.max())
    if weights.sum() <= 0:
        return [least, factory.undefined("avg", "too_few_samples"), most]
    return [least, factory.ok("avg", weights @ values / weights.sum()), most]
