"""Steering of a world, from the field ``crowd.steering``."""

from __future__ import annotations

from dataclasses import fields
from typing import Any

from crowdbot.core.crowd.steering.parameters import (
    LaneKeeping,
    PersonalSpace,
    Steering,
    TimeGap,
    WallPush,
    Wander,
)
from crowdbot.dsl.scenario.steering import SteeringSpec

_PARTS: dict[str, type[Any]] = {
    "time_gap": TimeGap,
    "personal_space": PersonalSpace,
    "lanes": LaneKeeping,
    "wall_push": WallPush,
    "wander": Wander,
}


def steering_of(spec: SteeringSpec | None, key: int = 0) -> Steering:
    """The steering that a spec describes; units are those of its fields.

    Args:
        spec: None has no part.
        key: of the random numbers of `Wander`: the seed of the stream ``crowd.wander``.
    """
    found = {}
    for name, made in _PARTS.items():
        part = getattr(spec, name, None)
        if part is None:
            continue
        values = {f.name: getattr(part, f.name) for f in fields(made) if f.name != "key"}
        found[name] = made(**values, **({"key": key} if made is Wander else {}))
    return Steering(**found)
