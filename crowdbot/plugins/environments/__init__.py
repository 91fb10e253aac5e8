"""Places."""

from crowdbot.plugins.environments.corridor import CORRIDOR

COMPONENTS = (CORRIDOR,)
