"""Build the floor's geometry."""

from __future__ import annotations

from crowdbot.plugin import EnvironmentParts, place_parts
from crowdbot.plugins.environments.floor import FloorSpec


def build(spec: FloorSpec) -> EnvironmentParts:
    """Return the parts: border walls face inwards, outlines of solids face outwards."""
    return place_parts(spec, spec.place())
