"""Tolerances for scores of the same run on two processors.

Processors round differently, and in a crowd a difference in the last digit grows to a different run
within seconds. Scores then differ like those of two runs: no bound on a single difference is both
fair and sharp, but differences of honest runs scatter around zero. So there are two rules, both
from one published number per score, its ``spread``:

- no single difference is larger than `SINGLE` spreads;
- the mean of n differences is within `MEAN` spreads / sqrt(n) of zero.

The spread of a score is twice the root mean square difference between two runs of one scenario
whose trajectories have diverged: 12 scenarios of challenge-2020, planner dwa, two seeds
(benchmarks/processor_targets.py, way ``seed``). Those of yes or no are set by hand, since twelve
scenarios do not show how often an outcome turns: 0.5. No single run can differ by 10 of these, so
only the mean decides. Three of the main scores are set by hand, too: contacts_per_km, where one
contact more on the way of 48 m is 21 per km; push_work and intrusion, four times what two seeds
gave in 8 scenarios of 5 s (0.14 and 0.08), since safe_efficiency differs by that factor between
these and the twelve. Rounding alone did far less: at most 2e-6 in any of these scores but
one. Scores without a spread are not compared.
"""

from __future__ import annotations

import math
from collections.abc import Mapping

SINGLE, MEAN = 10.0, 4.0

#: Equal trajectories give equal scores up to the last digits, since sums round.
EQUAL = 1e-9

#: Scores that measure the machine instead of the run.
WALL_CLOCK = ("max_planner_time", "mean_planner_time")

#: Metric, variant of `variant_of` -> spread in its unit; success spreads are set, others measured.
SPREADS: Mapping[str, float] = {
    "ade_to_reference": 2.3,
    "avg_wall_clearance": 0.96,
    "contacts_per_km": 42,
    "cumulative_heading_change": 27,
    "effect_on_time": 0.0075,
    "effect_on_velocity": 0.0018,
    "expected_severity": 37,
    "fde_to_reference": 5,
    "final_distance_to_goal": 1.2,
    "heading_similarity": 1.7,
    "integrated_time_to_collision": 82,
    "intimate_time_fraction": 0.15,
    "intrusion": 0.35,
    "min_clearance": 0.069,
    "min_distance_to_goal": 1.2,
    "min_wall_clearance": 1.4,
    "neighbour_velocity_similarity": 0.049,
    "neighbours_time_to_goal": 0.027,
    "neighbours_velocity": 0.019,
    "normalized_proximity": 0.046,
    "path_length_similarity": 0.2,
    "personal_time_fraction": 0.097,
    "proximity": 0.1,
    "push_work": 0.6,
    "relative_jerk": 0.001,
    "relative_path_length": 0.12,
    "relative_time_to_goal": 0.094,
    "risk": 16,
    "safe_efficiency": 0.5,
    "social_time_fraction": 0.089,
    "space_compliance": 0.14,
    "spl": 0.12,
    "success": 0.5,
    "success_no_collision": 0.5,
    "time_exposed": 24,
    "time_not_moving": 0.46,
    "time_to_goal_similarity": 0.48,
    "velocity_similarity": 0.04,
}


#: Variant of scores with a tolerance, where it is not the corrected one.
_VARIANTS = {"push_work": "rate", "intrusion": "rate"}


def variant_of(metric: str) -> str:
    """Return the variant of a metric that has a tolerance; empty if none has."""
    return _VARIANTS.get(metric, "corrected") if metric in SPREADS else ""


def are_equal(a: float, b: float) -> bool:
    """Return True if two scores of one trajectory agree."""
    return math.isclose(a, b, rel_tol=EQUAL, abs_tol=EQUAL)


def single_limit(spread: float) -> float:
    """Return the largest allowed difference of one run."""
    return SINGLE * spread


def mean_limit(spread: float, runs: int) -> float:
    """Return the largest allowed absolute mean difference of some runs."""
    return MEAN * spread / math.sqrt(runs)
