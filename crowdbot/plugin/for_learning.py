"""Tools of observations and rewards, for the build side."""

from __future__ import annotations

from crowdbot.core.learning.build import Observer, Reward
from crowdbot.core.learning.seen import Change, LearningContext, Seen, sensor_named

__all__ = ["Change", "LearningContext", "Observer", "Reward", "Seen", "sensor_named"]
