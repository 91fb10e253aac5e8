"""The machinery: registry, realisation, crowd engine, sensing, trajectories, recording, scores.

Only `crowdbot.core.sim` knows Drake.
"""

from crowdbot.core.support.compile_cache import use_kernel_cache
from crowdbot.core.support.utf8_locale import use_utf8

use_kernel_cache()
use_utf8()
