"""All statistics of a campaign's results."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence, Set
from dataclasses import dataclass
from itertools import combinations, product

import numpy as np

from crowdbot.core.results.results import Results
from crowdbot.core.scoring.four_scores import is_main, main_first
from crowdbot.core.statistics.axes import AxisEffect, DensityLevel, axis_effects, densities
from crowdbot.core.statistics.clusters import Floats
from crowdbot.core.statistics.comparison import Comparison, compare, with_verdict
from crowdbot.core.statistics.estimate import Counts, Estimate
from crowdbot.core.statistics.sign_flip import holm
from crowdbot.core.statistics.summary_estimator import planner_mean
from crowdbot.core.statistics.table import MISSING, Column, Name, Table
from crowdbot.core.statistics.variance import VarianceParts, variance_parts

#: Reasons of scores that no simulated run can have; left out if all runs give them.
_NOT_ASKED = {"no_command", "no_baseline", "no_answers", "no_formula_in_seed"}


@dataclass(frozen=True, slots=True, kw_only=True)
class PlannerScore:
    """One score of one planner over all its runs.

    Attributes:
        counts: outcomes of the runs; ``reasons``: why values are missing -> how often.
        draws: independent crowd draws among the values.
        mean: mean of the existing values (``counts.ok``), with its interval; for a rate, the rate
            of all runs together.
        bounds: bounds of the mean over all runs, with undefined and censored values anywhere within
            their bounds; None for an open side. A planner that seldom arrives may have a good
            ``mean`` of few runs; these bounds show how much that says.
        least, quartiles, most: statistics of these values; None without any.
    """

    planner: str
    metric: str
    variant: str
    category: str
    symbol: str
    unit: str
    better: str
    counts: Counts
    reasons: Mapping[str, int]
    draws: int
    mean: Estimate
    bounds: tuple[float | None, float | None]
    least: float | None
    quartiles: tuple[float, float, float] | None
    most: float | None


@dataclass(frozen=True, slots=True, kw_only=True)
class Summary:
    """The statistical results of a set of runs.

    Attributes:
        planners: sorted.
        scores: scores by metric, variant and planner.
        comparisons: comparison of each pair of planners in each score.
        axes: effect of each axis on each score of each planner.
        variances: variance components of each score of each planner.
        densities: realised crowd densities.
        level: confidence level of all intervals.
        alpha: probability of any false verdict among the four scores, and among all others.
        conditions_fixed: True if intervals treat only people as random; otherwise, with one draw
            per condition, conditions are random too.
        tests: number of comparisons of the four scores that share `alpha` (Holm); of all scores if
            none of the four is included.
    """

    planners: tuple[str, ...]
    scores: tuple[PlannerScore, ...]
    comparisons: tuple[Comparison, ...]
    axes: tuple[AxisEffect, ...]
    variances: tuple[VarianceParts, ...]
    densities: tuple[DensityLevel, ...]
    level: float
    alpha: float
    tests: int
    conditions_fixed: bool = False

    def comparison(self, metric: str, a: str, b: str) -> Comparison | None:
        """Return the comparison of two planners in a metric, as computed with a before b."""
        found = (x for x in self.comparisons if (x.metric, x.a, x.b) == (metric, a, b))
        return next(found, None)

    def ranks(self, metric: str) -> dict[str, int]:
        """Return planner -> 1 + number of significantly better ones.

        Equal ranks cannot be separated.

        Empty if the metric is not ranked.
        """
        here = [x for x in self.comparisons if x.metric == metric and x.verdict != "not ranked"]
        ranks = {planner: 1 for x in here for planner in (x.a, x.b)}
        for x in here:
            if x.verdict in ("better", "worse"):
                ranks[x.b if x.verdict == "better" else x.a] += 1
        return ranks


def headline_names(table: Table) -> tuple[Name, ...]:
    """Return one variant per metric, the same for all runs; the four main scores come first.

    This is ``rate`` if the metric has one, since sums over time depend on the run's length, or
    ``pace``, which has a value where people complete no trips.
    Otherwise ``corrected``, or ``restricted`` if that has more values (it handles records that end
    early), or else the first. Metrics without data are left out.
    """
    variants: dict[str, list[Name]] = {}
    for name in table.names:
        if _is_asked(table, name):
            variants.setdefault(name[0], []).append(name)
    return tuple(main_first((_headline(table, n) for n in variants.values()), lambda n: n))


def summarise(
    results: Results,
    names: Sequence[Name] | None = None,
    *,
    level: float = 0.95,
    alpha: float = 0.05,
    table: Table | None = None,
) -> Summary:
    """Compute all statistics of some results.

    Args:
        results: results from a store.
        names: (metric, variant) to include; default `headline_names`. The four main scores, with
            all pairs of planners, form one family for Holm's correction; all others form another,
            and so do comparisons with floors and ceilings.
        level: confidence level of intervals.
        alpha: probability of any false verdict in a family.
        table: the table of these results, if already built.
    """
    table = table or Table(results)
    chosen = headline_names(table) if names is None else tuple(names)
    pairs = list(combinations(table.planners, 2))
    found = [compare(table, name, a, b, level=level) for name in chosen for a, b in pairs]
    families = list(_families([x for x, _ in found], results.marks))
    p_holm = {place: p for family in families for place, p in family.items()}
    everybody = [(name, planner) for name in chosen for planner in table.planners]
    return Summary(
        planners=table.planners,
        scores=tuple(_planner_score(table, name, p, level) for name, p in everybody),
        comparisons=tuple(
            with_verdict(x, d, p_holm.get(i), alpha) for i, (x, d) in enumerate(found)
        ),
        axes=tuple(e for name, p in everybody for e in axis_effects(table, name, p)),
        variances=tuple(variance_parts(table, name, p) for name, p in everybody),
        densities=densities(table),
        level=level,
        alpha=alpha,
        tests=len(next(filter(None, families), {})),
        conditions_fixed=table.clusters.strata > 1,
    )


def _families(comparisons: Sequence[Comparison], marks: Set[str]) -> Iterator[dict[int, float]]:
    """Yield index of a comparison -> corrected p: first for the four scores, then for all others.

    Comparisons with floors and ceilings (``marks``) are separate families: running them must not
    reduce the power for other planners.
    """
    for marked, main in product((False, True), (True, False)):
        here = {
            place: x.p
            for place, x in enumerate(comparisons)
            if x.p is not None
            and is_main(x.metric, x.variant) is main
            and bool({x.a, x.b} & marks) is marked
        }
        adjusted = holm(np.array(list(here.values()), dtype=float))
        yield dict(zip(here, adjusted.tolist(), strict=True))


def _planner_score(table: Table, name: Name, planner: str, level: float) -> PlannerScore:
    column, label = table.column(name, planner), table.label(name)
    values = column.low[column.known]
    groups = table.clusters.part(column.known)
    quartiles = np.quantile(values, [0.25, 0.5, 0.75]).tolist() if len(values) else None
    centre, exposure = planner_mean(table, name, planner, level), table.exposure(name, planner)
    return PlannerScore(
        planner=planner,
        metric=name[0],
        variant=name[1],
        category=label.category,
        symbol=label.symbol,
        unit=label.unit,
        better=label.better,
        counts=column.counts,
        reasons=column.reasons,
        draws=groups.count,
        mean=centre,
        bounds=_bounds(column) if exposure is None else _of_rate(column, centre),
        least=float(values.min()) if len(values) else None,
        quartiles=(quartiles[0], quartiles[1], quartiles[2]) if quartiles else None,
        most=float(values.max()) if len(values) else None,
    )


def _of_rate(column: Column, centre: Estimate) -> tuple[float | None, float | None]:
    """Return bounds of a rate: the rate itself, or none if runs have no value."""
    tried = column.outcome != MISSING
    return (centre.value, centre.value) if column.known[tried].all() else (None, None)


def _bounds(column: Column) -> tuple[float | None, float | None]:
    """Return the bounds of the mean over all runs that were tried."""
    tried = column.outcome != MISSING
    return bounds_of_mean(column.low[tried], column.high[tried])


def bounds_of_mean(low: Floats, high: Floats) -> tuple[float | None, float | None]:
    """Return the bounds of the mean over runs with a least and a greatest value each, (n,)."""
    if not len(low):
        return None, None
    least, most = float(low.mean()), float(high.mean())
    return least if np.isfinite(least) else None, most if np.isfinite(most) else None


def _is_asked(table: Table, name: Name) -> bool:
    columns = [table.column(name, planner) for planner in table.planners]
    reasons = {reason for column in columns for reason in column.reasons}
    return any(column.known.any() for column in columns) or not reasons & _NOT_ASKED


def _headline(table: Table, names: Sequence[Name]) -> Name:
    by_variant = {variant: (metric, variant) for metric, variant in names}
    for first in ("rate", "pace"):
        if first in by_variant:
            return by_variant[first]
    corrected, restricted = by_variant.get("corrected"), by_variant.get("restricted")
    if corrected and restricted and _values(table, restricted) > _values(table, corrected):
        return restricted
    return corrected or names[0]


def _values(table: Table, name: Name) -> int:
    return sum(table.column(name, planner).counts.ok for planner in table.planners)
