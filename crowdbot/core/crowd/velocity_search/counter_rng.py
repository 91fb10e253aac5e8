"""Counter-based draws: a hash of integers, the same on every machine and in any order.

The mixing function is the finaliser of SplitMix64 (Steele, Lea, Flood, "Fast splittable
pseudorandom number generators", OOPSLA 2014), applied once per word.
"""

from __future__ import annotations

import numpy as np
from numba import uint64

from crowdbot.core.support.compiling.compile import kernel

#: Purposes of draws, which keep draws with equal counters separate.
GOAL, ENTRY, ROUTE, WANDER = 0, 1, 2, 3


@kernel
def _mix(word: np.uint64) -> np.uint64:
    word = (word ^ (word >> uint64(30))) * uint64(0xBF58476D1CE4E5B9)
    word = (word ^ (word >> uint64(27))) * uint64(0x94D049BB133111EB)
    return word ^ (word >> uint64(31))


@kernel
def uniform(key: np.uint64, agent: int, trip: int, purpose: int, counter: int) -> float:
    """Return a number in [0, 1) that depends only on its arguments."""
    state = uint64(key)
    for word in (agent, trip, purpose, counter):
        state = _mix(state + uint64(0x9E3779B97F4A7C15) * (uint64(word) + uint64(1)))
    return float(state >> uint64(11)) / 9007199254740992.0  # 2 ** 53
