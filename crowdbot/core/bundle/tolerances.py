"""How far scores of the same run may be apart on two processors.

Processors round differently, and a crowd turns the last digit into another history within some
seconds. Scores of one run then differ like scores of two runs: no bound on a single one is both
fair and sharp, but differences of honest runs scatter around zero. So there are two rules, both
from one published number for each score, its ``spread``:

- no single difference is larger than `SINGLE` spreads;
- the mean of n differences is no further from zero than `MEAN` spreads over the root of n.

The spreads are measured (benchmarks/processor_targets.py) and doubled. Scores without a spread
are not judged.
"""

from __future__ import annotations

import math
from collections.abc import Mapping

SINGLE, MEAN = 6.0, 4.0

#: Scores of equal trajectories are equal but for the last digits, which sums may round.
EQUAL = 1e-9

#: Scores that measure the machine instead of the run.
WALL_CLOCK = ("max_planner_time", "mean_planner_time")

#: Metric, corrected variant -> spread in its unit.
SPREADS: Mapping[str, float] = {}


def are_equal(a: float, b: float) -> bool:
    """Whether two scores of one trajectory agree."""
    return math.isclose(a, b, rel_tol=EQUAL, abs_tol=EQUAL)


def single_limit(spread: float) -> float:
    """Largest difference of one run."""
    return SINGLE * spread


def mean_limit(spread: float, runs: int) -> float:
    """Largest absolute mean of the differences of some runs."""
    return MEAN * spread / math.sqrt(runs)
