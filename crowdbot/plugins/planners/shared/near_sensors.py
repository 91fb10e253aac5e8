"""Sensors beside the lidars that a planner takes, if it is told to and the robot has them."""

from __future__ import annotations

from typing import Any

from pydantic import Field

#: Categories: for points that no lidar sees, and for noticing that the robot pushes.
NEAR_SENSORS = ("ultrasound", "infrared", "camera", "imu", "bumper")


def near_sensors_field() -> Any:
    """Return the field of planners that may take near sensors; hashes are as without it."""
    return Field(
        default=False,
        exclude_if=lambda value: value is False,
        description="Also take ultrasound, infrared, depth cameras, IMU and bumper where the robot "
        "has them: they see kerbs and gates that a lidar's plane misses.",
    )
