"""Build the corridor's geometry."""

from __future__ import annotations

from crowdbot.plugin import EnvironmentParts, place_parts
from crowdbot.plugins.environments.corridor import CorridorSpec


def build(spec: CorridorSpec) -> EnvironmentParts:
    """Return side walls, end walls and pillars."""
    return place_parts(spec, spec.place())
