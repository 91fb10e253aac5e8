"""Collision count: how often the robot and a person touch."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from crowdbot.core.component import Component
from crowdbot.dsl.base import MetricSpec
from crowdbot.dsl.quantities import NonNegativeLength, PositiveSpeed


class CollisionCountSpec(MetricSpec):
    """Contacts of the robot with people; walls are not counted."""

    kind: Literal["collision_count"] = "collision_count"
    contact_tol: NonNegativeLength = Field(
        default=1e-9, description="Surfaces this close touch, m."
    )
    release_gap: NonNegativeLength = Field(
        default=0.05, description="A contact ends when the surfaces are farther apart, m."
    )
    jump_speed: PositiveSpeed = Field(
        default=10.0, description="A faster step is a teleport where none are recorded, m/s."
    )


COLLISION_COUNT = Component(
    spec=CollisionCountSpec,
    build="crowdbot.plugins.metrics.collision_count_build:build",
    summary="C: contacts of the robot with people",
)
