r"""Do known orders of planners come out? Directions are fixed here, before any run.

Reads runs and tests each order one-sided and paired: the same scenario and seed, one planner of
each side; the mean difference over scenarios, by flipping its signs:

    python benchmarks/orderings.py crowdbot            # the reference scores that come with it
    python benchmarks/orderings.py runs --suite challenge-2026

An order whose p is below 0.05 is reproduced, one whose opposite is below 0.05 is contradicted; of
all others nothing is shown. Several planners of a side count by their mean. What is found goes into
docs/explanation/validity.md, also what is not as published.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.results.results import Results
from crowdbot.core.results.with_reference import reference_results

Array = NDArray[np.float64]
#: Largest number of sign patterns that are counted out; with more, as many are drawn.
MOST = 20_000


class Order(NamedTuple):
    """A published or plain order: one side is ahead of the other in a score.

    Attributes:
        source: who found it, or why it has to be.
        more: True if the better side has the larger score.
    """

    claim: str
    source: str
    better: tuple[str, ...]
    worse: tuple[str, ...]
    metric: str
    variant: str
    more: bool


BLIND = ("goal_seek", "wall_hug")
REACTIVE = ("vfh_plus", "follow_the_gap", "orca", "rds", "rpp", "social_force")
PREDICTIVE = ("people_mpc", "mppi", "dwa")
ORDERS = (
    Order("reactive planners hit less than blind ones", "they see", REACTIVE, BLIND,
          "contacts_at_fault", "corrected", False),
    Order("predictive planners are ahead of reactive ones", "van den Berg et al. 2011 and later",
          PREDICTIVE, REACTIVE, "safe_efficiency", "corrected", True),
    Order("ORCA arrives more often than social force", "0.78 against 0.02, 480 cases",
          ("orca",), ("social_force",), "success", "", True),
    Order("the truth is ahead of sensors", "it knows more", ("oracle+privileged",), PREDICTIVE,
          "safe_efficiency", "corrected", True),
    Order("MPPI accelerates people least", "least control effort", ("mppi",), ("orca", "dwa"),
          "evasive_acceleration", "corrected", False),
)  # fmt: skip


def values(results: Results, order: Order, planners: Sequence[str]) -> dict[tuple[str, int], float]:
    """Return scenario and seed -> mean of the planners, where all of them have a value."""
    runs = {r.run_id: r for r in results.runs if r.planner in planners}
    found: dict[tuple[str, int], dict[str, float]] = {}
    for score in results.scores:
        fits = score.metric == order.metric and order.variant in ("", score.variant)
        if fits and score.run_id in runs and score.value is not None:
            run = runs[score.run_id]
            found.setdefault((run.scenario, run.seed), {}).setdefault(run.planner, score.value)
    there = {r.planner for r in runs.values()}
    return {k: float(np.mean([*v.values()])) for k, v in found.items() if set(v) == there}


def one_sided(differences: Array) -> float:
    """Return p of a mean this large if signs were random; differences are paired by scenario."""
    count = len(differences)
    if 2**count <= MOST:
        patterns = (np.arange(2**count)[:, None] >> np.arange(count)) & 1
    else:
        patterns = np.random.default_rng(0).integers(0, 2, (MOST, count))
    means = np.mean((2 * patterns - 1) * differences, axis=1)
    return float(np.mean(means >= differences.mean() - 1e-12))


def judged(results: Results) -> Iterator[str]:
    """Yield a line for each order."""
    for order in ORDERS:
        a, b = (values(results, order, side) for side in (order.better, order.worse))
        scenarios: dict[str, list[float]] = {}
        for key in sorted(set(a) & set(b)):
            scenarios.setdefault(key[0], []).append(a[key] - b[key])
        if not scenarios:
            yield f"not run    {order.claim} ({order.source})"
            continue
        gaps = np.array([np.mean(gap) for gap in scenarios.values()]) * (1 if order.more else -1)
        p, opposite = one_sided(gaps), one_sided(-gaps)
        word = "reproduced" if p < 0.05 else "CONTRADICTED" if opposite < 0.05 else "open"
        yield (
            f"{word:11}{order.claim} ({order.source}): {order.metric} better by "
            f"{gaps.mean():+.3f} in {len(gaps)} scenarios, p = {p:.3f}"
        )


def main() -> int:
    """Print what came out."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("runs", help="'crowdbot', a file of reference scores, or a folder of runs")
    parser.add_argument("--suite", help="only runs of this suite")
    given = parser.parse_args()
    found = reference_results(given.runs)
    runs = tuple(r for r in found.runs if given.suite in (None, r.suite))
    print("\n".join(judged(Results(runs=runs, scores=found.scores))))
    return 0


if __name__ == "__main__":
    sys.exit(main())
