"""Scoring of displacement and delay, person by person."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np

from crowdbot.plugin import (
    Array,
    References,
    Score,
    ScoreFactory,
    Trajectories,
    truncate_at_arrival,
)
from crowdbot.plugin.for_metrics import Effects, Pairing, meeting_effects, whole_effects
from crowdbot.plugins.metrics.declared_build import DeclaredMetric, UndefinedError
from crowdbot.plugins.metrics.paired_people import DelaySpec, DisplacementSpec

#: Share of the people who are affected most.
WORST = 0.05
#: Walking speeds that differ by less are treated as equal, m/s.
SAME_SPEED = 1e-6
#: Tolerance for who counts as met, m and s, so that rounding does not decide.
TOLERANCE = 1e-9


_Spec = DisplacementSpec | DelaySpec


class Displacement(DeclaredMetric[DisplacementSpec]):
    """Scores ``displacement`` of people met: mean, worst 5 %, number, slope over speed.

    ``whole`` is the mean over everyone. Needs ``crowd_alone`` with the same people.
    """

    def _scores(self, run: Trajectories, refs: References) -> Sequence[Score]:
        much = self.spec.much_displacement
        return _scores(self.factory, run, refs, self.spec, lambda found: found.displacement, much)


class Delay(DeclaredMetric[DelaySpec]):
    """Scores ``delay`` of people met: mean, worst 5 %, number, slope over speed.

    ``whole`` is the mean over everyone. Needs ``crowd_alone`` with the same people.
    """

    def _scores(self, run: Trajectories, refs: References) -> Sequence[Score]:
        much = self.spec.much_delay
        return _scores(self.factory, run, refs, self.spec, lambda found: found.delay, much)


def _scores(
    factory: ScoreFactory,
    run: Trajectories,
    refs: References,
    spec: _Spec,
    each: Callable[[Effects], Array],
    much: float,
) -> list[Score]:
    """Return all variants for the cost to each person (P,)."""
    alone = refs.crowd_alone
    if alone is None or alone.agents is None:
        raise UndefinedError("no_reference")
    if run.trips is None or alone.trips is None:
        raise UndefinedError("no_trips")
    run, alone = truncate_at_arrival(run), truncate_at_arrival(alone)
    pairing = Pairing(
        same_start=spec.same_start,
        reach=spec.neighbour_radius,
        after=spec.after_meeting,
        jump_speed=spec.jump_speed,
    )
    everybody = whole_effects(run, alone, pairing)
    whole = factory.undefined("whole", "no_trips")
    if len(everybody):
        extras = {"people": float(len(everybody)), "left_out": float(everybody.left_out)}
        whole = factory.ok("whole", each(everybody).mean(), extras)
    names = factory.variants[:-1]
    if run.robot is None:
        return [*factory.all_undefined("invalid_no_robot", names), whole]
    met = meeting_effects(run, alone, pairing)
    if not len(met):
        return [*factory.all_undefined("no_neighbours", names), whole]
    return [*_of_met(factory, met, each(met), much), whole]


def _of_met(factory: ScoreFactory, met: Effects, each: Array, much: float) -> list[Score]:
    """Score the people met: mean, worst, count and slope."""
    worst = np.sort(each)[-max(1, math.ceil(WORST * len(each))) :]
    extras = {"people": float(len(each)), "left_out": float(met.left_out)}
    return [
        factory.ok("corrected", each.mean(), extras),
        factory.ok("worst", worst.mean()),
        factory.ok("count", (each > much + TOLERANCE).sum()),
        _slope(factory, met.speed, each),
    ]


def _slope(factory: ScoreFactory, speed: Array, each: Array) -> Score:
    """Score the slope of people's cost over their walking speed (least squares)."""
    off = speed - speed.mean()
    if len(speed) < 3 or np.abs(off).max() <= SAME_SPEED:
        return factory.undefined("slope", "too_few_people")
    return factory.ok("slope", float(off @ (each - each.mean())) / float(off @ off))
