"""Steering: the steering parts of a crowd."""

from __future__ import annotations

from dataclasses import dataclass, field

from crowdbot.dsl.scenario.steering import SteeringSpec


@dataclass(frozen=True, slots=True)
class Steering:
    """The steering parts of a crowd; those that the spec does not name are off.

    Attributes:
        key: of the counter-based draws of `wander`: the seed of the stream ``crowd.wander``.
    """

    spec: SteeringSpec = field(default_factory=SteeringSpec)
    key: int = 0
