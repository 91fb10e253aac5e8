"""Robots: from a spec to a model that is checked, and what their descriptions say."""

from crowdbot.core.robots.build import MODES, build_model, build_robot
from crowdbot.core.robots.description import Description, read_description

__all__ = ["MODES", "Description", "build_model", "build_robot", "read_description"]
