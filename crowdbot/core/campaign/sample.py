"""Samples of scenarios with as many different crowds as possible."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from crowdbot.core.runs.identity import Prepared
from crowdbot.dsl.scenario.seeds import stream_seed

#: Default number of scenarios per suite for floors and ceilings: that of the challenge's crowd
#: draws.
FLOOR_SCENARIOS = 18


def sample(scenarios: Sequence[Prepared], count: int, suite: str) -> list[Prepared]:
    """Return this many scenarios in order, equal for equal suites; all if there are no more.

    The crowd draw is the unit of statistics: a second scenario with the same crowd is chosen only
    after every crowd has one.

    Args:
        scenarios: scenarios of one suite.
        count: number of scenarios.
        suite: the suite's name, which also names the random stream.
    """
    rng = np.random.Generator(np.random.PCG64(stream_seed(0, suite, "campaign.sample")))
    draws: dict[str, list[int]] = {}
    for place in rng.permutation(len(scenarios)).tolist():
        run = scenarios[place].run
        draw = run.realisation if len(run.people.agents) else run.scenario.id
        draws.setdefault(draw, []).append(place)
    rounds = max((len(places) for places in draws.values()), default=0)
    order = [p[k] for k in range(rounds) for p in draws.values() if k < len(p)]
    return [scenarios[place] for place in sorted(order[:count])]
