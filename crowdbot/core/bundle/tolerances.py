"""Tolerances for scores of the same run on two processors.

Processors round differently, and in a crowd a difference in the last digit grows to a different run
within seconds. Scores then differ like those of two runs: no bound on a single difference is both
fair and sharp, but differences of honest runs scatter around zero. So there are two rules, both
from one published number per score, its ``spread``:

- no single difference is larger than `SINGLE` spreads;
- the mean of n differences is within `MEAN` spreads / sqrt(n) of zero.

The spread of a score is twice the root mean square difference between two runs of one scenario
whose trajectories have diverged: 12 scenarios of challenge-2020, planner dwa, two seeds
(benchmarks/processor_targets.py, way ``seed``). Rounding alone did far less: at most 2e-6 in any of
these scores but one. Scores without a spread are not compared.

The six main scores were measured again in 14 such scenarios: contacts_per_km 18, push_work 0.60,
intrusion 0.017, safe_efficiency 0.041, success 0 and success_no_collision 0.76. All of them but
push_work have a chosen spread, for two reasons that these runs cannot measure:

- Rare changes of outcome. With none in 14 runs, the rate may still be 3 in 14 (95 % bound), which
  would give a spread of 0.9. The chosen 0.5 already makes `SINGLE` spreads exceed any difference of
  success or safe_efficiency, so that only the mean decides.
- Planners that touch more people than dwa with its 0.1 contacts per run: the difference of two
  counts grows with their root. 42 is two contacts on 48 m; 0.35 is 20 times dwa's intrusion.
"""

from __future__ import annotations

import math
from collections.abc import Mapping

SINGLE, MEAN = 10.0, 4.0

#: Equal trajectories give equal scores up to the last digits, since sums round.
EQUAL = 1e-9

#: Scores that measure the machine instead of the run.
WALL_CLOCK = ("max_planner_time", "mean_planner_time")

#: Metric, variant of `variant_of` -> spread in its unit; five are chosen, the others measured.
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
