"""Corridor as plain geometry."""

from __future__ import annotations

import numpy as np

from crowdbot.core.interfaces import EnvironmentParts
from crowdbot.plugins.environments.corridor import CorridorSpec


def build(spec: CorridorSpec) -> EnvironmentParts:
    """Side walls reach as far as the portals; end walls exist for the robot alone."""
    half, length = 0.5 * spec.width, spec.length
    ends = [(p.x[0], p.x[1]) for p in spec.portals.values()]
    first = min([0.0, *(x0 for x0, _ in ends)])
    last = max([length, *(x1 for _, x1 in ends)])
    walls = np.array(
        [
            [first, -half, last, -half],
            [last, half, first, half],
            [0.0, half, 0.0, -half],
            [length, -half, length, half],
        ]
    )
    return EnvironmentParts(
        walls=walls,
        wall_heights=np.tile([0.0, spec.wall_height], (len(walls), 1)),
        stops_robot=np.ones(len(walls), np.bool_),
        stops_crowd=np.array([True, True, False, False]),
        zones={name: np.array(zone.polygon) for name, zone in spec.zones.items()},
        portals={name: (*box.x, *box.y) for name, box in spec.portals.items()},
    )
