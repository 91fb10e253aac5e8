"""How the robot moves, whoever is around."""

from __future__ import annotations

from typing import Literal

from crowdbot.core.laws import Laws
from crowdbot.core.score_label import MetricComponent, ScoreLabel
from crowdbot.dsl.base import MetricSpec
from crowdbot.plugins.metrics.parameters import (
    JumpSpeed,
    StallSpeed,
    StillSpeed,
    StillTurn,
    ZeroTol,
)


class TimeNotMovingSpec(MetricSpec):
    """Time during which the robot neither drives nor turns."""

    kind: Literal["time_not_moving"] = "time_not_moving"
    still_speed: StillSpeed = 1e-3
    still_turn: StillTurn = 1e-2
    jump_speed: JumpSpeed = 10.0


class StalledTimeSpec(MetricSpec):
    """Time during which the robot hardly drives."""

    kind: Literal["stalled_time"] = "stalled_time"
    stall_speed: StallSpeed = 0.05
    jump_speed: JumpSpeed = 10.0


class CumulativeHeadingChangeSpec(MetricSpec):
    """Sum of all turning, whichever way."""

    kind: Literal["cumulative_heading_change"] = "cumulative_heading_change"
    jump_speed: JumpSpeed = 10.0


class PathIrregularitySpec(MetricSpec):
    """Turning beyond what is needed, per length of the path."""

    kind: Literal["path_irregularity"] = "path_irregularity"
    zero_tol: ZeroTol = 1e-9
    jump_speed: JumpSpeed = 10.0


class SpeedSpec(MetricSpec):
    """Speed of the robot."""

    kind: Literal["speed"] = "speed"
    jump_speed: JumpSpeed = 10.0


class AccelerationSpec(MetricSpec):
    """Magnitude of the robot's tangential acceleration."""

    kind: Literal["acceleration"] = "acceleration"
    jump_speed: JumpSpeed = 10.0


class JerkSpec(MetricSpec):
    """Magnitude of the robot's tangential jerk."""

    kind: Literal["jerk"] = "jerk"
    jump_speed: JumpSpeed = 10.0


class DimensionlessJerkSpec(MetricSpec):
    """Integral of the squared jerk, made free of duration and speed."""

    kind: Literal["dimensionless_jerk"] = "dimensionless_jerk"
    zero_tol: ZeroTol = 1e-9
    jump_speed: JumpSpeed = 10.0


TIME_NOT_MOVING = MetricComponent(
    spec=TimeNotMovingSpec,
    build="crowdbot.plugins.metrics.motion_build:TimeNotMoving",
    summary="T_nm: time during which the robot neither drives nor turns",
    label=ScoreLabel(
        metric="time_not_moving",
        symbol="T_nm",
        category="motion",
        unit="s",
        better="lower",
    ),
    laws={
        "corrected": Laws(least=0.0),
    },
)
STALLED_TIME = MetricComponent(
    spec=StalledTimeSpec,
    build="crowdbot.plugins.metrics.motion_build:StalledTime",
    summary="ST: time during which the robot hardly drives",
    experimental=True,
    label=ScoreLabel(
        metric="stalled_time",
        symbol="ST",
        category="motion",
        unit="s",
        better="lower",
    ),
    laws={
        "corrected": Laws(least=0.0),
    },
)
CUMULATIVE_HEADING_CHANGE = MetricComponent(
    spec=CumulativeHeadingChangeSpec,
    build="crowdbot.plugins.metrics.motion_build:CumulativeHeadingChange",
    summary="CHC: sum of all turning, whichever way",
    label=ScoreLabel(
        metric="cumulative_heading_change",
        symbol="CHC",
        category="motion",
        unit="rad",
        better="lower",
    ),
    laws={
        "corrected": Laws(least=0.0),
    },
)
PATH_IRREGULARITY = MetricComponent(
    spec=PathIrregularitySpec,
    build="crowdbot.plugins.metrics.motion_build:PathIrregularity",
    summary="PI: turning beyond what is needed, per length of the path",
    experimental=True,
    label=ScoreLabel(
        metric="path_irregularity",
        symbol="PI",
        category="motion",
        unit="rad/m",
        better="lower",
    ),
    laws={
        "corrected": Laws(least=0.0),
    },
)
SPEED = MetricComponent(
    spec=SpeedSpec,
    build="crowdbot.plugins.metrics.motion_build:Speed",
    summary="V: speed of the robot",
    experimental=True,
    label=ScoreLabel(
        metric="speed",
        symbol="V",
        category="motion",
        unit="m/s",
        better="none",
        variants=("min", "avg", "max"),
    ),
    laws={
        "min": Laws(least=0.0),
        "avg": Laws(least=0.0),
        "max": Laws(least=0.0),
    },
)
ACCELERATION = MetricComponent(
    spec=AccelerationSpec,
    build="crowdbot.plugins.metrics.motion_build:Acceleration",
    summary="A: magnitude of the robot's tangential acceleration",
    experimental=True,
    label=ScoreLabel(
        metric="acceleration",
        symbol="A",
        category="motion",
        unit="m/s²",
        better="none",
        variants=("min", "avg", "max"),
    ),
    laws={
        "min": Laws(least=0.0),
        "avg": Laws(least=0.0),
        "max": Laws(least=0.0),
    },
)
JERK = MetricComponent(
    spec=JerkSpec,
    build="crowdbot.plugins.metrics.motion_build:Jerk",
    summary="J: magnitude of the robot's tangential jerk",
    experimental=True,
    label=ScoreLabel(
        metric="jerk",
        symbol="J",
        category="motion",
        unit="m/s³",
        better="lower",
        variants=("min", "avg", "max"),
    ),
    laws={
        "min": Laws(least=0.0),
        "avg": Laws(least=0.0),
        "max": Laws(least=0.0),
    },
)
DIMENSIONLESS_JERK = MetricComponent(
    spec=DimensionlessJerkSpec,
    build="crowdbot.plugins.metrics.motion_build:DimensionlessJerk",
    summary="DLJ: integral of the squared jerk, made free of duration and speed",
    experimental=True,
    label=ScoreLabel(
        metric="dimensionless_jerk",
        symbol="DLJ",
        category="motion",
        unit="1",
        better="lower",
    ),
    laws={
        "corrected": Laws(least=0.0),
    },
)

COMPONENTS = (
    TIME_NOT_MOVING,
    STALLED_TIME,
    CUMULATIVE_HEADING_CHANGE,
    PATH_IRREGULARITY,
    SPEED,
    ACCELERATION,
    JERK,
    DIMENSIONLESS_JERK,
)
