"""Covariances of odometry and IMU messages, from the noise of the sensor.

The error of the pose grows by the Jacobian of a motion along the heading, as in the prediction of
an extended Kalman filter (Thrun, Burgard, Fox, "Probabilistic Robotics", 2005, section 7.4).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from struct import Struct

from crowdbot.core.types.sensor import SensorInfo

#: m^2, rad^2, (m/s)^2: default covariances. A matrix of zeros would mean "unknown".
LEAST = 1e-6
_MATRIX = Struct("<36d")
#: Bits of the numbers: a covariance needs no more, and short ones take less room.
_BITS = 12
#: Numbers of a reading of odometry, and of `SensorInfo.deviations`: x, y, yaw, v, w, vy.
_SIX = 6


def has_noise(info: SensorInfo) -> bool:
    """Return True if the random errors of a sensor are known; otherwise covariances are zeros."""
    return any(info.deviations) or any(info.scatter)


def imu_deviations(info: SensorInfo) -> tuple[float, ...]:
    """Return (6,) standard deviations of an IMU's axes, rad/s and m/s^2; 0: unknown."""
    rate, force, *_ = (*info.deviations, 0.0, 0.0)
    scatter = info.scatter or (0.0,) * _SIX
    return tuple(map(math.hypot, (rate,) * 3 + (force,) * 3, scatter))


class OdometryCovariance:
    """Covariance of one odometry's pose, updated with each reading, or every n-th."""

    def __init__(self, info: SensorInfo) -> None:
        """Build the covariances of an odometry that `has_noise`."""
        squares = [d * d for d in (*info.deviations, *[0.0] * _SIX)[:_SIX]]
        self._along, self._turn, self._drift, self._ahead, self._aside, self._spin = squares
        self._scatter = [d * d for d in (*info.scatter, *[0.0] * _SIX)[:_SIX]]
        self._rate = info.rate
        self._last: tuple[int, float, float, float] | None = None
        self._xx = self._xy = self._yy = self._xa = self._ya = self._aa = 0.0

    def __call__(self, ns: int, values: Sequence[float]) -> tuple[bytes, bytes]:
        """Return covariances of pose and twist as 36 float64 each, rows by columns.

        Args:
            ns: time of the reading, never decreasing.
            values: x, y, yaw, v, w, and perhaps vy; m, rad, s.
        """
        x, y, yaw, v, _, *aside = values
        if self._last is None or ns > self._last[0]:
            if self._last is not None:
                before = self._last
                self._grow((ns - before[0]) / 1e9, x - before[1], y - before[2], before[3])
            self._last = (ns, x, y, yaw)
        return self._pose(), self._twist(v, aside[0] if aside else 0.0)

    def _pose(self) -> bytes:
        own_x, own_y, own_yaw, *_ = self._scatter
        return _matrix({
            (0, 0): self._xx + own_x, (0, 1): self._xy, (1, 0): self._xy, (1, 1): self._yy + own_y,
            (0, 5): self._xa, (5, 0): self._xa, (1, 5): self._ya, (5, 1): self._ya,
            (5, 5): self._aa + own_yaw,
        })  # fmt: skip

    def _twist(self, v: float, vy: float) -> bytes:
        _, _, _, own_v, own_w, own_vy = self._scatter
        turn = self._turn * (v * v + vy * vy) + self._drift * self._rate
        return _matrix({
            (0, 0): self._along * v * v + self._ahead + own_v,
            (1, 1): self._along * vy * vy + self._aside + own_vy,
            (5, 5): turn + self._spin + own_w,
        })  # fmt: skip

    def _grow(self, dt: float, dx: float, dy: float, yaw: float) -> None:
        """Propagate the covariance by a motion, m, from a heading on, in ``dt`` s."""
        xa, ya, aa = self._xa, self._ya, self._aa
        self._xx += -2.0 * dy * xa + dy * dy * aa
        self._xy += dx * xa - dy * ya - dx * dy * aa
        self._yy += 2.0 * dx * ya + dx * dx * aa
        self._xa -= dy * aa
        self._ya += dx * aa
        readings = max(1.0, dt * self._rate)
        part = self._along / readings  # squared distance, along the motion
        ahead, aside = (d * dt * dt / readings for d in (self._ahead, self._aside))
        c, s = math.cos(yaw), math.sin(yaw)
        self._xx += part * dx * dx + ahead * c * c + aside * s * s
        self._xy += part * dx * dy + (ahead - aside) * c * s
        self._yy += part * dy * dy + ahead * s * s + aside * c * c
        self._aa += self._turn * (dx * dx + dy * dy) / readings
        self._aa += self._drift * dt + self._spin * dt * dt / readings


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
