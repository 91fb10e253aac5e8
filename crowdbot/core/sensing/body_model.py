"""People as sensors see them: two walking legs and a trunk, all upright cylinders.

Proportions of an adult of height H after Winter, "Biomechanics and Motor Control of Human Movement"
(2009), figure 4.1: hip at 0.53 H, hip breadth 0.191 H, shoulder breadth 0.259 H. A leg swings as
the sine of the distance walked, with a stride of 0.83 H (1.41 m for 1.7 m). Bodies thinner than the
default disc of 0.33 m are scaled, so that legs stay within the contact disc.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.support.compiling.compile import kernel
from crowdbot.core.types.arrays import Array

LEGS, TRUNK = (0, 1), 2
PARTS = 3
#: Columns of a disc: centre x, y, radius, bottom, top (m).
X, Y, RADIUS, BOTTOM, TOP = range(5)
DISC_COLUMNS = 5

_HIP, _STRIDE = 0.53, 0.83  # share of the height
_APART, _TRUNK_RADIUS = 0.5 * 0.191 * 0.9, 0.5 * 0.259  # share of the height
_LEG_RADIUS = 0.07  # m
_SWING = 0.19  # m, largest distance of a leg before and behind the trunk
_FULL_SWING_SPEED = 0.6  # m/s; slower people take shorter steps
_USUAL_DISC = 0.33  # m


def trunk_radius(height: Array, radius: Array) -> Array:
    """Return the radius of trunks (M,) from heights and contact discs, m."""
    radii: Array = _TRUNK_RADIUS * height * np.minimum(1.0, radius / _USUAL_DISC)
    return radii


@kernel
def place_people(
    people: Array,
    present: NDArray[np.bool_],
    direction: Array,
    walked: Array,
    radius: Array,
    height: Array,
    out: Array,
) -> None:
    """Write the discs of all people; those of absent people are at infinity.

    Args:
        people: (M, 4) x, y, vx, vy; m, m/s.
        present: (M,).
        direction: (M, 2) unit vectors of people's facing direction.
        walked: (M,) distance walked, m, which is the phase of the legs.
        radius, height: (M,) contact disc and height, m.
        out: (M * 3, 5) two legs and a trunk each.
    """
    for i in range(people.shape[0]):
        row = PARTS * i
        if not present[i]:
            for k in range(PARTS):
                out[row + k, X] = out[row + k, Y] = math.inf
                out[row + k, RADIUS] = out[row + k, BOTTOM] = out[row + k, TOP] = 0.0
            continue
        h, scale = height[i], min(1.0, radius[i] / _USUAL_DISC)
        hip, apart = _HIP * h, _APART * h * scale
        speed = math.hypot(people[i, 2], people[i, 3])
        swing = _SWING * scale * min(1.0, speed / _FULL_SWING_SPEED)
        swing *= math.sin(2.0 * math.pi * walked[i] / (_STRIDE * h))
        fx, fy = direction[i, 0], direction[i, 1]
        for k in range(2):
            side = 1.0 - 2.0 * k
            out[row + k, X] = people[i, 0] + side * (swing * fx - apart * fy)
            out[row + k, Y] = people[i, 1] + side * (swing * fy + apart * fx)
            out[row + k, RADIUS] = _LEG_RADIUS * scale
            out[row + k, BOTTOM], out[row + k, TOP] = 0.0, hip
        out[row + TRUNK, X], out[row + TRUNK, Y] = people[i, 0], people[i, 1]
        out[row + TRUNK, RADIUS] = _TRUNK_RADIUS * h * scale
        out[row + TRUNK, BOTTOM], out[row + TRUNK, TOP] = hip, h
