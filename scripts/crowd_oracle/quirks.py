"""Contact as the original limits it: nothing beyond the range of the policy pushes anybody."""

from __future__ import annotations

import numpy as np

from crowdbot.core.crowd.periodic_boundary import images
from crowdbot.core.types.arrays import Array
from scripts.crowd_oracle.case import Case


def push_out_of_reach(case: Case, state: Array, reach: Array) -> Array:
    """Return overlaps that the original ignores (N, 2), m, pointing away from the other body.

    Args:
        case: people, walls and border.
        state: (N, 4) x, y, vx, vy; NaN for absent agents.
        reach: (N,) largest range of each agent's policy, centre to centre, m.
    """
    radius = case.agents.radius
    largest = float(np.max(radius, initial=0.0))
    short = np.all(np.isfinite(state), axis=1) & (reach < radius + largest)
    found = np.zeros((len(state), 2))
    if not np.any(short):
        return found
    here = np.isfinite(state).all(axis=1)
    discs = np.column_stack([state, radius])[here]
    if case.periodic_boundary is not None:
        across = images(discs, case.periodic_boundary, 2.0 * largest, diagonal=False)
        discs = np.concatenate([discs, across])
    for i in np.flatnonzero(short):
        away = state[i, :2] - discs[:, :2]
        found[i] = _beyond(away, radius[i] + discs[:, 4], reach[i])
        found[i] += _beyond(state[i, :2] - _nearest(state[i, :2], case.walls), radius[i], reach[i])
    return found


def _nearest(point: Array, walls: Array) -> Array:
    """Return the points (S, 2) of walls (S, 4) nearest to a point."""
    start, along = walls[:, :2], walls[:, 2:] - walls[:, :2]
    share = np.sum((point - start) * along, axis=1) / np.sum(along * along, axis=1)
    return np.asarray(start + np.clip(share, 0.0, 1.0)[:, np.newaxis] * along)


def _beyond(away: Array, contact: Array | float, reach: float) -> Array:
    """Return the sum (2,) of overlaps whose distance is at least the reach."""
    distance = np.hypot(away[:, 0], away[:, 1])
    counts = (distance >= reach) & (distance < contact)
    depth = np.where(counts, contact - distance, 0.0) / np.where(counts, distance, 1.0)
    return np.asarray(np.sum(depth[:, np.newaxis] * away, axis=0))
