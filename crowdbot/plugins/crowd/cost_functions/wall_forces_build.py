"""Forces of walls, each by its nearest point, added in turn to the last bit of the sum."""

from __future__ import annotations

import math

import numpy as np

from crowdbot.plugin import (
    AgentRecord,
    CostParams,
    Pointer,
    Rows,
    WallRecord,
    array_kernel,
    as_record,
    in_range,
    record_type,
)
from crowdbot.plugin.for_crowds import write_nearest_points
from crowdbot.plugins.crowd.cost_functions.wall_points_build import clear_table, is_known, repeats

CLOSEST = 0.001  # m; nothing nearer exerts a force
#: A force exp(_LOST) times weaker than a sum is lost when it is added: half of its last bit is at
#: least 2^-54 of it, and exponentials are exact to much less than the other half.
_LOST = 55.0 * math.log(2.0)
#: The bound of a sum is set this much below it, and again if the sum is so much above the bound.
_SMALLER, _LARGER = 0.5, 16.0
#: Equal points have equal squared distances, but for rounding and `SAME_POINT`.
_BEFORE = 1.0 - 1e-6
#: Walls are first looked up to this many times their reach r.
_REACHES = 52.0
#: Forces of walls farther away than this many times r are bounded, not computed.
_FARTHEST = 64.0
#: Largest relative error of a force by `_nearly_exp`, the exact one's included: five roundings of
#: up to `_FARTHEST` in the exponents, and some last bits.
_ERROR = 2.0**-44
_LOG2_E = 1.0 / math.log(2.0)
#: Coefficients of 2^x: its series, with a remainder below 2^-52 for |x| <= 1/2.
_SERIES = tuple(math.log(2.0) ** k / math.factorial(k) for k in range(13))
#: Added to a number below 2^51, leaves the nearest integer in the last bits of the sum.
_ROUND = 1.5 * 2.0**52


class WallParams(CostParams):
    """Parameters of the forces of walls, with which a function's own begin.

    Attributes:
        u0: strength, m^2/s^2.
        r: length in which they fade, m.
    """

    u0: float
    r: float


_WALL_PARAMS = record_type(WallParams)


def looked_up_to(r: float, within: float) -> float:
    """Return the distance up to which `add_points` looks up points, m; 0 if it cannot be used.

    Args:
        r: length in which forces fade, m.
        within: range of the function, m. Points beyond must not matter to `add_points`.
    """
    return _REACHES * r if _FARTHEST * r <= within else 0.0


@array_kernel
def wall_force(
    yx: float, yy: float, distance: float, parity: bool, params: Pointer
) -> tuple[float, ...]:
    """Return the force per mass from a wall point; y points from it to the agent."""
    own = as_record(params, _WALL_PARAMS)
    if distance < CLOSEST:
        return 0.0, 0.0
    size = own.u0 / own.r * math.exp(-distance / own.r)
    if not parity:
        size /= distance
    return size * yx, size * yy


@array_kernel
def _lost_beyond(least: float, params: Pointer) -> float:
    """Return the distance (m) beyond which walls do not change a sum of ``least`` m/s^2 or more."""
    own = as_record(params, _WALL_PARAMS)
    if least <= 0.0 or own.u0 <= 0.0:
        return math.inf
    return float(max(0.0, own.r * (math.log(own.u0 / own.r / least) + _LOST)))


@array_kernel
def add_walls(
    fx: float, fy: float, agent: AgentRecord, walls: Rows[WallRecord], wall_count: int,
    params: Pointer, work: Pointer,
) -> tuple[float, float]:  # fmt: skip
    """Add the forces of walls in turn; leave out those that are lost in the sum as it is then.

    A wall that is left out may have the nearest point of a later one, which does not count then.
    """
    size = clear_table(0, wall_count, work)
    # The sum is at least ``least`` in both directions, and beyond ``far`` walls are lost in that.
    least = _SMALLER * min(abs(fx), abs(fy))
    far = _lost_beyond(least, params)
    left_out = math.inf
    for s in range(wall_count):
        d2 = walls[s].d2
        if d2 > far * far:
            left_out = min(left_out, d2)
            continue
        if not in_range(d2, agent.radius, params) or is_known(walls, s, 0, size, work):
            continue
        if d2 > _BEFORE * left_out and repeats(walls, s):
            continue
        push = wall_force(-walls[s].nx, -walls[s].ny, math.sqrt(d2), False, params)
        fx, fy = fx + push[0], fy + push[1]
        now = min(abs(fx), abs(fy))
        if now < least or now > _LARGER * least:
            least = _SMALLER * now
            far = _lost_beyond(least, params)
    return fx, fy


@array_kernel
def _nearly_exp(x: float) -> float:
    """Return e^x for -700 < x <= 0, nearly; unlike `math.exp`, for many numbers at once."""
    doublings = x * _LOG2_E
    shifted = doublings + _ROUND
    rest = doublings - (shifted - _ROUND)
    c, total = _SERIES, _SERIES[12]
    total = c[8] + rest * (c[9] + rest * (c[10] + rest * (c[11] + rest * total)))
    total = c[4] + rest * (c[5] + rest * (c[6] + rest * (c[7] + rest * total)))
    total = c[0] + rest * (c[1] + rest * (c[2] + rest * (c[3] + rest * total)))
    bits = np.float64(shifted).view(np.int64)
    return total * np.int64((bits + 1023) << 52).view(np.float64)


@array_kernel
def add_points(
    fx: float, fy: float, agent: AgentRecord, params: Pointer, work: Pointer
) -> tuple[bool, float, float]:
    """Add the forces of walls in turn as `add_walls`, by points that are looked up.

    Bounds of the sum are added up, from bounds of the forces: as additions round both in the same
    direction, a later and larger force makes them equal. Where it could not, the exact force is
    computed. So equal bounds at the end are the sum of all exact forces, to the last bit.

    Returns:
        True, and the sum, m/s^2; False if its bounds differ.
    """
    own = as_record(params, _WALL_PARAMS)
    count, within, others = write_nearest_points(agent, work)
    rate, strength = -1.0 / own.r, own.u0 / own.r
    for k in range(count):  # without branches, so that it vectorises
        x, y, counts = work[k], work[count + k], work[2 * count + k]
        d = math.sqrt(x * x + y * y)
        size = counts * strength * _nearly_exp(max(rate * d, -_FARTHEST)) / d
        work[2 * count + k] = size if (d >= CLOSEST) & (rate * d >= -_FARTHEST) else 0.0
    most, least = strength * math.exp(rate * within), strength * math.exp(-_FARTHEST)
    # Rounding may double what each of them changes.
    rest = 2.1 * (others * most + count * least)
    small = 2.0**55 * max(most, least) if rest > 0.0 else 0.0
    ax, bx, x_is_small = _widened(fx, fx, False, rest, small)
    ay, by, y_is_small = _widened(fy, fy, False, rest, small)
    for k in range(count):
        x, y, size = -work[k], -work[count + k], work[2 * count + k]
        px, py = size * x, size * y
        ex, ey = _ERROR * abs(px), _ERROR * abs(py)
        x0, x1, y0, y1 = ax + (px - ex), bx + (px + ex), ay + (py - ey), by + (py + ey)
        if (x0 != x1 and ex > rest) or (y0 != y1 and ey > rest):
            px, py = wall_force(x, y, math.sqrt(x * x + y * y), False, params)
            x0, x1, y0, y1 = ax + px, bx + px, ay + py, by + py
        ax, bx, x_is_small = _widened(x0, x1, x_is_small, rest, small)
        ay, by, y_is_small = _widened(y0, y1, y_is_small, rest, small)
    return ax == bx and ay == by, ax, ay


@array_kernel
def _widened(
    low: float, high: float, was_small: bool, rest: float, small: float
) -> tuple[float, float, bool]:
    """Return bounds of a sum to which forces that are not known may be added anywhere.

    Args:
        low, high: bounds of the sum of the known forces so far.
        was_small: the third result at the last force.
        rest: bound of the sum of those that are not known.
        small: in a sum of this size or more they are lost.

    Returns:
        bounds of the sum, with the unknown forces or without; True if they may change it.
    """
    if not (low < small and high > -small):
        return low, high, False
    slack = 2.0**-51 * max(abs(low), abs(high)) + (0.0 if was_small else rest)
    return low - slack, high + slack, True
