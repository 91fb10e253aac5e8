"""Crowd policies and the cost functions they minimise."""

from crowdbot.plugins.crowd.foe_avoidance import FOE_AVOIDANCE
from crowdbot.plugins.crowd.goal_reaching_force import GOAL_REACHING_FORCE
from crowdbot.plugins.crowd.jupedsim import JUPEDSIM
from crowdbot.plugins.crowd.karamouzas import KARAMOUZAS
from crowdbot.plugins.crowd.moussaid import MOUSSAID
from crowdbot.plugins.crowd.orca import ORCA
from crowdbot.plugins.crowd.paris import PARIS
from crowdbot.plugins.crowd.pledestrians import PLEDESTRIANS
from crowdbot.plugins.crowd.power_law import POWER_LAW
from crowdbot.plugins.crowd.random_function import RANDOM_FUNCTION
from crowdbot.plugins.crowd.replay import REPLAY
from crowdbot.plugins.crowd.rvo import RVO
from crowdbot.plugins.crowd.social_forces_avoidance import SOCIAL_FORCES_AVOIDANCE
from crowdbot.plugins.crowd.ttca_dca import TTCA_DCA
from crowdbot.plugins.crowd.van_toll import VAN_TOLL
from crowdbot.plugins.crowd.velocity_space import VELOCITY_SPACE

POLICIES = (VELOCITY_SPACE, JUPEDSIM, REPLAY)
COSTS = (
    TTCA_DCA,
    RVO,
    ORCA,
    FOE_AVOIDANCE,
    GOAL_REACHING_FORCE,
    KARAMOUZAS,
    MOUSSAID,
    PARIS,
    PLEDESTRIANS,
    POWER_LAW,
    RANDOM_FUNCTION,
    SOCIAL_FORCES_AVOIDANCE,
    VAN_TOLL,
)
