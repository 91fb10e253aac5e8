"""Comparison of two planners in one score."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from numpy.typing import NDArray

import crowdbot.core.statistics.clusters as c
from crowdbot.core.statistics.clusters import Bounds, Clusters, Floats
from crowdbot.core.statistics.effect_size import effect_size
from crowdbot.core.statistics.estimate import NOTHING, Counts, Estimate
from crowdbot.core.statistics.judged import ComparisonVerdict, judge, utility
from crowdbot.core.statistics.sign_flip import least_p
from crowdbot.core.statistics.signed_rank import double_ranks, signed_ranks
from crowdbot.core.statistics.summary_estimator import bounds_of_difference, rate_difference
from crowdbot.core.statistics.table import MISSING, UNDEFINED, Column, Name, Table

Verdict = Literal["better", "worse", "not distinguishable", "not ranked"]

NO_DIRECTION = "nothing says which values are better"
NO_REFERENCE = "the value to be near to is not among the scores"
_POWER = 0.8
_ROUNDING = 1e-12  # values with a smaller relative difference are equal


@dataclass(frozen=True, slots=True, kw_only=True)
class Comparison:
    """Planner ``a`` against planner ``b``; effects are positive where ``a`` is better.

    Attributes:
        metric, variant, unit, better: the score.
        pairs: scenarios and seeds that both have run.
        draws: independent crowd draws among them.
        counts_a, counts_b: how the runs ended; ``missing`` runs are not among the pairs.
        wins, losses, ties, undecided: pairs in which ``a`` is better, worse or equal, and pairs
            left open by undefined scores or overlapping bounds.
        difference: mean of a - b over pairs where both have a value; distances to the reference
            where ``better`` is ``reference``. In ``unit``.
        bounds: of the same mean over all pairs, with undefined and censored values anywhere within
            their bounds; None for an open side.
        standardised: ``difference`` in standard deviations of the pairs' differences.
        rank_biserial: share of the ranks for ``a`` minus share for ``b``, -1 to 1.
        improvement: probability that ``a`` is better in a pair; ties and undecided count half.
        improvement_bounds: the same with all undecided pairs lost, or won.
        detectable: the smallest mean difference that this many draws detect with probability 0.8 at
            this level; None if unknown.
        p: p value of the mean gain, by exchanging the planners in whole draws; runs without a value
            count as in `judge`. ``p_holm`` is corrected for all tests of the summary.
        verdict: verdict on ``a``, never stronger than ``p_holm`` supports; ``reason`` explains it.
    """

    metric: str
    variant: str
    unit: str
    better: str
    a: str
    b: str
    pairs: int
    draws: int
    counts_a: Counts
    counts_b: Counts
    wins: int = 0
    losses: int = 0
    ties: int = 0
    undecided: int = 0
    difference: Estimate = NOTHING
    bounds: tuple[float | None, float | None] = (None, None)
    standardised: Estimate = NOTHING
    rank_biserial: Estimate = NOTHING
    improvement: Estimate = NOTHING
    improvement_bounds: tuple[float, float] = (0.0, 1.0)
    detectable: float | None = None
    p: float | None = None
    p_holm: float | None = None
    verdict: Verdict = "not distinguishable"
    reason: str = ""


def compare(
    table: Table, name: Name, a: str, b: str, *, level: float = 0.95
) -> tuple[Comparison, ComparisonVerdict]:
    """Compare two planners; `with_verdict` adds the verdict once all p values are known."""
    label = table.label(name)
    sides = table.column(name, a), table.column(name, b)
    there = (sides[0].outcome != MISSING) & (sides[1].outcome != MISSING)
    groups = table.clusters.part(there)
    head = Comparison(
        metric=name[0], variant=name[1], unit=label.unit, better=label.better, a=a, b=b,
        pairs=int(there.sum()), draws=groups.count,
        counts_a=sides[0].counts, counts_b=sides[1].counts,
    )  # fmt: skip
    if not there.any():
        return replace(head, reason="no scenario and seed was run with both"), ComparisonVerdict()
    reference = table.reference(name)
    if label.better == "reference" and reference is None:
        return replace(head, verdict="not ranked", reason=NO_REFERENCE), ComparisonVerdict()
    pair = _Pair(*(_Side.of(s, there, label.better, reference) for s in sides))
    found = _differences(head, pair, groups, _bounds(table, head), level)
    rates = rate_difference(table, name, (a, b), _chosen(there, pair.known), level)
    if rates is not None:
        found = _with_rates(found, *rates, groups, level)
    if label.better == "none":
        return replace(found, verdict="not ranked", reason=NO_DIRECTION), ComparisonVerdict()
    judged = judge(table, name, a, b, label.better, reference)
    return replace(_ranked(found, pair, groups, level), p=judged.p), judged


def with_verdict(
    comparison: Comparison, judged: ComparisonVerdict, p_holm: float | None, alpha: float
) -> Comparison:
    """Return the comparison with its verdict, which rests on means; ranks only describe."""
    if comparison.verdict == "not ranked" or comparison.p is None:
        return comparison
    verdict: Verdict = "not distinguishable"
    reason = judged.reason
    if p_holm is not None and p_holm <= alpha and judged.sign:
        verdict = "better" if judged.sign > 0 else "worse"
    elif least_p(comparison.draws) > alpha:
        reason = f"too few crowd draws: {comparison.draws}; no difference could be told from chance"
    elif not comparison.wins and not comparison.losses and not reason:
        reason = "every pair is equal" if not comparison.undecided else "no pair is decided"
    return replace(comparison, p_holm=p_holm, verdict=verdict, reason=reason)


# ----------------------------------------------------------------------- one pair
@dataclass(frozen=True, slots=True, eq=False)
class _Side:
    """One planner's values with higher as better; failed runs rank below all others."""

    low: Floats
    high: Floats
    known: NDArray[np.bool_]
    undefined: NDArray[np.bool_]
    failed: NDArray[np.bool_]

    @staticmethod
    def of(column: Column, there: NDArray[np.bool_], better: str, reference: float | None) -> _Side:
        low, high = utility(column.low[there], column.high[there], better, reference)
        outcome = column.outcome[there]
        return _Side(low, high, column.known[there], outcome == UNDEFINED, column.failed[there])


@dataclass(frozen=True, slots=True, eq=False)
class _Pair:
    a: _Side
    b: _Side

    @property
    def known(self) -> NDArray[np.bool_]:
        return self.a.known & self.b.known

    @property
    def least(self) -> Floats:
        return self.a.low - self.b.high

    @property
    def most(self) -> Floats:
        return self.a.high - self.b.low

    def contrasts(self) -> tuple[Floats, NDArray[np.bool_]]:
        """Return the certain advantage of ``a`` (n,), and a mask of undecided pairs.

        Exchanging the planners only changes the sign, on which the test's level depends.
        """
        certain = np.maximum(self.least, 0.0) + np.minimum(self.most, 0.0)
        size = np.maximum(np.abs(self.a.low), np.abs(self.b.low))
        certain[self.known & (np.abs(certain) <= _ROUNDING * size)] = 0.0
        certain[self.a.undefined | self.b.undefined] = 0.0
        both = self.a.failed & self.b.failed
        certain[self.a.failed], certain[self.b.failed] = -np.inf, np.inf
        certain[both] = 0.0
        return certain, (certain == 0) & ~self.known & ~both


def _chosen(there: NDArray[np.bool_], known: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Return a mask of rows in which both have a value."""
    chosen = there.copy()
    chosen[there] = known
    return chosen


def _bounds(table: Table, head: Comparison) -> Bounds:
    """Return the bounds of differences; distances to a reference have other bounds than values."""
    name = head.metric, head.variant
    return c.UNBOUNDED if head.better == "reference" else bounds_of_difference(table, name)


def _with_rates(
    comparison: Comparison,
    difference: Estimate,
    error: float | None,
    groups: Clusters,
    level: float,
) -> Comparison:
    """Return a comparison of rates: rates of all runs together replace the means of pairs."""
    ends = (difference.value, difference.value)
    return replace(
        comparison,
        difference=difference,
        bounds=(None, None) if None in comparison.bounds else ends,
        detectable=None if not error else error * reach(groups.freedom, level),
    )


def _differences(
    head: Comparison, pair: _Pair, groups: Clusters, bounds: Bounds, level: float
) -> Comparison:
    """Return the results in the metric's unit, over pairs where both have a value."""
    known, sign = pair.known, 1.0 if head.better in ("higher", "none") else -1.0
    least, most = sign * pair.least, sign * pair.most
    ends = [float(x.mean()) for x in (np.minimum(least, most), np.maximum(least, most))]
    open_ends = (_finite(ends[0]), _finite(ends[1]))
    if not known.any():
        nothing = Estimate(reason="no pair in which both have a value")
        return replace(head, difference=nothing, standardised=nothing, bounds=open_ends)
    some = groups.part(known)
    gains = (pair.least)[known]
    ones = np.ones_like(gains)
    error = c.ratio_error(gains, ones, some)
    return replace(
        head,
        difference=c.mean(sign * gains, some, level, bounds),
        bounds=open_ends,
        standardised=effect_size(gains, some, level),
        detectable=None if not error else error * reach(some.freedom, level),
    )


def _finite(number: float) -> float | None:
    return number if math.isfinite(number) else None


def reach(freedom: int, level: float) -> float:
    """Return the standard errors that a difference needs for the power `_POWER`."""
    return c.quantile_t(0.5 + level / 2, freedom) + c.quantile_t(_POWER, freedom)


def _ranked(comparison: Comparison, pair: _Pair, groups: Clusters, level: float) -> Comparison:
    """Return the rank-based results over all pairs, which describe and decide nothing."""
    contrasts, undecided = pair.contrasts()
    ranks = double_ranks(contrasts)
    won = 0.5 + np.sign(contrasts) / 2
    half = float(undecided.mean()) / 2
    improvement = c.mean(won, groups, level, (0.0, 1.0))
    share = float(won.mean())
    shares = signed_ranks(contrasts, ranks).astype(float), ranks.astype(float)
    biserial = c.ratio(*shares, groups, level, (-1.0, 1.0))
    return replace(
        comparison,
        wins=int((contrasts > 0).sum()),
        losses=int((contrasts < 0).sum()),
        ties=int(((contrasts == 0) & ~undecided).sum()),
        undecided=int(undecided.sum()),
        rank_biserial=biserial,
        improvement=improvement,
        improvement_bounds=(share - half, share + half),
    )
