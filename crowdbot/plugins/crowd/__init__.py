"""Crowd policies and the cost functions they minimise."""

from crowdbot.plugins.crowd.cost_functions.foe_avoidance import FOE_AVOIDANCE
from crowdbot.plugins.crowd.cost_functions.goal_reaching_force import GOAL_REACHING_FORCE
from crowdbot.plugins.crowd.cost_functions.karamouzas import KARAMOUZAS
from crowdbot.plugins.crowd.cost_functions.moussaid import MOUSSAID
from crowdbot.plugins.crowd.cost_functions.orca import ORCA
from crowdbot.plugins.crowd.cost_functions.paris import PARIS
from crowdbot.plugins.crowd.cost_functions.pledestrians import PLEDESTRIANS
from crowdbot.plugins.crowd.cost_functions.power_law import POWER_LAW
from crowdbot.plugins.crowd.cost_functions.random_function import RANDOM_FUNCTION
from crowdbot.plugins.crowd.cost_functions.rvo import RVO
from crowdbot.plugins.crowd.cost_functions.social_forces_avoidance import SOCIAL_FORCES_AVOIDANCE
from crowdbot.plugins.crowd.cost_functions.ttca_dca.ttca_dca import TTCA_DCA
from crowdbot.plugins.crowd.cost_functions.van_toll import VAN_TOLL
from crowdbot.plugins.crowd.policies.jupedsim import JUPEDSIM
from crowdbot.plugins.crowd.policies.replay import REPLAY
from crowdbot.plugins.crowd.policies.velocity_space import VELOCITY_SPACE

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
