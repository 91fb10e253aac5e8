"""How far the robot displaces people, and how long it delays them, computed."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from crowdbot.core.interfaces import (
    Array,
    References,
    Score,
    ScoreFactory,
    Trajectories,
    truncate_at_arrival,
)
from crowdbot.core.trajectories.paired_people import PairedPeople, paired_people
from crowdbot.plugins.metrics.paired_people import (
    DELAY,
    DISPLACEMENT,
    DelaySpec,
    DisplacementSpec,
)

#: Share of the people who have it worst.
WORST = 0.05
#: Walking speeds that differ by less are the same, m/s.
SAME_SPEED = 1e-6
#: Slack of the rule who is counted, m and s: rounding decides nothing.
TOLERANCE = 1e-9


@dataclass(frozen=True, slots=True)
class Displacement:
    """Needs ``crowd_alone`` with the same people."""

    spec: DisplacementSpec

    def score(self, run: Trajectories, refs: References) -> Sequence[Score]:
        """Mean over people, mean of the worst 5 %, how many by much, slope against speed."""
        factory = ScoreFactory(DISPLACEMENT)
        found = _paired(factory, run, refs, self.spec)
        if isinstance(found, list):
            return found
        return _told(factory, found, found.displacement, self.spec.much_displacement)


@dataclass(frozen=True, slots=True)
class Delay:
    """Needs ``crowd_alone`` with the same people."""

    spec: DelaySpec

    def score(self, run: Trajectories, refs: References) -> Sequence[Score]:
        """Mean over people, mean of the worst 5 %, how many by much, slope against speed."""
        factory = ScoreFactory(DELAY)
        found = _paired(factory, run, refs, self.spec)
        if isinstance(found, list):
            return found
        return _told(factory, found, found.delay, self.spec.much_delay)


def _paired(
    factory: ScoreFactory, run: Trajectories, refs: References, spec: DisplacementSpec | DelaySpec
) -> PairedPeople | list[Score]:
    """People who make the same trips in both runs; or why there are none."""
    alone = refs.crowd_alone
    if alone is None or alone.agents is None:
        return factory.all_undefined("no_reference")
    if run.trips is None or alone.trips is None:
        return factory.all_undefined("no_trips")
    run, alone = truncate_at_arrival(run), truncate_at_arrival(alone)
    found = paired_people(run, alone, spec.same_start, spec.jump_speed)
    return found if len(found.id) else factory.all_undefined("no_trips")


def _told(factory: ScoreFactory, found: PairedPeople, each: Array, much: float) -> list[Score]:
    """All variants of what each person pays (P,)."""
    worst = np.sort(each)[-max(1, math.ceil(WORST * len(each))) :]
    extras = {"people": float(len(each)), "unpaired_trips": float(found.unpaired)}
    return [
        factory.ok("corrected", each.mean(), extras),
        factory.ok("worst", worst.mean()),
        factory.ok("count", (each > much + TOLERANCE).sum()),
        _slope(factory, found.speed, each),
    ]


def _slope(factory: ScoreFactory, speed: Array, each: Array) -> Score:
    """Least squares line of what people pay over how fast they walk: who pays."""
    off = speed - speed.mean()
    if len(speed) < 3 or np.abs(off).max() <= SAME_SPEED:
        return factory.undefined("slope", "too_few_people")
    return factory.ok("slope", float(off @ (each - each.mean())) / float(off @ off))
