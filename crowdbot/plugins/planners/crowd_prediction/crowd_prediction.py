"""Crowd prediction: plans among people who are predicted by the crowd engine, robot included."""

from __future__ import annotations

from typing import Literal

from crowdbot.plugin import Component, PositiveDuration, default
from crowdbot.plugins.planners.people_mpc.people_mpc import PeopleMpcSpec, Weight, hurry_field


class CrowdPredictionSpec(PeopleMpcSpec):
    """Plans as `people_mpc`, among people who are predicted by the crowd engine.

    This prediction and constant velocity are weighted by how accurate each was in the last seconds.
    """

    kind: Literal["crowd_prediction"] = "crowd_prediction"  # type: ignore[assignment]
    hurry: Weight = hurry_field(0.0)
    crowd: str = default("calibrated", "Crowd by whose engine people are predicted.")
    settle_time: PositiveDuration = default(
        1.0, "Time over which a person's wanted velocity is averaged, s."
    )
    memory: PositiveDuration = default(
        5.0, "Time over which errors of earlier predictions count, s."
    )


CROWD_PREDICTION = Component(
    spec=CrowdPredictionSpec,
    summary="plans among people whom the crowd engine predicts on board, fitted to what is tracked",
)
