"""A crowd policy for people who follow velocity commands."""

from __future__ import annotations

import bisect
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from crowdbot.plugin import Agents, Array, CrowdView
from crowdbot.plugins.crowd.policies.walker import WalkerSpec


class Walker:
    """Agents want the commanded velocity.

    Attributes:
        commanded: True: nothing else changes what its agents want.
    """

    commanded = True

    def __init__(self, recorded: Sequence[tuple[float, float, float]]) -> None:
        """Take commands: time, velocity."""
        self._times = [t for t, _, _ in recorded]
        self._recorded = recorded
        self._source: Callable[[float], tuple[float, float]] = self._played

    def lead(self, source: Callable[[float], tuple[float, float]]) -> None:
        """Use a function from time (s) to velocity (m/s) as the command."""
        self._source = source

    def velocities(self, view: CrowdView, dt: float) -> Array:
        """Return the commanded velocity for all agents."""
        del dt
        found: Array = np.tile(np.array(self._source(view.t), np.float64), (len(view.position), 1))
        return found

    def _played(self, t: float) -> tuple[float, float]:
        """Return the recorded command in effect; before the first one, stand."""
        k = bisect.bisect_right(self._times, t) - 1
        return self._recorded[k][1:] if k >= 0 else (0.0, 0.0)


def build(spec: WalkerSpec, costs: Sequence[Any], agents: Agents) -> Walker:
    """Return the policy; it has no costs."""
    del costs, agents
    return Walker(spec.recorded or ())
