"""Approximate directions, for callers that detect where more precision is needed; compiled."""

from __future__ import annotations

import math

from crowdbot.core.support.compiling.compile import kernel


@kernel
def rough_angle(x: float, y: float) -> float:
    """Return the direction of a vector, not zero, within 2e-5 rad; much faster than ``atan2``.

    Abramowitz and Stegun, Handbook of Mathematical Functions (1964), 4.4.49.
    """
    ax, ay = abs(x), abs(y)
    share = min(ax, ay) / max(ax, ay)
    s = share * share
    angle = 0.9998660 + s * (-0.3302995 + s * (0.1801410 + s * (-0.0851330 + s * 0.0208351)))
    angle *= share
    if ay > ax:
        angle = 0.5 * math.pi - angle
    if x < 0.0:
        angle = math.pi - angle
    return -angle if y < 0.0 else angle
