"""Discs and headings of all people, sorted by x, for the steering parts."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from crowdbot.core.crowd.policy import CrowdView
from crowdbot.core.crowd.velocity_search.neighbour_discs import (
    most_discs,
    write_discs,
)
from crowdbot.core.crowd.velocity_search.neighbours import DISC, DiscRecord
from crowdbot.core.support.compiling.compile import array_kernel, kernel
from crowdbot.core.support.records import Rows
from crowdbot.core.types.arrays import Array, Indices, Mask

#: Centres farther apart do not affect any part, m.
REACH = 3.0
#: Slower people face their goal rather than their motion, m/s.
_SLOW = 0.3


class SortedDiscs(NamedTuple):
    """All discs at one decision; world frame, SI units.

    Attributes:
        discs: (D,) people, images across a border, robots and pillars, by x.
        row: (N,) row of each person in ``discs``, -1 for absent ones.
        heading: (N, 2) unit vectors between the directions to the goal and of walking.
        decides: (N,) True for people with steering.
    """

    discs: Rows[DiscRecord]
    row: Indices
    heading: Array
    decides: Mask


def sorted_discs(view: CrowdView) -> SortedDiscs:
    """Return the discs at the decision of a view."""
    agents, boundary = view.agents, view.periodic_boundary
    fixed = len(view.robot) + len(view.pillars)
    room = most_discs(len(view.position), fixed, boundary is not None)
    discs: Any = np.zeros(room, DISC)
    box = np.array(boundary if boundary is not None else (0.0, 0.0, 0.0, 0.0))
    count = write_discs(
        view.position, view.velocity, view.goal, agents.avoided_radius, agents.preferred_speed,
        view.present, view.robot, view.pillars, box, view.diagonal, REACH, discs,
    )  # fmt: skip
    discs = discs[:count]
    discs = discs[np.argsort(discs["x"], kind="stable")]
    row = np.full(len(view.position), -1, np.int64)
    of = discs["index"].astype(np.int64)
    row[of[of >= 0]] = np.flatnonzero(of >= 0)
    heading = np.zeros_like(view.position)
    face(view.position, view.velocity, view.goal, heading)
    decides = view.present if view.decides is None else view.present & view.decides
    return SortedDiscs(discs, row, heading, decides)


@array_kernel
def face(position: Array, velocity: Array, goal: Array, heading: Array) -> None:
    """Write headings: half towards the goal and half along the velocity."""
    for i in range(position.shape[0]):
        gx, gy = goal[i, 0] - position[i, 0], goal[i, 1] - position[i, 1]
        away, speed = math.hypot(gx, gy), math.hypot(velocity[i, 0], velocity[i, 1])
        gx, gy = (gx / away, gy / away) if away > 0.0 else (0.0, 0.0)
        x = gx + velocity[i, 0] / max(speed, _SLOW)
        y = gy + velocity[i, 1] / max(speed, _SLOW)
        size = math.hypot(x, y)
        if size < 1e-9:  # straight away from the goal: the goal decides
            x, y, size = gx, gy, math.hypot(gx, gy)
        if size > 0.0:
            heading[i, 0], heading[i, 1] = x / size, y / size


@kernel
def first_within(discs: Rows[DiscRecord], a: int, reach: float) -> int:
    """Return the first row whose x is within ``reach`` (m) of row a."""
    low = discs[a].x - reach
    while a > 0 and discs[a - 1].x >= low:
        a -= 1
    return a
