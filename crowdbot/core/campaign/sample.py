"""Samples of scenarios: few, but with as many different crowds as there can be."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from crowdbot.core.runs.identity import Prepared
from crowdbot.dsl.scenario.seeds import stream_seed

#: Scenarios of a suite in which floors and ceilings are run, where nobody asked for more: as many
#: as the challenge has crowd draws.
FLOOR_SCENARIOS = 18


def sample(scenarios: Sequence[Prepared], count: int, suite: str) -> list[Prepared]:
    """So many scenarios in their order, equal for equal suites; all if there are no more.

    The crowd draw is the unit of statistics: a second scenario with one crowd is taken only when
    every crowd has its first.

    Args:
        scenarios: of one suite.
        count: how many.
        suite: its name, which names the random stream.
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
