"""Planners: one that sees nothing, one that stops, one that finds a way."""

from crowdbot.plugins.planners.dwa import DWA
from crowdbot.plugins.planners.goal_seek import GOAL_SEEK
from crowdbot.plugins.planners.stop_and_go import STOP_AND_GO

COMPONENTS = (GOAL_SEEK, STOP_AND_GO, DWA)
