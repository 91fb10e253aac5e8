"""How near the robot comes to walls, and how often it touches them."""

from __future__ import annotations

from typing import Literal

from crowdbot.core.laws import Laws
from crowdbot.core.score_label import MetricComponent, ScoreLabel
from crowdbot.dsl.base import MetricSpec
from crowdbot.plugins.metrics.parameters import (
    ContactTol,
    JumpSpeed,
    ReleaseGap,
)


class WallContactCountSpec(MetricSpec):
    """Contacts of the robot with walls."""

    kind: Literal["wall_contact_count"] = "wall_contact_count"
    contact_tol: ContactTol = 1e-9
    release_gap: ReleaseGap = 0.05
    jump_speed: JumpSpeed = 10.0


class MinWallClearanceSpec(MetricSpec):
    """Least distance between robot and walls."""

    kind: Literal["min_wall_clearance"] = "min_wall_clearance"


class AvgWallClearanceSpec(MetricSpec):
    """Mean distance between robot and nearest wall."""

    kind: Literal["avg_wall_clearance"] = "avg_wall_clearance"


WALL_CONTACT_COUNT = MetricComponent(
    spec=WallContactCountSpec,
    build="crowdbot.plugins.metrics.walls_build:WallContactCount",
    summary="WC: contacts of the robot with walls",
    label=ScoreLabel(
        metric="wall_contact_count",
        symbol="WC",
        category="wall",
        unit="1",
        better="lower",
        variants=("recorded", "geometric"),
    ),
    laws={
        "recorded": Laws(whole=True, least=0.0),
        "geometric": Laws(whole=True, least=0.0),
    },
)
MIN_WALL_CLEARANCE = MetricComponent(
    spec=MinWallClearanceSpec,
    build="crowdbot.plugins.metrics.walls_build:MinWallClearance",
    summary="WD_min: least distance between robot and walls",
    label=ScoreLabel(
        metric="min_wall_clearance",
        symbol="WD_min",
        category="wall",
        unit="m",
        better="higher",
    ),
)
AVG_WALL_CLEARANCE = MetricComponent(
    spec=AvgWallClearanceSpec,
    build="crowdbot.plugins.metrics.walls_build:AvgWallClearance",
    summary="WD_avg: mean distance between robot and nearest wall",
    label=ScoreLabel(
        metric="avg_wall_clearance",
        symbol="WD_avg",
        category="wall",
        unit="m",
        better="higher",
    ),
)

COMPONENTS = (
    WALL_CONTACT_COUNT,
    MIN_WALL_CLEARANCE,
    AVG_WALL_CLEARANCE,
)
