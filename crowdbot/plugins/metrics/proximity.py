"""Metrics of the robot's distance to people."""

from __future__ import annotations

from functools import partial
from typing import Literal

from crowdbot.plugin import MetricSpec, declare_metric
from crowdbot.plugins.metrics.parameters import LengthTol, NeighbourRadius, ProximityFloor

declare = partial(declare_metric, category="proximity", minimum=0.0, better="none")


class ProximitySpec(MetricSpec):
    """Mean of the reciprocal distance to the nearest person."""

    kind: Literal["proximity"] = "proximity"
    proximity_floor: ProximityFloor
    length_tol: LengthTol


PROXIMITY = declare(
    ProximitySpec,
    symbol="P",
    spec_version=2,
    unit="1/m",
    better="lower",
    more_people="up",
    variants={
        "literal": {"refinement": "double"},
        "corrected": {"maximum": 10.0},
        "outline": {"maximum": 10.0},
    },
)


class NormalizedProximitySpec(MetricSpec):
    """Spread of the distances to the neighbours, over their mean."""

    kind: Literal["normalized_proximity"] = "normalized_proximity"
    neighbour_radius: NeighbourRadius
    length_tol: LengthTol


NORMALIZED_PROXIMITY = declare(
    NormalizedProximitySpec,
    symbol="P̂",
    unit="1",
    variants={"literal": {}, "corrected": {}, "barycentre": {"maximum": 1.0}},
)


class NeighbourCountSpec(MetricSpec):
    """Mean number of people near the robot."""

    kind: Literal["neighbour_count"] = "neighbour_count"
    neighbour_radius: NeighbourRadius


NEIGHBOUR_COUNT = declare(
    NeighbourCountSpec, symbol="n_N", unit="1", experimental=True, more_people="up"
)


class LocalDensitySpec(MetricSpec):
    """Mean number of people near the robot, per area."""

    kind: Literal["local_density"] = "local_density"
    neighbour_radius: NeighbourRadius


LOCAL_DENSITY = declare(
    LocalDensitySpec, symbol="ρ_N", unit="1/m²", experimental=True, more_people="up"
)
