"""Floor as plain geometry."""

from __future__ import annotations

from crowdbot.plugin import EnvironmentParts, place_parts
from crowdbot.plugins.environments.floor import FloorSpec


def build(spec: FloorSpec) -> EnvironmentParts:
    """Border walls face inwards; the outlines of solids face outwards."""
    return place_parts(spec, spec.place())
