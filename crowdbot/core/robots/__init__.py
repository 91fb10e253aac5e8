"""Robots: build and check the model of a spec, and read robot descriptions."""

from crowdbot.core.robots.build import MODES, build_model, build_robot
from crowdbot.core.robots.description import Description, read_description

__all__ = ["MODES", "Description", "build_model", "build_robot", "read_description"]
