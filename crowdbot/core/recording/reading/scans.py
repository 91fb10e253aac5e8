"""Scans and other readings of distances as the replay page draws them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from crowdbot.core.types.arrays import Array

#: As many readings per second as the replay page holds, Hz.
REPLAY_RATE = 8.0
#: As exact as it draws them, m.
CENTIMETRE = 0.01


@dataclass(frozen=True, slots=True, kw_only=True)
class ReplayScan:
    """Scans of one lidar, or readings of one ultrasound or infrared sensor.

    Attributes:
        mount: x, y, z, yaw from base_link (m, rad).
        angles: (R,) beam angles in the sensor frame, rad; of a cone (2,) its edges.
        range_max: how far it sees, m.
        t: (K,) stamps, increasing, s.
        ranges: (K, R), of a cone (K, 1), m; inf or NaN where nothing came back.
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
    """Leaves out readings so that at most so many per second remain.

    Thinning again with the same rate leaves out nothing more.
    """

    def __init__(self, rate: float | None) -> None:
        """``rate``: Hz; None leaves out nothing."""
        self._gap = round(1e9 / rate) if rate else 0
        self._due = 0

    def due(self, ns: int) -> bool:
        """Return True if a reading of this time (ns) would remain."""
        return ns >= self._due

    def keeps(self, ns: int) -> bool:
        """Return True if the reading of this time (ns) remains; ask in the order of time."""
        if not self.due(ns):
            return False
        self._due = ns - (ns % self._gap if self._gap else 0) + self._gap
        return True


def whole_centimetres(ranges: Array) -> Array:
    """Distances as the replay page draws them, m; what is not finite stays as it is."""
    metres = ranges.astype(np.float32).astype(np.float64)
    rounded: Array = np.rint(metres / CENTIMETRE) * CENTIMETRE
    return rounded
