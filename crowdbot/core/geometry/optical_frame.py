"""The optical frame of a camera: REP 103's second frame, which images are stamped with.

The frame of a camera looks along x, as all frames of the robot do; its optical frame looks along
z, with x to the right and y down.
"""

from __future__ import annotations

import math

#: Roll, pitch and yaw of the optical frame in the camera's, rad; and the same as x, y, z, w.
OPTICAL_RPY = (-math.pi / 2, 0.0, -math.pi / 2)
OPTICAL_QUATERNION = (-0.5, 0.5, -0.5, 0.5)


def optical(frame: str) -> str:
    """Return the name of the optical frame of a camera."""
    return f"{frame}_optical"
