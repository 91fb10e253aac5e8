"""When people arrive: Poisson, in a steady beat, or on schedule."""

from __future__ import annotations

import numpy as np

from crowdbot.dsl.scenario.stream import Arrivals


def arrival_times(arrivals: Arrivals, rng: np.random.Generator) -> list[float]:
    """Times at which a group, or one who is alone, arrives, in order; s.

    Those of a Poisson stream are drawn interval by interval, so that a later end adds some and
    moves none.
    """
    if arrivals.times:
        return sorted(arrivals.times)
    assert arrivals.until is not None  # checked with the document
    if arrivals.every is not None:
        beat, span = arrivals.every, arrivals.until - arrivals.begin
        count = int(np.ceil(span / beat - 1e-9))
        return [arrivals.begin + i * beat for i in range(count)]
    assert arrivals.rate is not None
    times: list[float] = []
    now = arrivals.begin + float(rng.exponential(1.0 / arrivals.rate))
    while now < arrivals.until:
        times.append(now)
        now += float(rng.exponential(1.0 / arrivals.rate))
    return times
