"""Tools for build functions of observations and rewards."""

from __future__ import annotations

from crowdbot.core.learning.build import Observer, Reward
from crowdbot.core.learning.seen import LearningContext, RobotInputs, StepChange, sensor_named

__all__ = ["LearningContext", "Observer", "Reward", "RobotInputs", "StepChange", "sensor_named"]
