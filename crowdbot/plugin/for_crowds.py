"""Tools for crowds' build functions: velocity search, geometry of discs and segments."""

from __future__ import annotations

from crowdbot.core.crowd.contact.geometry import (
    is_clearly_longer,
    is_clearly_shorter,
    opposite_taken_for_parallel,
    single_angle,
)
from crowdbot.core.crowd.velocity_search.approach import approach
from crowdbot.core.crowd.velocity_search.candidates import (
    ALONG_PREFERRED,
    PREFERRED_SPEED,
    ZERO,
    Sampling,
)
from crowdbot.core.crowd.velocity_search.collision_walls import is_passed, swept_width
from crowdbot.core.crowd.velocity_search.cost import MORE_WALLS, NEAR_WALLS
from crowdbot.core.crowd.velocity_search.farther_walls import walls_closer_than
from crowdbot.core.crowd.velocity_search.gradient import Descent
from crowdbot.core.crowd.velocity_search.minstd import draw
from crowdbot.core.crowd.velocity_search.optimum import Optimum
from crowdbot.core.crowd.velocity_search.sampling import Sampler
from crowdbot.core.crowd.velocity_search.weighted_costs import WeightedCosts
from crowdbot.core.types.candidates import VelocityCandidates

__all__ = [
    "ALONG_PREFERRED",
    "MORE_WALLS",
    "NEAR_WALLS",
    "PREFERRED_SPEED",
    "ZERO",
    "Descent",
    "Optimum",
    "Sampler",
    "Sampling",
    "VelocityCandidates",
    "WeightedCosts",
    "approach",
    "draw",
    "is_clearly_longer",
    "is_clearly_shorter",
    "is_passed",
    "opposite_taken_for_parallel",
    "single_angle",
    "swept_width",
    "walls_closer_than",
]
