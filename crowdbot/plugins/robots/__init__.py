"""Robots."""

from crowdbot.plugins.robots.cuybot import CUYBOT
from crowdbot.plugins.robots.pepper import PEPPER
from crowdbot.plugins.robots.qolo import QOLO
from crowdbot.plugins.robots.smart_wheelchair import SMART_WHEELCHAIR
from crowdbot.plugins.robots.turtlebot2 import TURTLEBOT2

COMPONENTS = (TURTLEBOT2, PEPPER, QOLO, CUYBOT, SMART_WHEELCHAIR)
