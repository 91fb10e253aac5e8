"""Individual appearances of people to sensors: stride, wheelchairs, pushed objects.

All are upright cylinders, as in `crowdbot.core.sensing.body_model`. For the sources of the sizes,
see docs/reference/people.md.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.sensing.body_model import (
    BOTTOM,
    PARTS,
    RADIUS,
    TOP,
    TRUNK,
    X,
    Y,
    place_people,
)
from crowdbot.core.support.compiling.compile import kernel
from crowdbot.core.types.appearance import Appearance
from crowdbot.core.types.arrays import Array

#: Columns of a gait: height of the hip, length of a stride, phase at the start, swing of the legs
#: relative to the default, their offset ahead of the centre; m and rad.
_HIP, _STRIDE, _PHASE, _SWING, _AHEAD = range(5)
#: Columns of an object: its owner; position ahead and to the left; radius, bottom, top; m.
_OWNER, _FORWARD, _LEFT, _RADIUS, _BOTTOM, _TOP = range(6)
_USUAL_HIP, _USUAL_STRIDE = 0.53, 0.83  # share of the height
_USUAL_SWING, _FULL_SWING_SPEED, _USUAL_DISC = 0.19, 0.6, 0.33  # m, m/s, m
_APART = 0.5 * 0.191 * 0.9  # share of the height

#: Objects of each look: ahead, to the left, radius, bottom, top; m.
_THINGS: dict[str, tuple[tuple[float, float, float, float, float], ...]] = {
    "wheelchair_user": ((0.0, 0.0, 0.31, 0.0, 0.60),),
    "stroller": ((0.75, 0.0, 0.27, 0.05, 1.00),),
    "suitcase": ((-0.55, -0.15, 0.18, 0.0, 0.60),),
}
#: Swing and forward offset of legs that do not walk normally.
_LEGS = {"wheelchair_user": (0.0, 0.38), "elderly": (0.8, 0.0)}
_SEAT = 0.50  # m: bottom of a sitting person's trunk


def heights(appearance: Appearance, usual: float) -> Array:
    """Return heights (M,), m; default if unknown."""
    found: Array = np.where(appearance.height > 0.0, appearance.height, usual)
    return found


def gaits(appearance: Appearance, height: Array) -> Array:
    """Return hip height (m), stride (m), phase, swing and lead of people's legs (M, 5)."""
    found = np.zeros((len(height), 5))
    for i, (look, tall) in enumerate(zip(appearance.look, height.tolist(), strict=True)):
        hip = appearance.leg_length[i] or _USUAL_HIP * tall
        swing, ahead = _LEGS.get(look, (1.0, 0.0))
        stride = hip * _USUAL_STRIDE / _USUAL_HIP * (swing or 1.0)
        seat = _SEAT if look == "wheelchair_user" else hip
        found[i] = seat, stride, appearance.phase[i], swing, ahead
    return found


def things(appearance: Appearance) -> Array:
    """Return people's objects (T, 6): index of the person, then columns as in `_THINGS`."""
    rows = [
        (i, *thing) for i, look in enumerate(appearance.look) for thing in _THINGS.get(look, ())
    ]
    return np.array(rows, dtype=np.float64).reshape(-1, 6)


@kernel
def place_looks(
    people: Array,
    present: NDArray[np.bool_],
    direction: Array,
    walked: Array,
    radius: Array,
    height: Array,
    gait: Array,
    out: Array,
) -> None:
    """Write the cylinders of people with individual gaits, see `place_people`.

    Args:
        people, present, direction, walked, radius, height: as there.
        gait: (M, 5), see `gaits`.
        out: (M * 3 + ..., 5) two legs and a trunk each; further rows are unchanged.
    """
    place_people(people, present, direction, walked, radius, height, out)
    for i in range(people.shape[0]):
        if not present[i]:
            continue
        row, scale = PARTS * i, min(1.0, radius[i] / _USUAL_DISC)
        speed = math.hypot(people[i, 2], people[i, 3])
        swing = _USUAL_SWING * scale * min(1.0, speed / _FULL_SWING_SPEED) * gait[i, _SWING]
        swing *= min(1.0, gait[i, _HIP] / (_USUAL_HIP * 1.7))
        swing *= math.sin(2.0 * math.pi * walked[i] / gait[i, _STRIDE] + gait[i, _PHASE])
        fx, fy, apart = direction[i, 0], direction[i, 1], _APART * height[i] * scale
        for k in range(2):
            side = 1.0 - 2.0 * k
            forward = side * swing + gait[i, _AHEAD]
            out[row + k, X] = people[i, 0] + forward * fx - side * apart * fy
            out[row + k, Y] = people[i, 1] + forward * fy + side * apart * fx
            out[row + k, TOP] = gait[i, _HIP]
        out[row + TRUNK, BOTTOM] = gait[i, _HIP]


@kernel
def place_things(
    people: Array,
    present: NDArray[np.bool_],
    direction: Array,
    owned: Array,
    first: int,
    out: Array,
) -> None:
    """Write the cylinders of people's objects; those of absent people are at infinity.

    Args:
        owned: (T, 6), see `things`.
        first: first row of ``out`` for them.
    """
    for t in range(owned.shape[0]):
        i, row = int(owned[t, _OWNER]), first + t
        if not present[i]:
            out[row, X] = out[row, Y] = math.inf
            out[row, RADIUS] = out[row, BOTTOM] = out[row, TOP] = 0.0
            continue
        fx, fy = direction[i, 0], direction[i, 1]
        ahead, left = owned[t, _FORWARD], owned[t, _LEFT]
        out[row, X] = people[i, 0] + ahead * fx - left * fy
        out[row, Y] = people[i, 1] + ahead * fy + left * fx
        out[row, RADIUS] = owned[t, _RADIUS]
        out[row, BOTTOM], out[row, TOP] = owned[t, _BOTTOM], owned[t, _TOP]
