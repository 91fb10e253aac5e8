"""People who face each other beside a pillar, none giving way, do not stand there for ever."""

from __future__ import annotations

import numpy as np
import pytest

from crowdbot.core.crowd import state as s
from crowdbot.core.environments.build import build_environment
from crowdbot.core.registry.registry import discover
from crowdbot.core.scenarios.library import open_spec, pick
from crowdbot.core.scenarios.lock import population
from crowdbot.core.sim.build_crowd import build_crowd


@pytest.mark.slow
def test_nobody_stands_for_ten_seconds() -> None:
    """Three of these stood for 30 s before people stepped aside."""
    registry = discover(allow=())
    scenario = pick(open_spec("challenge-2021", registry), "pillars_both-d040-slow")
    parts = build_environment(registry, scenario.environment)
    engine = build_crowd(scenario, population(scenario, registry).agents, parts, registry)
    assert engine is not None
    flat = engine.initial_state()
    _, rows = s.view(flat)
    standing, longest = np.zeros(len(rows)), 0.0
    for _ in range(16 * 16):
        left = 8
        while left:
            left -= engine.advance_alone(flat, left)
        slow = np.hypot(rows[:, s.VX], rows[:, s.VY]) < 0.05
        slow &= (rows[:, s.WAITING] == s.PRESENT) & (rows[:, s.ON_TRIP] > 0.0)
        standing = np.where(slow, standing + 0.0625, 0.0)
        longest = max(longest, float(standing.max()))
    assert 2.0 < longest < 8.0  # they did meet; ``patience`` is 5 s
