"""Arrival times: Poisson, regular, or given."""

from __future__ import annotations

import numpy as np

from crowdbot.dsl.scenario.stream import Arrivals


def arrival_times(arrivals: Arrivals, rng: np.random.Generator) -> list[float]:
    """Return the arrival times of groups or single people, in order; s.

    Intervals of a Poisson stream are sampled one by one, so that a later end adds arrivals without
    moving others.
    """
    if arrivals.times:
        return sorted(arrivals.times)
    assert arrivals.until is not None  # checked on validation
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
