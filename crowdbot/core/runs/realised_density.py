"""The realised number of people in a run, compared with the scenario."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.core.types.arrays import Array
from crowdbot.core.types.environment import EnvironmentParts
from crowdbot.dsl.scenario.scenario import Scenario


def mean_density(run: Trajectories, scenario: Scenario, parts: EnvironmentParts) -> float | None:
    """Return the mean density of people in the crowd's area over the samples, 1/m².

    The area is the zone in which a flow starts; without a flow the periodic floor, or the rectangle
    around all walls.

    Args:
        run: a run with people, world frame.

    Returns:
        None without people or area.
    """
    outline = _outline(scenario, parts)
    if run.agents is None or outline is None or not run.agents.x.size:
        return None
    area = _area(outline)
    if not area > 0.0:
        return None
    inside = inside_polygon(run.agents.x, run.agents.y, outline)
    return float(inside.sum(axis=1).mean() / area)


def inside_polygon(x: Array, y: Array, corners: Array) -> NDArray[np.bool_]:
    """Return a mask of points inside a polygon (K, 2), by the even-odd rule; False for NaN."""
    inside = np.zeros(x.shape, np.bool_)
    for (x0, y0), (x1, y1) in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        if y0 != y1:
            between = (y0 > y) != (y1 > y)
            inside ^= between & (x < x0 + (y - y0) * ((x1 - x0) / (y1 - y0)))
    return inside


def _outline(scenario: Scenario, parts: EnvironmentParts) -> Array | None:
    crowd = scenario.crowd
    if crowd is not None and crowd.flow is not None:
        return np.asarray(parts.zones[crowd.flow.area], np.float64)
    if parts.periodic_boundary is not None:
        x0, x1, y0, y1 = parts.periodic_boundary
    elif len(parts.walls):
        ends = parts.walls.reshape(-1, 2)
        (x0, y0), (x1, y1) = ends.min(axis=0), ends.max(axis=0)
    else:
        return None
    return np.array([(x0, y0), (x1, y0), (x1, y1), (x0, y1)], np.float64)


def _area(corners: Array) -> float:
    """Return the area of a simple polygon, m² (shoelace formula)."""
    x, y = corners.T
    return float(abs(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y)) / 2.0)
