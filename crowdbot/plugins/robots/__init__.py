"""Robots."""

from crowdbot.plugins.robots.turtlebot2 import TURTLEBOT2

COMPONENTS = (TURTLEBOT2,)
