"""Names of this module, and where they come from: for type checkers, and to import them."""

__all__: list[str]

from crowdbot.core.crowd.contact.geometry import is_clearly_longer as is_clearly_longer
from crowdbot.core.crowd.contact.geometry import is_clearly_shorter as is_clearly_shorter
from crowdbot.core.crowd.contact.geometry import (
    opposite_taken_for_parallel as opposite_taken_for_parallel,
)
from crowdbot.core.crowd.contact.geometry import single_angle as single_angle
from crowdbot.core.crowd.velocity_search.approach import approach as approach
from crowdbot.core.crowd.velocity_search.candidates import ALONG_PREFERRED as ALONG_PREFERRED
from crowdbot.core.crowd.velocity_search.candidates import PREFERRED_SPEED as PREFERRED_SPEED
from crowdbot.core.crowd.velocity_search.candidates import ZERO as ZERO
from crowdbot.core.crowd.velocity_search.candidates import Sampling as Sampling
from crowdbot.core.crowd.velocity_search.collision_walls import is_passed as is_passed
from crowdbot.core.crowd.velocity_search.collision_walls import swept_width as swept_width
from crowdbot.core.crowd.velocity_search.cost import MORE_WALLS as MORE_WALLS
from crowdbot.core.crowd.velocity_search.cost import NEAR_WALLS as NEAR_WALLS
from crowdbot.core.crowd.velocity_search.farther_walls import walls_closer_than as walls_closer_than
from crowdbot.core.crowd.velocity_search.gradient import Descent as Descent
from crowdbot.core.crowd.velocity_search.minstd import draw as draw
from crowdbot.core.crowd.velocity_search.nearest_points import (
    write_nearest_points as write_nearest_points,
)
from crowdbot.core.crowd.velocity_search.optimum import Optimum as Optimum
from crowdbot.core.crowd.velocity_search.point_grid import SAME_POINT as SAME_POINT
from crowdbot.core.crowd.velocity_search.sampling import Sampler as Sampler
from crowdbot.core.crowd.velocity_search.weighted_costs import WeightedCosts as WeightedCosts
from crowdbot.core.types.candidates import VelocityCandidates as VelocityCandidates
