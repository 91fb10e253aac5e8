"""Covariances of pose and twist of odometry, propagated from its noise.

The error of the pose grows by the Jacobian of a motion along the heading, as in the prediction of
an extended Kalman filter (Thrun, Burgard, Fox, "Probabilistic Robotics", 2005, section 7.4).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from struct import Struct

#: m^2, rad^2, (m/s)^2: default covariances. A matrix of zeros would mean "unknown".
LEAST = 1e-6
_MATRIX = Struct("<36d")
#: Bits of the numbers: a covariance needs no more, and short ones take less room.
_BITS = 12


class OdometryCovariance:
    """Covariances of one odometry, reading by reading."""

    def __init__(self, deviations: Sequence[float]) -> None:
        """Build the covariances. ``deviations``: `SensorInfo.deviations` for odometry."""
        self._along, self._turn, self._drift = deviations
        self._last: tuple[int, float, float, float] | None = None
        self._period = 0.0
        self._xx = self._xy = self._yy = self._xa = self._ya = self._aa = 0.0

    def __call__(self, ns: int, values: Sequence[float]) -> tuple[bytes, bytes]:
        """Return covariances of pose and twist as 36 float64 each, rows by columns.

        Args:
            ns: time of the reading, never decreasing.
            values: x, y, yaw, v, w, and perhaps vy; m, rad, s.
        """
        x, y, yaw, v, _, *aside = values
        if self._last is not None and ns > self._last[0]:
            self._grow((ns - self._last[0]) / 1e9, x - self._last[1], y - self._last[2])
        if self._last is None or ns > self._last[0]:
            self._last = (ns, x, y, yaw)
        pose = {
            (0, 0): self._xx, (0, 1): self._xy, (1, 0): self._xy, (1, 1): self._yy,
            (0, 5): self._xa, (5, 0): self._xa, (1, 5): self._ya, (5, 1): self._ya,
            (5, 5): self._aa,
        }  # fmt: skip
        vy = aside[0] if aside else 0.0
        rate = self._drift**2 / self._period if self._period else 0.0
        twist = {
            (0, 0): (self._along * v) ** 2,
            (1, 1): (self._along * vy) ** 2,
            (5, 5): (self._turn * math.hypot(v, vy)) ** 2 + rate,
        }
        return _matrix(pose), _matrix(twist)

    def _grow(self, dt: float, dx: float, dy: float) -> None:
        """Propagate the covariance by a motion, m, in ``dt`` s."""
        self._period = dt
        xa, ya, aa = self._xa, self._ya, self._aa
        self._xx += -2.0 * dy * xa + dy * dy * aa
        self._xy += dx * xa - dy * ya - dx * dy * aa
        self._yy += 2.0 * dx * ya + dx * dx * aa
        self._xa -= dy * aa
        self._ya += dx * aa
        part = self._along**2  # squared distance, along the motion
        self._xx += part * dx * dx
        self._xy += part * dx * dy
        self._yy += part * dy * dy
        self._aa += self._turn**2 * (dx * dx + dy * dy) + self._drift**2 * dt


def _matrix(values: dict[tuple[int, int], float]) -> bytes:
    cells = [0.0] * 36
    for k in range(6):
        cells[7 * k] = LEAST
    for (row, column), value in values.items():
        cells[6 * row + column] += _short(value)
    return _MATRIX.pack(*cells)


def _short(value: float) -> float:
    mantissa, exponent = math.frexp(value)
    return math.ldexp(round(math.ldexp(mantissa, _BITS)), exponent - _BITS)
