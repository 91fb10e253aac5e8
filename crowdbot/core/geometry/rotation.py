"""Rotations by roll, pitch and yaw about fixed axes x, y, z, as URDF and SDFormat have them."""

from __future__ import annotations

import math

import numpy as np

from crowdbot.core.types.arrays import Array


def rotation(roll: float, pitch: float, yaw: float) -> Array:
    """Return the matrix (3, 3) from the rotated frame to the fixed one; angles in rad."""
    angles = (roll, pitch, yaw)
    cr, sr, cp, sp, cy, sy = (f(a) for a in angles for f in (math.cos, math.sin))
    return np.array(
        [
            [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
            [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
            [-sp, cp * sr, cp * cr],
        ]
    )


def rotation_of(x: float, y: float, z: float, w: float) -> Array:
    """Return the matrix (3, 3) of a quaternion of length 1."""
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )


def quaternion(roll: float, pitch: float, yaw: float) -> tuple[float, float, float, float]:
    """Return the rotation as a quaternion x, y, z, w."""
    angles = (roll, pitch, yaw)
    cr, sr, cp, sp, cy, sy = (f(0.5 * a) for a in angles for f in (math.cos, math.sin))
    return (
        sr * cp * cy - cr * sp * sy,
        cr * sp * cy + sr * cp * sy,
        cr * cp * sy - sr * sp * cy,
        cr * cp * cy + sr * sp * sy,
    )
