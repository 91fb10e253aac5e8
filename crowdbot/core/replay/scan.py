"""ReplayScan: readings of one sensor of distances, as the replay page draws them."""

from __future__ import annotations

from dataclasses import dataclass

from crowdbot.core.interfaces import Array


@dataclass(frozen=True, slots=True, kw_only=True)
class ReplayScan:
    """Scans of one lidar, or readings of one ultrasound or infrared sensor.

    Attributes:
        mount: x, y, z, yaw from base_link (m, rad).
        angles: (R,) beam angles in the sensor frame, rad; of a cone (2,) its edges.
        range_max: how far it sees, m.
        t: (K,) stamps, increasing, s.
        ranges: (K, R), of a cone (K, 1), m; inf or NaN where nothing came back.
        cone: whether a reading is one distance anywhere between two edges.
    """

    sensor: str
    mount: tuple[float, float, float, float]
    angles: Array
    range_max: float
    t: Array
    ranges: Array
    cone: bool = False
