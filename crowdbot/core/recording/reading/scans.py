"""Scans and other range readings for the replay page."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from crowdbot.core.types.arrays import Array

#: Largest rate of readings on the replay page, Hz.
REPLAY_RATE = 8.0
#: Resolution on the replay page, m.
CENTIMETRE = 0.01


@dataclass(frozen=True, slots=True, kw_only=True)
class ReplayScan:
    """Scans of one lidar, or readings of one ultrasonic or infrared sensor.

    Attributes:
        mount: x, y, z, yaw from base_link (m, rad).
        angles: (R,) beam angles in the sensor frame, rad; for a cone (2,), its edges.
        range_max: its range, m.
        t: (K,) stamps, increasing, s.
        ranges: (K, R), for a cone (K, 1), m; inf or NaN for no return.
        tilt: roll and pitch of the mount (rad).
        cone: True if a reading is one distance anywhere between two edges.
    """

    sensor: str
    mount: tuple[float, float, float, float]
    angles: Array
    range_max: float
    t: Array
    ranges: Array
    cone: bool = False
    tilt: tuple[float, float] = (0.0, 0.0)


class Thinning:
    """Limits the rate of readings.

    Repeated thinning with the same rate removes nothing more.
    """

    def __init__(self, rate: float | None) -> None:
        """Build a filter. ``rate``: Hz; None keeps everything."""
        self._gap = round(1e9 / rate) if rate else 0
        self._due = 0

    def due(self, ns: int) -> bool:
        """Return True if a reading at this time (ns) would be kept."""
        return ns >= self._due

    def keeps(self, ns: int) -> bool:
        """Return True if the reading at this time (ns) is kept; call in order of time."""
        if not self.due(ns):
            return False
        self._due = ns - (ns % self._gap if self._gap else 0) + self._gap
        return True


def whole_centimetres(ranges: Array) -> Array:
    """Round distances for the replay page, m; non-finite values are unchanged."""
    metres = ranges.astype(np.float32).astype(np.float64)
    rounded: Array = np.rint(metres / CENTIMETRE) * CENTIMETRE
    return rounded
