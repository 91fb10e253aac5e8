"""Optional near sensors of planners: ultrasound, infrared, depth cameras."""

from __future__ import annotations

from typing import Any

from crowdbot.plugin import default

#: Categories: for points that no lidar sees, and for noticing that the robot pushes.
NEAR_SENSORS = ("ultrasound", "infrared", "camera", "imu", "bumper")


def near_sensors_field() -> Any:
    """Return the field ``near_sensors``, which is outside the hash while it has its default."""
    return default(
        False,
        "Also take ultrasound, infrared, depth cameras, IMU and bumper where the robot "
        "has them: they see kerbs and gates that a lidar's plane misses.",
        omitted=True,
    )
