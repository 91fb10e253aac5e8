"""Metrics of similarity between the robot's motion and that of people around it."""

from __future__ import annotations

from functools import partial
from typing import Literal

from crowdbot.plugin import MetricSpec, declare_metric
from crowdbot.plugins.metrics.parameters import HeadingMinSpeed, JumpSpeed, NeighbourRadius, ZeroTol

declare = partial(
    declare_metric,
    category="similarity",
    spec_version=2,
    unit="1",
    better="reference",
    variants=("literal", "corrected"),
)


class TimeToGoalSimilaritySpec(MetricSpec):
    """Time to goal of the robot, divided by that of people."""

    kind: Literal["time_to_goal_similarity"] = "time_to_goal_similarity"
    zero_tol: ZeroTol
    jump_speed: JumpSpeed


TIME_TO_GOAL_SIMILARITY = declare(TimeToGoalSimilaritySpec, symbol="Δ_ttg", minimum=0.0)


class PathLengthSimilaritySpec(MetricSpec):
    """Length of the robot's path, divided by that of people."""

    kind: Literal["path_length_similarity"] = "path_length_similarity"
    zero_tol: ZeroTol
    jump_speed: JumpSpeed


PATH_LENGTH_SIMILARITY = declare(PathLengthSimilaritySpec, symbol="Δ_L", minimum=0.0)


class HeadingSimilaritySpec(MetricSpec):
    """Turning rate of the robot, divided by that of people."""

    kind: Literal["heading_similarity"] = "heading_similarity"
    heading_min_speed: HeadingMinSpeed
    zero_tol: ZeroTol
    jump_speed: JumpSpeed


HEADING_SIMILARITY = declare(
    HeadingSimilaritySpec, symbol="Δ_θ", variants={"literal": {}, "corrected": {"minimum": 0.0}}
)


class VelocitySimilaritySpec(MetricSpec):
    """Speed of the robot, divided by that of people."""

    kind: Literal["velocity_similarity"] = "velocity_similarity"
    zero_tol: ZeroTol
    jump_speed: JumpSpeed


VELOCITY_SIMILARITY = declare(VelocitySimilaritySpec, symbol="Δ_v", minimum=0.0)


class NeighbourVelocitySimilaritySpec(MetricSpec):
    """Speed of the robot, divided by that of people near it."""

    kind: Literal["neighbour_velocity_similarity"] = "neighbour_velocity_similarity"
    neighbour_radius: NeighbourRadius
    zero_tol: ZeroTol
    jump_speed: JumpSpeed


NEIGHBOUR_VELOCITY_SIMILARITY = declare(
    NeighbourVelocitySimilaritySpec, symbol="Δ_v|N", minimum=0.0
)
