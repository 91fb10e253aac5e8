"""Arrays, planar poses, and robot commands."""

from __future__ import annotations

from typing import NamedTuple


class Pose(NamedTuple):
    """A pose in the plane."""

    x: float
    y: float
    yaw: float


class Command(NamedTuple):
    """Body velocity: v forward (m/s), w counter-clockwise (rad/s), vy to the left (m/s).

    Only a holonomic drive supports vy; for all others it is clamped to 0.
    """

    v: float
    w: float
    vy: float = 0.0
