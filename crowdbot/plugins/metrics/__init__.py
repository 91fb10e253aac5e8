"""Metrics of the CrowdBot challenge (D7.3, sections 1.2 and 2.2)."""

from crowdbot.plugins.metrics.collision_count import COLLISION_COUNT
from crowdbot.plugins.metrics.effect_on_velocity import EFFECT_ON_VELOCITY
from crowdbot.plugins.metrics.relative_path_length import RELATIVE_PATH_LENGTH
from crowdbot.plugins.metrics.relative_time_to_goal import RELATIVE_TIME_TO_GOAL
from crowdbot.plugins.metrics.risk import RISK

COMPONENTS = (
    RELATIVE_TIME_TO_GOAL,
    RELATIVE_PATH_LENGTH,
    EFFECT_ON_VELOCITY,
    RISK,
    COLLISION_COUNT,
)
