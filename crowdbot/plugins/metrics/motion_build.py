"""Scoring of the robot's own motion, independent of people."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

import crowdbot.plugins.metrics.motion as specs
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
    yaw_rate,
)
from crowdbot.plugin.for_metrics import heading_changes, robot_of, robot_velocities, wrap
from crowdbot.plugins.metrics.declared_build import RobotMetric, UndefinedError


class TimeNotMoving(RobotMetric[specs.TimeNotMovingSpec]):
    """Scores ``time_not_moving``: the time in which the robot neither drives nor turns."""

    def _scores(self, run: Trajectories, _: References) -> Sequence[Score]:
        speed = np.hypot(*robot_velocities(run, self.spec.jump_speed))
        turning = np.abs(yaw_rate(run.t, robot_of(run), self.spec.jump_speed))
        still = (speed < self.spec.still_speed) & (turning < self.spec.still_turn)
        return [self.factory.ok("corrected", time_weights(run.t) @ still)]


class StalledTime(RobotMetric[specs.StalledTimeSpec]):
    """Scores ``stalled_time``: the time in which the robot hardly drives, turning or not."""

    def _scores(self, run: Trajectories, _: References) -> Sequence[Score]:
        speed = np.hypot(*robot_velocities(run, self.spec.jump_speed))
        return [self.factory.ok("corrected", time_weights(run.t) @ (speed < self.spec.stall_speed))]


class CumulativeHeadingChange(RobotMetric[specs.CumulativeHeadingChangeSpec]):
    """Scores ``cumulative_heading_change``: the sum of heading changes over the valid steps."""

    def _scores(self, run: Trajectories, _: References) -> Sequence[Score]:
        return [self.factory.ok("corrected", _all_turning(run, self.spec.jump_speed))]


class PathIrregularity(RobotMetric[specs.PathIrregularitySpec]):
    """Scores ``path_irregularity``: turning per metre, beyond that from first to last heading."""

    def _scores(self, run: Trajectories, _: References) -> Sequence[Score]:
        jump = self.spec.jump_speed
        robot = robot_of(run)
        theta = robot.theta[np.isfinite(robot.theta)]
        needed = float(np.abs(wrap(theta[-1:] - theta[:1])).sum())
        extra = max(0.0, _all_turning(run, jump) - needed)
        length = path_length(run.t, robot, jump)
        return [self.factory.ratio("corrected", extra, length, self.spec.zero_tol)]


class Speed(RobotMetric[specs.SpeedSpec]):
    """Scores ``speed``: the magnitude of the velocity; ``avg`` is the mean over time."""

    def _scores(self, run: Trajectories, _: References) -> Sequence[Score]:
        speed = np.hypot(*robot_velocities(run, self.spec.jump_speed))
        return _spread(self.factory, speed, time_weights(run.t))


class Acceleration(RobotMetric[specs.AccelerationSpec]):
    """Scores ``acceleration``: the change of forward speed from step to step."""

    def _scores(self, run: Trajectories, _: References) -> Sequence[Score]:
        dt = np.diff(run.t)
        v = forward_speed(run.t, robot_of(run), self.spec.jump_speed)
        return _spread(self.factory, np.abs(np.diff(v) / dt), dt)


class Jerk(RobotMetric[specs.JerkSpec]):
    """Scores ``jerk``: the change of acceleration between neighbouring steps."""

    def _scores(self, run: Trajectories, _: References) -> Sequence[Score]:
        return _spread(self.factory, *_jerk(run, self.spec.jump_speed))


class DimensionlessJerk(RobotMetric[specs.DimensionlessJerkSpec]):
    """Scores ``dimensionless_jerk``: T³/v_peak² times the integral of the squared jerk.

    Balasubramanian et al. 2015, without logarithm and sign.
    """

    def _scores(self, run: Trajectories, _: References) -> Sequence[Score]:
        jerk, dt = _jerk(run, self.spec.jump_speed)
        if not np.isfinite(jerk).any():
            raise UndefinedError("too_few_samples")
        v = forward_speed(run.t, robot_of(run), self.spec.jump_speed)
        peak = float(np.nanmax(np.abs(v)))
        total = float(np.where(np.isfinite(jerk), jerk, 0.0) ** 2 @ dt)
        scale = duration(run.t) ** 3
        return [self.factory.ratio("corrected", total * scale, peak**2, self.spec.zero_tol**2)]


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
        raise UndefinedError("too_few_samples")
    least, most = factory.ok("min", values.min()), factory.ok("max", values.max())
    if weights.sum() <= 0:
        return [least, factory.undefined("avg", "too_few_samples"), most]
    return [least, factory.ok("avg", weights @ values / weights.sum()), most]
