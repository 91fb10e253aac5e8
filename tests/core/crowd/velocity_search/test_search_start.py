"""Where a search begins is not part of the state: it must not decide who goes where."""

from __future__ import annotations

from typing import Any

import numpy as np

from crowdbot.api import registry
from crowdbot.core.crowd import state as s
from crowdbot.core.crowd.velocity_search.sampling import Sampler
from crowdbot.core.environments.build import build_environment
from crowdbot.core.scenarios.library import open_spec, pick
from crowdbot.core.scenarios.lock import population
from crowdbot.core.sim.build_crowd import build_crowd

#: In this one, candidates of somebody whom another touches cost the same but for rounding from
#: tick 488 on; one that gave up a hair above its budget was then taken for a tie.
CELL, UNTIL = "counter-d0250-dispersed-c50-r10", 540


def test_where_a_search_begins_changes_no_choice() -> None:
    known = registry()
    world = pick(open_spec("challenge-2020", known, []), CELL)
    agents = population(world, known).agents
    engine = build_crowd(world, agents, build_environment(known, world.environment), known)
    assert engine is not None
    (group,) = engine._groups_alone
    policy: Any = group.policy
    sampler = policy.minimiser
    assert isinstance(sampler, Sampler)
    rng, flat = np.random.default_rng(1), engine.initial_state()
    for tick in range(UNTIL):
        if tick % 8 == 0 and tick > 400:
            view = engine._view(flat, s.view(flat)[1], group.members, np.zeros((0, 5)))
            begun = sampler._first.copy()
            choice = sampler.choose(view)
            for _ in range(4):
                sampler._first[:] = rng.integers(0, len(sampler._candidates), len(begun))
                assert np.array_equal(sampler.choose(view), choice)
            sampler._first[:] = begun
        engine.advance(flat)
