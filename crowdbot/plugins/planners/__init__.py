"""Planners: floors that see nothing or only stop, a baseline that finds a way, and a ceiling."""

from crowdbot.plugins.planners.dwa.dwa import DWA
from crowdbot.plugins.planners.goal_seek import GOAL_SEEK
from crowdbot.plugins.planners.oracle import ORACLE
from crowdbot.plugins.planners.stand_still import STAND_STILL
from crowdbot.plugins.planners.stop_and_go.stop_and_go import STOP_AND_GO
from crowdbot.plugins.planners.wall_hug import WALL_HUG

COMPONENTS = (STAND_STILL, GOAL_SEEK, WALL_HUG, STOP_AND_GO, DWA, ORACLE)
