"""Dependence of ranks on the crowd: the order of planners in each crowd.

Runs are separated by the axis ``crowd`` (`crowdbot campaign --crowds`). Kendall's tau-b (1945)
measures the agreement of two orders; ties count as ties.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations, permutations
from typing import Any

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.realism.crowds import realism_by_name
from crowdbot.core.results.results import Results
from crowdbot.core.results.score_columns import metrics_of
from crowdbot.core.statistics.estimate import Estimate
from crowdbot.core.statistics.floors import PRIMARY
from crowdbot.core.statistics.summary import headline_names
from crowdbot.core.statistics.summary_estimator import planner_mean
from crowdbot.core.statistics.table import Name, Table

AXIS = "crowd"


@dataclass(frozen=True, slots=True, kw_only=True)
class CrowdOrder:
    """The order of planners in one crowd.

    Attributes:
        crowd: the crowd's label.
        realism: realism index of the crowd, None if not measured.
        means: planner -> `planner_mean` over the ``pairs`` scenarios and seeds that all planners
            have, best first.
    """

    crowd: str
    realism: float | None
    means: Mapping[str, Estimate]
    pairs: int

    def value(self, planner: str) -> float:
        """Return the mean of one planner."""
        found = self.means[planner].value
        return math.nan if found is None else found


@dataclass(frozen=True, slots=True, kw_only=True)
class CrowdVerdict:
    """Order of two planners, over all crowds.

    Attributes:
        first, second: ``first`` ranks before ``second`` in most crowds, weighted by realism.
        before: labels of crowds with this order; ``against``: with the opposite order.
        crowds: number of crowds in which both were run.
        weighted: share of crowds with this order, weighted by realism.
    """

    first: str
    second: str
    before: tuple[str, ...]
    against: tuple[str, ...]
    crowds: int
    weighted: float

    @property
    def text(self) -> str:
        """Return the result as one sentence."""
        if not self.before and not self.against:
            return f"{self.first} and {self.second} are equal in all {self.crowds} crowds"
        text = (
            f"{self.first} before {self.second} in {len(self.before)} of {self.crowds} crowds, "
            f"{100 * self.weighted:.0f} % weighted by realism"
        )
        return text + (
            f"; the other way round in {', '.join(self.against)}" if self.against else ""
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class CrowdRanks:
    """Dependence of the ranks on the crowd.

    Attributes:
        metric: the metric that decides the order.
        orders: one per crowd, most realistic first.
        taus: (crowd, crowd) -> Kendall's tau-b; NaN if an order is all ties.
        verdicts: one per pair of planners.
    """

    metric: str
    orders: tuple[CrowdOrder, ...]
    taus: Mapping[tuple[str, str], float]
    verdicts: tuple[CrowdVerdict, ...]

    def as_json(self) -> dict[str, Any]:
        """Return plain data for JSON."""
        return {
            "metric": self.metric,
            "orders": [
                {
                    "crowd": o.crowd,
                    "realism": o.realism,
                    "means": {p: o.value(p) for p in o.means},
                    "pairs": o.pairs,
                }
                for o in self.orders
            ],
            "kendall_tau": [
                {"crowds": list(pair), "tau": None if math.isnan(tau) else tau}
                for pair, tau in self.taus.items()
            ],
            "verdicts": [
                {
                    "first": v.first,
                    "second": v.second,
                    "before": list(v.before),
                    "against": list(v.against),
                    "crowds": v.crowds,
                    "weighted": v.weighted,
                    "text": v.text,
                }
                for v in self.verdicts
            ],
        }


def crowd_ranks(
    results: Results, metric: str | None = None, *, table: Table | None = None
) -> CrowdRanks | None:
    """Return orders by crowd; None with fewer than two crowds or planners.

    Args:
        results: results of one suite.
        metric: the metric that decides the order; default: the primary score.
        table: the table of these results, if already built.
    """
    labels = list(dict.fromkeys(r.axes[AXIS] for r in results.runs if AXIS in r.axes))
    planners = sorted({r.planner for r in results.runs})
    if len(labels) < 2 or len(planners) < 2:
        return None
    chosen, table = metric or _primary(results), table or Table(results)
    name = next((n for n in headline_names(table) if n[0] == chosen), None)
    better = "" if name is None else table.label(name).better
    if name is None or better not in ("higher", "lower"):
        return None
    orders = [_order(label, planners, table, name) for label in labels]
    found = [o for o in orders if o.pairs]
    if len(found) < 2:
        return None
    found.sort(key=lambda o: -(o.realism if o.realism is not None else -math.inf))
    sign = 1.0 if better == "higher" else -1.0
    return CrowdRanks(
        metric=chosen,
        orders=tuple(found),
        taus={
            (a.crowd, b.crowd): kendall(
                [a.value(p) for p in planners], [b.value(p) for p in planners]
            )
            for a, b in combinations(found, 2)
        },
        verdicts=tuple(_verdict(a, b, found, sign) for a, b in combinations(planners, 2)),
    )


def kendall(x: Sequence[float], y: Sequence[float]) -> float:
    """Return Kendall's tau-b of two rows of values; NaN if one is all ties."""
    concordant, tied_x, tied_y, pairs = 0, 0, 0, 0
    for i, j in combinations(range(len(x)), 2):
        a, b = _sign(x[i] - x[j]), _sign(y[i] - y[j])
        concordant += a * b
        tied_x, tied_y, pairs = tied_x + (a == 0), tied_y + (b == 0), pairs + 1
    root = math.sqrt((pairs - tied_x) * (pairs - tied_y))
    return concordant / root if root else math.nan


def _primary(results: Results) -> str:
    there = metrics_of(results.scores)
    return next((m for m in PRIMARY if m in there), "")


def _order(label: str, planners: Sequence[str], table: Table, name: Name) -> CrowdOrder:
    shared = _shared(label, planners, table, name)
    pairs = int(shared.sum())
    means = {p: planner_mean(table, name, p, rows=shared) for p in planners} if pairs else {}
    sign = -1.0 if table.label(name).better == "higher" else 1.0
    ordered = sorted(means.items(), key=lambda item: (sign * (item[1].value or 0.0), item[0]))
    return CrowdOrder(crowd=label, realism=realism_by_name(label), means=dict(ordered), pairs=pairs)


def _shared(label: str, planners: Sequence[str], table: Table, name: Name) -> NDArray[np.bool_]:
    """Return a mask (n,) of rows with this crowd and a value for every planner."""
    runs = [[table.runs.get((p, key)) for p in planners] for key in table.keys]
    there = [all(r is not None and r.axes.get(AXIS) == label for r in row) for row in runs]
    parts = [np.array(there, np.bool_)]
    for planner in planners:
        exposure = table.exposure(name, planner)
        parts += [table.column(name, planner).known]
        parts += [] if exposure is None else [np.isfinite(exposure)]
    return np.asarray(np.all(parts, axis=0))


def _verdict(a: str, b: str, orders: Sequence[CrowdOrder], sign: float) -> CrowdVerdict:
    """Return the order with more weight; of equal ones the first by name."""
    weights = _weights(orders)
    ways = []
    for first, second in permutations((a, b)):
        lead = {o.crowd: _sign(sign * (o.value(first) - o.value(second))) for o in orders}
        before = tuple(c for c, s in lead.items() if s > 0)
        against = tuple(c for c, s in lead.items() if s < 0)
        weighted = sum(weights[c] for c in before)
        ways.append(
            CrowdVerdict(
                first=first, second=second, before=before, against=against,
                crowds=len(orders), weighted=weighted,
            )
        )  # fmt: skip
    return max(ways, key=lambda v: (round(v.weighted, 12), len(v.before)))


def _weights(orders: Sequence[CrowdOrder]) -> dict[str, float]:
    """Return weights that sum to 1, by realism; equal if none is known or above the ghosts."""
    raw = {o.crowd: max(0.0, o.realism or 0.0) for o in orders}
    total = sum(raw.values())
    return {c: (w / total if total else 1.0 / len(raw)) for c, w in raw.items()}


def _sign(value: float) -> int:
    return (value > 0) - (value < 0)
