"""Differences on which a verdict rests: every pair of runs, with missing values at their worst.

A planner must not gain by a missing run. To find that planner ``a`` is better than ``b``, runs of
``a`` count as the worst if they are missing, failed, or have no rate because the robot did not
advance. The worst is the bound of the score, or, without one, the worst value of the two planners.
Runs of ``b`` that failed or did not advance count in the same way; its missing runs are left out,
and are not evidence against it. Other scores without a value forbid a verdict in favour of their
planner, unless bounds are known.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.statistics.clusters import Floats
from crowdbot.core.statistics.sign_flip import p_value
from crowdbot.core.statistics.table import MISSING, UNDEFINED, Name, Table
from crowdbot.core.support.text import plural

_Mask = NDArray[np.bool_]
_ROUNDING = 1e-12  # values with a smaller relative difference are equal


@dataclass(frozen=True, slots=True)
class ComparisonVerdict:
    """The direction of a comparison, and the p value of its mean.

    Attributes:
        sign: 1 if ``a`` looks better, -1 if ``b`` does, 0 if neither can be shown.
        p: two-sided p value of the mean gain.
        reason: what forbids a verdict, or what counts as the worst; empty if nothing.
    """

    sign: int = 0
    p: float = 1.0
    reason: str = ""


def judge(
    table: Table, name: Name, a: str, b: str, better: str, reference: float | None
) -> ComparisonVerdict:
    """Return the direction and the p value of two planners in a score that has a direction."""
    one, two = (_Side.of(table, name, planner, better, reference) for planner in (a, b))
    worst = _worst(table, name, better, (one, two))
    reasons = list[str]()
    for sign, planner, own, other in ((1, a, one, two), (-1, b, two, one)):
        gains, kept, open_ = _gains(own, other, worst)
        if not kept.any():
            continue
        last = int((own.last & kept).sum())
        worst_of = f"{plural(last, 'run')} of {planner} without a value count as the worst"
        if gains.sum() <= 0.0:
            reasons += [f"{worst_of}: no gain is left"] if last else []
            continue
        reasons += [worst_of] if last else []
        if not open_:
            p = p_value(gains, table.clusters.part(kept))
            return ComparisonVerdict(sign, p, "; ".join(reasons))
        reasons.append(f"{planner} has no value in {plural(open_, 'pair')}")
    return ComparisonVerdict(reason="; ".join(reasons))


def loses_at_most(table: Table, name: Name, a: str, b: str, margin: float, *, alpha: float) -> bool:
    """Return True if a mean loss of ``a`` against ``b`` of more than ``margin`` can be ruled out.

    A test of non-inferiority with chance alpha / 2 of a wrong True: that of `judge`, with the
    margin added to the gain of each pair.

    Args:
        table: table of the runs.
        name: score that is higher or lower for better, and not a rate.
        a, b: labels.
        margin: in the score's unit.
        alpha: level of the two-sided test.
    """
    better = table.label(name).better
    one, two = (_Side.of(table, name, planner, better, None) for planner in (a, b))
    gains, kept, open_ = _gains(one, two, _worst(table, name, better, (one, two)))
    gains = gains + margin
    if open_ or not kept.any() or gains.sum() <= 0.0:
        return False
    return p_value(gains, table.clusters.part(kept)) <= alpha


@dataclass(frozen=True, slots=True, eq=False)
class _Side:
    """One planner's values in all rows of the table, with higher as better.

    Attributes:
        low, high: bounds of the values, as far as they and the score's bounds are known.
        weight: exposure of rates; else 1.
        known: has a value, and no run that failed.
        last: counts as the worst in favour of the other planner; ``missing`` ones are among them.
        there: has a run, or lacks one that it should have.
    """

    low: Floats
    high: Floats
    weight: Floats
    known: _Mask
    last: _Mask
    missing: _Mask
    there: _Mask

    @staticmethod
    def of(table: Table, name: Name, planner: str, better: str, reference: float | None) -> _Side:
        column, exposure = table.column(name, planner), table.exposure(name, planner)
        missing = table.lacking(planner)
        scale = table.scale(name)
        low, high = np.clip((column.low, column.high), scale.minimum, scale.maximum)
        low, high = utility(low, high, better, reference)
        known = column.known & ~column.failed
        stuck = np.zeros_like(known)
        weight = np.ones(len(low))
        if exposure is not None:
            known = known & np.isfinite(exposure)
            weight = np.where(known, exposure, np.nan)
            stuck = (column.outcome == UNDEFINED) & ~table.arrived(planner)
        last = column.failed | stuck | missing
        there = (column.outcome != MISSING) | missing
        return _Side(low, high, weight, known, last, missing, there)


def utility(
    low: Floats, high: Floats, better: str, reference: float | None
) -> tuple[Floats, Floats]:
    """Return the bounds of values, turned so that higher is better."""
    if better == "lower":
        return -high, -low
    if better == "reference" and reference is not None:
        near, far = np.abs(low - reference), np.abs(high - reference)
        within = (low <= reference) & (reference <= high)
        return -np.maximum(near, far), -np.where(within, 0.0, np.minimum(near, far))
    return low, high


def _worst(table: Table, name: Name, better: str, sides: tuple[_Side, _Side]) -> float:
    """Return the worst value: the score's bound, else a value below or equal to all known ones."""
    scale = table.scale(name)
    bound = {"higher": scale.minimum, "lower": -scale.maximum}.get(better, -np.inf)
    if np.isfinite(bound):
        return float(bound)
    found = np.concatenate([side.low[side.known] for side in sides])
    found = found[np.isfinite(found)]
    if not len(found):
        return 0.0
    least, most = float(found.min()), float(found.max())
    return least if least < most else least - max(1.0, abs(least))


def _gains(own: _Side, other: _Side, worst: float) -> tuple[Floats, _Mask, int]:
    """Return the certain gains of ``own`` in the kept pairs, their mask, and open pairs."""
    mine = np.where(own.last, worst, own.low)
    theirs = np.where(other.last, worst, other.high)
    kept = own.there & other.there & ~other.missing
    kept &= np.isfinite(theirs) & (own.known | own.last | other.known)
    open_ = kept & ~np.isfinite(mine)
    kept &= ~open_
    mine, theirs = mine[kept], theirs[kept]
    weights = _weights(own.weight[kept], other.weight[kept])
    return _contributions(mine, theirs, *weights), kept, int(open_.sum())


def _weights(own: Floats, other: Floats) -> tuple[Floats, Floats]:
    """Return exposures; a run without one has that of the other planner in the same crowd."""
    return (
        np.where(np.isfinite(own), own, np.where(np.isfinite(other), other, 1.0)),
        np.where(np.isfinite(other), other, np.where(np.isfinite(own), own, 1.0)),
    )


def _contributions(mine: Floats, theirs: Floats, weight: Floats, other: Floats) -> Floats:
    """Return each pair's contribution to the difference of both means or rates.

    The rate of both planners together does not change if their names are exchanged in a draw, so
    that the exchange turns the sign of the contribution; their sum has the sign of the difference.
    """
    total = float((weight + other).sum())
    rate = float((mine * weight).sum() + (theirs * other).sum()) / total if total else 0.0
    found = (mine - rate) * weight - (theirs - rate) * other
    size = np.maximum(np.abs(mine), np.abs(theirs)) * np.maximum(weight, other)
    found[np.abs(found) <= _ROUNDING * size] = 0.0
    return np.asarray(found)
