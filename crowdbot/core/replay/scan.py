"""ReplayScan: the scans of one lidar, as the replay page draws them."""

from __future__ import annotations

from dataclasses import dataclass

from crowdbot.core.interfaces import Array


@dataclass(frozen=True, slots=True, kw_only=True)
class ReplayScan:
    """Scans of one lidar.

    Attributes:
        mount: x, y, z, yaw from base_link (m, rad).
        angles: (R,) beam angles in the sensor frame, rad.
        range_max: how far it sees, m.
        t: (K,) stamps, increasing, s.
        ranges: (K, R), m; inf or NaN where nothing came back.
    """

    sensor: str
    mount: tuple[float, float, float, float]
    angles: Array
    range_max: float
    t: Array
    ranges: Array
