"""The machinery: registry, realisation, crowd engine, sensing, trajectories, recording, scores.

Only `crowdbot.core.sim` knows Drake.
"""

from crowdbot.core.support.compile_cache import use_kernel_cache

use_kernel_cache()
