"""Power of existing runs: how many are needed to detect a difference, and which conditions help.

Conditions are fixed and draws random, as in `clusters`. With variance V of a draw's mean difference
within conditions, a sample of G draws finds the difference d with probability 0.8 if ``d >= sqrt(V
/ G) (t(1 - alpha/2) + t(0.8))``, with the degrees of freedom G - conditions.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

import crowdbot.core.statistics.clusters as c
from crowdbot.core.statistics.clusters import Floats
from crowdbot.core.statistics.comparison import reach
from crowdbot.core.statistics.estimate import Estimate
from crowdbot.core.statistics.judged import ComparisonVerdict, judge
from crowdbot.core.statistics.sample_size import fewest
from crowdbot.core.statistics.sign_flip import least_p, p_value
from crowdbot.core.statistics.table import Name, Table

#: Differences of safe efficiency that an edition should tell.
SIZES = (0.05, 0.02)


@dataclass(frozen=True, slots=True, kw_only=True)
class ConditionPower:
    """The evidence of one condition about two planners.

    Attributes:
        condition: its labels; empty for all conditions together.
        pairs, draws: pairs of runs, and crowd draws among them.
        difference: mean difference ``a`` - ``b``.
        deviation: standard deviation of a draw's mean difference; None with one draw.
        p: p value of the mean difference; not corrected for the number of conditions.
        share: of the variance of the whole mean that this condition contributes.
        minutes: simulated minutes of both planners for each draw.
        information: 1 / (variance of a draw x minutes); infinite without variation.
        needed: size -> draws that tell this difference with probability 0.8; None: too many.
        runs: the same in runs of each planner.
    """

    condition: str
    pairs: int
    draws: int
    difference: Estimate
    deviation: float | None
    p: float
    share: float | None
    minutes: float
    information: float | None
    needed: dict[float, int | None]
    runs: dict[float, int | None]


@dataclass(frozen=True, slots=True, kw_only=True)
class Power:
    """The power of all runs of two planners in one score; the whole, then each condition."""

    metric: str
    variant: str
    unit: str
    a: str
    b: str
    whole: ConditionPower
    conditions: tuple[ConditionPower, ...]


def power(
    table: Table,
    name: Name,
    a: str,
    b: str,
    *,
    sizes: Sequence[float] = SIZES,
    level: float = 0.95,
    axis: str = "",
) -> Power | None:
    """Return the power of two planners' runs; None without a pair in which both have a value.

    Args:
        table: table of the runs.
        name: a score that is not a rate.
        a, b: the planners.
        sizes: differences to find, in the score's unit.
        level: 1 minus the chance of a false verdict; divide it among several tests.
        axis: axis of the suite whose labels make the parts; empty: conditions do.
    """
    sides = table.column(name, a), table.column(name, b)
    known = sides[0].known & sides[1].known
    if not known.any():
        return None
    label = table.label(name)
    rows = _Rows(table, name, (a, b), sides[0].low - sides[1].low, tuple(sizes), level)
    whole = rows.part("", known)
    of_axis = [label or f"no {axis}" for label in table.labels_on(axis)] if axis else ()
    labels = np.array(of_axis or table.conditions)
    names = sorted(set(labels[known].tolist()))
    apart = tuple(rows.part(one, known & (labels == one)) for one in names)
    return Power(
        metric=name[0], variant=name[1], unit=label.unit, a=a, b=b, whole=whole,
        conditions=tuple(_with_shares(apart)) if len(apart) > 1 else (),
    )  # fmt: skip


@dataclass(frozen=True, slots=True, eq=False)
class _Rows:
    table: Table
    name: Name
    planners: tuple[str, str]
    gains: Floats
    sizes: tuple[float, ...]
    level: float

    def part(self, condition: str, rows: NDArray[np.bool_]) -> ConditionPower:
        gains, groups = self.gains[rows], self.table.clusters.part(rows)
        p = p_value(gains, groups) if condition else self._judged().p
        error = c.ratio_error(gains, np.ones_like(gains), groups)
        deviation = None if error is None else error * math.sqrt(groups.count)
        minutes = self._minutes(rows) / groups.count
        found = {size: self._needed(size, deviation, groups.strata) for size in self.sizes}
        each = len(gains) / groups.count
        return ConditionPower(
            condition=condition,
            pairs=len(gains),
            draws=groups.count,
            difference=c.mean(gains, groups, self.level),
            deviation=deviation,
            p=p,
            share=None,
            minutes=minutes,
            information=_information(deviation, minutes),
            needed=found,
            runs={size: None if n is None else math.ceil(n * each) for size, n in found.items()},
        )

    def _judged(self) -> ComparisonVerdict:
        better = self.table.label(self.name).better
        if better not in ("higher", "lower", "reference"):
            return ComparisonVerdict()
        reference = self.table.reference(self.name)
        return judge(self.table, self.name, *self.planners, better, reference)

    def _minutes(self, rows: NDArray[np.bool_]) -> float:
        keys = [self.table.keys[i] for i in np.flatnonzero(rows)]
        runs = (self.table.runs.get((planner, key)) for planner in self.planners for key in keys)
        return sum(run.sim_time for run in runs if run is not None) / 60.0

    def _needed(self, size: float, deviation: float | None, strata: int) -> int | None:
        """Return the smallest number of draws that finds a difference."""
        if deviation is None:
            return None
        low = strata + 1
        while least_p(low) > 1.0 - self.level:
            low += 1
        return fewest(low, lambda draws: self._finds(size, deviation, draws, strata))

    def _finds(self, size: float, deviation: float, draws: int, strata: int) -> bool:
        return size >= deviation / math.sqrt(draws) * reach(draws - strata, self.level)


def _information(deviation: float | None, minutes: float) -> float | None:
    if deviation is None or minutes <= 0.0:
        return None
    return math.inf if deviation == 0.0 else 1.0 / (deviation**2 * minutes)


def _with_shares(parts: Sequence[ConditionPower]) -> Iterator[ConditionPower]:
    """Yield the conditions with their shares of the variance of the whole mean."""
    added = [
        part.pairs**2 * (part.deviation or 0.0) ** 2 / part.draws if part.draws > 1 else 0.0
        for part in parts
    ]
    total = sum(added)
    for part, square in zip(parts, added, strict=True):
        yield replace(part, share=square / total if total else None)
