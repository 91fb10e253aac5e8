"""How much the robot moves like the people around it."""

from __future__ import annotations

from typing import Literal

from crowdbot.core.laws import Laws
from crowdbot.core.score_label import MetricComponent, ScoreLabel
from crowdbot.dsl.base import MetricSpec
from crowdbot.plugins.metrics.parameters import (
    HeadingMinSpeed,
    JumpSpeed,
    NeighbourRadius,
    ZeroTol,
)


class TimeToGoalSimilaritySpec(MetricSpec):
    """Time to goal of the robot, over the one of people."""

    kind: Literal["time_to_goal_similarity"] = "time_to_goal_similarity"
    zero_tol: ZeroTol = 1e-9
    jump_speed: JumpSpeed = 10.0


class PathLengthSimilaritySpec(MetricSpec):
    """Length of the robot's path, over the one of people."""

    kind: Literal["path_length_similarity"] = "path_length_similarity"
    zero_tol: ZeroTol = 1e-9
    jump_speed: JumpSpeed = 10.0


class HeadingSimilaritySpec(MetricSpec):
    """Turning rate of the robot, over the one of people."""

    kind: Literal["heading_similarity"] = "heading_similarity"
    heading_min_speed: HeadingMinSpeed = 0.1
    zero_tol: ZeroTol = 1e-9
    jump_speed: JumpSpeed = 10.0


class VelocitySimilaritySpec(MetricSpec):
    """Speed of the robot, over the one of people."""

    kind: Literal["velocity_similarity"] = "velocity_similarity"
    zero_tol: ZeroTol = 1e-9
    jump_speed: JumpSpeed = 10.0


class NeighbourVelocitySimilaritySpec(MetricSpec):
    """Speed of the robot, over the one of people near it."""

    kind: Literal["neighbour_velocity_similarity"] = "neighbour_velocity_similarity"
    neighbour_radius: NeighbourRadius = 3.0
    zero_tol: ZeroTol = 1e-9
    jump_speed: JumpSpeed = 10.0


TIME_TO_GOAL_SIMILARITY = MetricComponent(
    spec=TimeToGoalSimilaritySpec,
    build="crowdbot.plugins.metrics.similarity_build:TimeToGoalSimilarity",
    summary="Δ_ttg: time to goal of the robot, over the one of people",
    label=ScoreLabel(
        metric="time_to_goal_similarity",
        symbol="Δ_ttg",
        category="similarity",
        unit="1",
        better="reference",
        variants=("literal", "corrected"),
    ),
    laws={
        "literal": Laws(least=0.0),
        "corrected": Laws(least=0.0),
    },
)
PATH_LENGTH_SIMILARITY = MetricComponent(
    spec=PathLengthSimilaritySpec,
    build="crowdbot.plugins.metrics.similarity_build:PathLengthSimilarity",
    summary="Δ_L: length of the robot's path, over the one of people",
    label=ScoreLabel(
        metric="path_length_similarity",
        symbol="Δ_L",
        category="similarity",
        unit="1",
        better="reference",
        variants=("literal", "corrected"),
    ),
    laws={
        "literal": Laws(least=0.0),
        "corrected": Laws(least=0.0),
    },
)
HEADING_SIMILARITY = MetricComponent(
    spec=HeadingSimilaritySpec,
    build="crowdbot.plugins.metrics.similarity_build:HeadingSimilarity",
    summary="Δ_θ: turning rate of the robot, over the one of people",
    label=ScoreLabel(
        metric="heading_similarity",
        symbol="Δ_θ",
        category="similarity",
        unit="1",
        better="reference",
        variants=("literal", "corrected"),
    ),
    laws={
        "corrected": Laws(least=0.0),
    },
)
VELOCITY_SIMILARITY = MetricComponent(
    spec=VelocitySimilaritySpec,
    build="crowdbot.plugins.metrics.similarity_build:VelocitySimilarity",
    summary="Δ_v: speed of the robot, over the one of people",
    label=ScoreLabel(
        metric="velocity_similarity",
        symbol="Δ_v",
        category="similarity",
        unit="1",
        better="reference",
        variants=("literal", "corrected"),
    ),
    laws={
        "literal": Laws(least=0.0),
        "corrected": Laws(least=0.0),
    },
)
NEIGHBOUR_VELOCITY_SIMILARITY = MetricComponent(
    spec=NeighbourVelocitySimilaritySpec,
    build="crowdbot.plugins.metrics.similarity_build:NeighbourVelocitySimilarity",
    summary="Δ_v|N: speed of the robot, over the one of people near it",
    label=ScoreLabel(
        metric="neighbour_velocity_similarity",
        symbol="Δ_v|N",
        category="similarity",
        unit="1",
        better="reference",
        variants=("literal", "corrected"),
    ),
    laws={
        "literal": Laws(least=0.0),
        "corrected": Laws(least=0.0),
    },
)

COMPONENTS = (
    TIME_TO_GOAL_SIMILARITY,
    PATH_LENGTH_SIMILARITY,
    HEADING_SIMILARITY,
    VELOCITY_SIMILARITY,
    NEIGHBOUR_VELOCITY_SIMILARITY,
)
