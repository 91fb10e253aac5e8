"""Arrays, where something is in the plane, and what a robot is told to do."""

from __future__ import annotations

from typing import NamedTuple


class Pose(NamedTuple):
    """Pose in the plane."""

    x: float
    y: float
    yaw: float


class Command(NamedTuple):
    """Body velocity: v forward (m/s), w counter-clockwise (rad/s), vy to the left (m/s).

    Only a holonomic drive can give vy; for all others it is clamped to 0.
    """

    v: float
    w: float
    vy: float = 0.0
