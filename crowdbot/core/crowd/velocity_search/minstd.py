"""The original engine's random numbers: the minimal standard generator, one per agent.

Source: Park, Miller, "Random number generators: good ones are hard to find", CACM 1988: x <- 16807
x mod (2^31 - 1). It scales in single precision, like the original.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.crowd.velocity_search.records import AgentRecord
from crowdbot.core.support.compiling.compile import array_kernel, inline_kernel

_MODULUS = 2147483647


def seeds(ids: NDArray[np.int64]) -> NDArray[np.float64]:
    """Return the first states of agents with these ids; 0 counts as 1, since 0 never changes."""
    state = np.asarray(ids, np.int64) % _MODULUS
    return np.where(state == 0, 1, state).astype(np.float64)


@inline_kernel
def following(state: int) -> int:
    """Return the next state of the generator."""
    product = np.int64(state) * np.int64(16807)
    folded = (product & np.int64(_MODULUS)) + (product >> np.int64(31))
    return int(folded - np.int64(_MODULUS) if folded >= np.int64(_MODULUS) else folded)


@inline_kernel
def between(state: int, low: float, high: float) -> float:
    """Return the number in [low, high) that belongs to a state."""
    unit = np.float32(state - 1) * np.float32(1.0 / 2147483648.0)  # a power of two: exact
    unit = min(unit, np.float32(1.0 - 2.0**-24))
    return float(np.float32(unit * (np.float32(high) - np.float32(low))) + np.float32(low))


@array_kernel
def draw(agent: AgentRecord, low: float, high: float) -> float:
    """Advance the generator of an agent and return a number in [low, high)."""
    state = following(int(agent.random))
    agent.random = float(state)
    return between(state, low, high)
