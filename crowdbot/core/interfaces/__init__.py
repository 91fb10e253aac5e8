"""What each category of component must be able to do.

All small and at numpy level: SI units, float64, read-only inputs, new outputs; world frame
x along the corridor, y left, z up, yaw counter-clockwise (REP-103).
"""

from __future__ import annotations

from crowdbot.core.interfaces.environment import EnvironmentParts
from crowdbot.core.interfaces.metric import Metric, References
from crowdbot.core.interfaces.motion import Array, Command, Pose
from crowdbot.core.interfaces.planner import NoValidCommand, Observation, Planner, Task, Truth
from crowdbot.core.interfaces.robot import (
    DifferentialDrive,
    HolonomicDrive,
    RobotLimits,
    RobotModel,
    RobotState,
)
from crowdbot.core.interfaces.sensor import (
    MillimetreCamera,
    NoiseGenerator,
    Photograph,
    Pinhole,
    Reading,
    Sensor,
    SensorInfo,
    SensorWithMemory,
)

__all__ = [
    "Array",
    "Command",
    "DifferentialDrive",
    "EnvironmentParts",
    "HolonomicDrive",
    "Metric",
    "MillimetreCamera",
    "NoValidCommand",
    "NoiseGenerator",
    "Observation",
    "Photograph",
    "Pinhole",
    "Planner",
    "Pose",
    "Reading",
    "References",
    "RobotLimits",
    "RobotModel",
    "RobotState",
    "Sensor",
    "SensorInfo",
    "SensorWithMemory",
    "Task",
    "Truth",
]
