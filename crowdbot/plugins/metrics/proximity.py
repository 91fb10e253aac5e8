"""How near the robot comes to people."""

from __future__ import annotations

from typing import Literal

from crowdbot.core.laws import Laws
from crowdbot.core.score_label import MetricComponent, ScoreLabel
from crowdbot.dsl.base import MetricSpec
from crowdbot.plugins.metrics.parameters import (
    LengthTol,
    NeighbourRadius,
    ProximityFloor,
)


class ProximitySpec(MetricSpec):
    """Mean of the reciprocal distance to the nearest person."""

    kind: Literal["proximity"] = "proximity"
    proximity_floor: ProximityFloor = 0.1
    length_tol: LengthTol = 1e-6


class NormalizedProximitySpec(MetricSpec):
    """Spread of the distances to the neighbours, over their mean."""

    kind: Literal["normalized_proximity"] = "normalized_proximity"
    neighbour_radius: NeighbourRadius = 3.0
    length_tol: LengthTol = 1e-6


class NeighbourCountSpec(MetricSpec):
    """Mean number of people near the robot."""

    kind: Literal["neighbour_count"] = "neighbour_count"
    neighbour_radius: NeighbourRadius = 3.0


class LocalDensitySpec(MetricSpec):
    """Mean number of people near the robot, per area."""

    kind: Literal["local_density"] = "local_density"
    neighbour_radius: NeighbourRadius = 3.0


PROXIMITY = MetricComponent(
    spec=ProximitySpec,
    build="crowdbot.plugins.metrics.proximity_build:Proximity",
    summary="P: mean of the reciprocal distance to the nearest person",
    label=ScoreLabel(
        metric="proximity",
        symbol="P",
        category="proximity",
        unit="1/m",
        better="lower",
        variants=("literal", "corrected"),
    ),
    laws={
        "literal": Laws(least=0.0, more_people="up", finer="double"),
        "corrected": Laws(least=0.0, most=10.0, more_people="up"),
    },
)
NORMALIZED_PROXIMITY = MetricComponent(
    spec=NormalizedProximitySpec,
    build="crowdbot.plugins.metrics.proximity_build:NormalizedProximity",
    summary="P̂: spread of the distances to the neighbours, over their mean",
    label=ScoreLabel(
        metric="normalized_proximity",
        symbol="P̂",
        category="proximity",
        unit="1",
        better="none",
        variants=("literal", "corrected", "barycentre"),
    ),
    laws={
        "literal": Laws(least=0.0),
        "corrected": Laws(least=0.0),
        "barycentre": Laws(least=0.0, most=1.0),
    },
)
NEIGHBOUR_COUNT = MetricComponent(
    spec=NeighbourCountSpec,
    build="crowdbot.plugins.metrics.proximity_build:NeighbourCount",
    summary="n_N: mean number of people near the robot",
    experimental=True,
    label=ScoreLabel(
        metric="neighbour_count",
        symbol="n_N",
        category="proximity",
        unit="1",
        better="none",
    ),
    laws={
        "corrected": Laws(least=0.0, more_people="up"),
    },
)
LOCAL_DENSITY = MetricComponent(
    spec=LocalDensitySpec,
    build="crowdbot.plugins.metrics.proximity_build:LocalDensity",
    summary="ρ_N: mean number of people near the robot, per area",
    experimental=True,
    label=ScoreLabel(
        metric="local_density",
        symbol="ρ_N",
        category="proximity",
        unit="1/m²",
        better="none",
    ),
    laws={
        "corrected": Laws(least=0.0, more_people="up"),
    },
)

COMPONENTS = (
    PROXIMITY,
    NORMALIZED_PROXIMITY,
    NEIGHBOUR_COUNT,
    LOCAL_DENSITY,
)
