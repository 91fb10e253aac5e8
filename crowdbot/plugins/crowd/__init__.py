"""Crowd policies and the cost functions they minimise."""

from crowdbot.plugins.crowd.rvo import RVO
from crowdbot.plugins.crowd.ttca_dca import TTCA_DCA
from crowdbot.plugins.crowd.velocity_space import VELOCITY_SPACE

POLICIES = (VELOCITY_SPACE,)
COSTS = (TTCA_DCA, RVO)
