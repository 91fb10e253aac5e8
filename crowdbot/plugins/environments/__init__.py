"""Places."""

from crowdbot.plugins.environments.corridor import CORRIDOR
from crowdbot.plugins.environments.floor import FLOOR

COMPONENTS = (CORRIDOR, FLOOR)
