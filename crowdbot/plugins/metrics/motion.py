"""Metrics of the robot's own motion, independent of people."""

from __future__ import annotations

from functools import partial
from typing import Literal

import crowdbot.plugins.metrics.parameters as parameters
from crowdbot.plugin import MetricSpec, declare_metric

declare = partial(declare_metric, category="motion", minimum=0.0, better="lower")


class TimeNotMovingSpec(MetricSpec):
    """Time during which the robot neither drives nor turns."""

    kind: Literal["time_not_moving"] = "time_not_moving"
    still_speed: parameters.StillSpeed
    still_turn: parameters.StillTurn
    jump_speed: parameters.JumpSpeed


TIME_NOT_MOVING = declare(TimeNotMovingSpec, symbol="T_nm", unit="s")


class StalledTimeSpec(MetricSpec):
    """Time during which the robot hardly drives."""

    kind: Literal["stalled_time"] = "stalled_time"
    stall_speed: parameters.StallSpeed
    jump_speed: parameters.JumpSpeed


STALLED_TIME = declare(StalledTimeSpec, symbol="ST", unit="s", experimental=True)


class CumulativeHeadingChangeSpec(MetricSpec):
    """Sum of all turning, in either direction."""

    kind: Literal["cumulative_heading_change"] = "cumulative_heading_change"
    jump_speed: parameters.JumpSpeed


CUMULATIVE_HEADING_CHANGE = declare(CumulativeHeadingChangeSpec, symbol="CHC", unit="rad")


class PathIrregularitySpec(MetricSpec):
    """Turning beyond the necessary amount, per length of the path."""

    kind: Literal["path_irregularity"] = "path_irregularity"
    zero_tol: parameters.ZeroTol
    jump_speed: parameters.JumpSpeed


PATH_IRREGULARITY = declare(PathIrregularitySpec, symbol="PI", unit="rad/m", experimental=True)


class SpeedSpec(MetricSpec):
    """Speed of the robot."""

    kind: Literal["speed"] = "speed"
    jump_speed: parameters.JumpSpeed


SPEED = declare(
    SpeedSpec,
    symbol="V",
    unit="m/s",
    better="none",
    experimental=True,
    variants=("min", "avg", "max"),
)


class AccelerationSpec(MetricSpec):
    """Magnitude of the robot's tangential acceleration."""

    kind: Literal["acceleration"] = "acceleration"
    jump_speed: parameters.JumpSpeed


ACCELERATION = declare(
    AccelerationSpec,
    symbol="A",
    unit="m/s²",
    better="none",
    experimental=True,
    variants=("min", "avg", "max"),
)


class JerkSpec(MetricSpec):
    """Magnitude of the robot's tangential jerk."""

    kind: Literal["jerk"] = "jerk"
    jump_speed: parameters.JumpSpeed


JERK = declare(JerkSpec, symbol="J", unit="m/s³", experimental=True, variants=("min", "avg", "max"))


class DimensionlessJerkSpec(MetricSpec):
    """Integral of the squared jerk, made free of duration and speed."""

    kind: Literal["dimensionless_jerk"] = "dimensionless_jerk"
    zero_tol: parameters.ZeroTol
    jump_speed: parameters.JumpSpeed


DIMENSIONLESS_JERK = declare(DimensionlessJerkSpec, symbol="DLJ", unit="1", experimental=True)
