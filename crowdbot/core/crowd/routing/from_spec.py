"""Build path finding from a scenario."""

from __future__ import annotations

from crowdbot.core.crowd.routing.parameters import WayFinding
from crowdbot.dsl.scenario import routing as dsl
from crowdbot.dsl.scenario.crowd import Crowd
from crowdbot.dsl.scenario.seeds import stream_seed


def routing_of(crowd: Crowd) -> WayFinding | None:
    """Return path finding with draws of the stream "routing"; None: straight to the goals."""
    spec = crowd.routing
    if not isinstance(spec, dsl.MeshRouting):
        return None
    return WayFinding(
        spread=spec.spread,
        patience=spec.patience,
        detour=spec.detour,
        key=stream_seed(crowd.seed.root, crowd.seed.key, "crowd.routing"),
    )
