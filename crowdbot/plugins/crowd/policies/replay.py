"""Replay: people walk as recorded, or follow the record while avoiding others."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from crowdbot.plugin import (
    Asset,
    Component,
    CrowdPolicySpec,
    NonNegativeSteeringStiffness,
    PositiveDuration,
    default,
)


class ReplaySpec(CrowdPolicySpec):
    """Agents follow the recorded person with the same id.

    A crowd without flow, spawns and agents contains everyone in the record, each from its recorded
    start to its end. Without cost functions they ignore all obstacles; with cost functions they
    walk as in velocity_space, towards the person's recorded position ``ahead`` seconds later.
    """

    kind: Literal["replay"] = "replay"
    file: Asset = Field(description="CSV file with columns t (s), id, x, y (m).")
    ahead: PositiveDuration = default(
        1.0, "With cost functions: how far ahead of now the goal is, s."
    )
    contact_stiffness: NonNegativeSteeringStiffness = default(
        0.0, "Push between overlapping people and walls, 1/s^2."
    )

    @property
    def record(self) -> Asset:
        """Return the record, used if the crowd names no people."""
        return self.file


REPLAY = Component(
    spec=ReplaySpec,
    summary="recorded trajectories from a CSV file, as they were or reactive",
    examples=({"file": "people.csv"},),
    exceptions={
        "check_translation_invariant": "people walk where the record says",
        "check_rotation_equivariant": "people walk where the record says",
    },
)
