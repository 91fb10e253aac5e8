"""Replay: people walk as they were recorded, or are drawn along by the record."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from crowdbot.plugin import (
    Asset,
    Component,
    CrowdPolicySpec,
    NonNegativeSteeringStiffness,
    PositiveDuration,
)


class ReplaySpec(CrowdPolicySpec):
    """Agents follow the recorded person with their id.

    A crowd without flow, spawns and agents is everybody in the record, from where and when each
    begins to where it ends. Without cost functions they do so whatever is in their way; with cost
    functions they are walkers of velocity_space, on the way to where the person was ``ahead``
    later.
    """

    kind: Literal["replay"] = "replay"
    file: Asset = Field(description="CSV file with columns t (s), id, x, y (m).")
    ahead: PositiveDuration = Field(
        default=1.0, description="With cost functions: how far ahead of now the goal is, s."
    )
    contact_stiffness: NonNegativeSteeringStiffness = Field(
        default=0.0, description="Push between overlapping people and walls, 1/s^2."
    )

    @property
    def record(self) -> Asset:
        """The people in the file walk where the crowd names nobody."""
        return self.file


REPLAY = Component(
    spec=ReplaySpec,
    build="crowdbot.plugins.crowd.policies.replay_build:build",
    summary="recorded trajectories from a CSV file, as they were or reactive",
    examples=({"file": "people.csv"},),
    exceptions={
        "check_translation_invariant": "people walk where the record says",
        "check_rotation_equivariant": "people walk where the record says",
    },
)
