"""Metrics of distance to walls and contacts with them."""

from __future__ import annotations

from functools import partial
from typing import Literal

from crowdbot.plugin import MetricSpec, declare_metric
from crowdbot.plugins.metrics.parameters import ContactMetricSpec

declare = partial(declare_metric, category="wall", unit="m", better="higher")


class WallContactCountSpec(ContactMetricSpec):
    """Contacts of the robot with walls."""

    kind: Literal["wall_contact_count"] = "wall_contact_count"


WALL_CONTACT_COUNT = declare(
    WallContactCountSpec,
    symbol="WC",
    unit="1",
    better="lower",
    minimum=0.0,
    integer=True,
    variants=("recorded", "geometric"),
)


class MinWallClearanceSpec(MetricSpec):
    """Smallest distance between robot and walls."""

    kind: Literal["min_wall_clearance"] = "min_wall_clearance"


MIN_WALL_CLEARANCE = declare(MinWallClearanceSpec, symbol="WD_min")


class AvgWallClearanceSpec(MetricSpec):
    """Mean distance between robot and nearest wall."""

    kind: Literal["avg_wall_clearance"] = "avg_wall_clearance"


AVG_WALL_CLEARANCE = declare(AvgWallClearanceSpec, symbol="WD_avg")
