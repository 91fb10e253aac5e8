"""JuPedSim: two models of this library as a crowd policy.

Sources: Tordeux, Chraibi, Seyfried, "Collision-free speed model for pedestrian dynamics", Traffic
and Granular Flow 2015; Xu, Chraibi, Seyfried, "Anticipation in a velocity-based model for
pedestrian dynamics", Transportation Research C 133, 2021.
"""

from __future__ import annotations

from typing import Literal

from crowdbot.plugin import (
    Component,
    CrowdPolicySpec,
    NonNegativeSteeringStiffness,
    PositiveDuration,
    PositiveLength,
    default,
)


class JuPedSimSpec(CrowdPolicySpec):
    """People decide as in JuPedSim; needs ``crowdbot[jupedsim]``. Takes no cost functions.

    Parameters without a field here have the library's defaults.
    """

    kind: Literal["jupedsim"] = "jupedsim"
    model: Literal["collision_free_speed", "anticipation_velocity"] = default(
        "collision_free_speed", "Which of the library's models."
    )
    time_gap: PositiveDuration = default(1.06, "Time to the person in front that people keep, s.")
    time_step: PositiveDuration = default(0.015625, "Step of the library within a decision, s.")
    sight: PositiveLength = default(10.0, "On a torus: how far people see across the border, m.")
    contact_stiffness: NonNegativeSteeringStiffness = default(
        62.5, "Push between overlapping people and walls, 1/s^2."
    )


JUPEDSIM = Component(
    spec=JuPedSimSpec,
    summary="collision-free-speed and anticipation-velocity models of JuPedSim",
    examples=({}, {"model": "anticipation_velocity"}),
    exceptions={
        "check_translation_invariant": "answers of the library differ by up to 0.008 m/s^2",
        "check_rotation_equivariant": "answers of the library differ by up to 0.06 m/s^2",
    },
)
