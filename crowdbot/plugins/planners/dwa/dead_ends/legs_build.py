"""Drive the legs of a manoeuvre one after the other, at walking speed."""

from __future__ import annotations

import math

import numpy as np

from crowdbot.plugin import Array, Pose, RobotLimits

#: Top speed, m/s; share of full braking that it uses.
_SPEED, _BRAKING = 0.4, 0.6
#: A leg ends within this distance and angle of its end: m, rad.
_NEAR, _ALIGNED = 0.03, 0.03
#: Yaw rate per heading error, 1/s; heading per distance from the line, rad/m; its limit, rad.
_GAIN, _PULL, _LEAN = 2.0, 1.5, 0.25
#: A path is old after this, s.
_LASTS = 5.0


class Legs:
    """The remaining legs of a manoeuvre; empty without one."""

    def __init__(self) -> None:
        self._legs: Array = np.empty((0, 4))
        self._next = 0
        self._since = -math.inf

    def __bool__(self) -> bool:
        """Return True if there are legs left."""
        return self._next < len(self._legs)

    def begin(self, legs: Array, t: float) -> None:
        """Start the legs from `manoeuvre_build.manoeuvre`, found at a time (s)."""
        self._legs, self._next, self._since = legs, 0, t

    def old(self, t: float) -> bool:
        """Return True if the path is old enough to search for a better one; ``t``: time now, s."""
        return t - self._since > _LASTS

    def velocity(self, pose: Pose, limits: RobotLimits) -> tuple[float, float]:
        """Return the next v (m/s) and w (rad/s); zero when all legs are done."""
        while self:
            kind, x, y, yaw = self._legs[self._next].tolist()
            found = _turn(yaw, pose, limits) if kind == 0.0 else None
            if kind != 0.0:
                found = _drive((x, y, yaw), kind, pose, limits)
            if found is not None:
                return found
            self._next += 1
        return 0.0, 0.0


def _turn(yaw: float, pose: Pose, limits: RobotLimits) -> tuple[float, float] | None:
    """Turn on the spot; return None when done."""
    off = math.remainder(yaw - pose.yaw, 2.0 * math.pi)
    if abs(off) < _ALIGNED:
        return None
    most = min(limits.w_max, math.sqrt(2.0 * _BRAKING * limits.alpha_max * abs(off)))
    return 0.0, max(-most, min(most, _GAIN * off))


def _drive(
    end: tuple[float, float, float], kind: float, pose: Pose, limits: RobotLimits
) -> tuple[float, float] | None:
    """Drive along the line to the end, ahead (1) or back (-1); return None when done."""
    x, y, yaw = end
    c, s = math.cos(yaw), math.sin(yaw)
    left = kind * ((x - pose.x) * c + (y - pose.y) * s)
    if left < _NEAR:
        return None
    aside = (pose.y - y) * c - (pose.x - x) * s
    lean = max(-_LEAN, min(_LEAN, _PULL * aside))
    off = math.remainder(yaw - kind * lean - pose.yaw, 2.0 * math.pi)
    slowest = limits.v_max if kind > 0.0 else -limits.v_min
    v = min(_SPEED, slowest, math.sqrt(2.0 * _BRAKING * limits.a_max * left))
    return kind * v, max(-limits.w_max, min(limits.w_max, _GAIN * off))
