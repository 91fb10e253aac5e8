"""How many crowd draws a verdict takes: at least, and for a difference as large as the one seen.

Runs in one crowd rise and fall together, so that draws count, not runs. The least number follows
from the test: with G draws no p is below 2^(1 - G) (`signed_rank`), and Holm's first step wants
alpha / tests. The number for a difference of size d is that of a two-sided t test at the level
alpha / tests with power 0.8, from the standard error of the difference that was seen, which falls
with the root of the draws; pi / 3 times as many, because signed ranks need that where differences
are normal (Pitman's efficiency 3 / pi; Lehmann 1975, Nonparametrics, appendix 5).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from crowdbot.core.scoring.four_scores import is_main
from crowdbot.core.statistics.comparison import Comparison, reach
from crowdbot.core.statistics.signed_rank import least_p
from crowdbot.core.statistics.summary import Summary
from crowdbot.core.support.text import plural

#: Nobody simulates more draws than this: a difference that needs them counts as none.
MOST_DRAWS = 100_000


@dataclass(frozen=True, slots=True, kw_only=True)
class SampleSize:
    """Whether a sample can lead to a verdict at all.

    Attributes:
        draws: independent crowd draws that two planners have in common; the most of any pair.
        pairs: of the same scenario and seed among them.
        least: draws without which no difference, however large, is told from chance.
        tests, alpha: comparisons that share the chance ``alpha`` of a false verdict.
    """

    draws: int
    pairs: int
    least: int
    tests: int
    alpha: float

    @property
    def too_small(self) -> bool:
        """Whether no verdict is possible."""
        return self.draws < self.least

    @property
    def text(self) -> str:
        """What is missing, in words; empty where a verdict is possible."""
        if not self.too_small:
            return ""
        return (
            f"The sample is too small for any verdict between planners: "
            f"{plural(self.draws, 'crowd draw')} in {plural(self.pairs, 'pair')} of runs. "
            f"{plural(self.tests, 'test')} that share a chance of {100 * self.alpha:g} % of a "
            f"false verdict need at least {self.least} crowd draws, since p cannot be below "
            f"2^(1 - draws): {self.least} scenarios with a crowd of their own would do if one "
            "planner were better in each of them"
        )


def sample_size(summary: Summary) -> SampleSize | None:
    """Of the comparisons that decide; None where nothing is compared."""
    main = [c for c in summary.comparisons if is_main(c.metric, c.variant)]
    compared = main or list(summary.comparisons)
    if not compared:
        return None
    largest = max(compared, key=lambda c: (c.draws, c.pairs))
    tests = max(1, summary.tests)
    return SampleSize(
        draws=largest.draws,
        pairs=largest.pairs,
        least=least_draws(tests, summary.alpha),
        tests=tests,
        alpha=summary.alpha,
    )


def least_draws(tests: int, alpha: float) -> int:
    """The smallest number of draws that can give a verdict in one of so many tests."""
    draws = 1
    while least_p(draws) * tests > alpha:
        draws += 1
    return draws


def draws_needed(found: Comparison, tests: int, alpha: float, level: float) -> int | None:
    """Draws that would find the difference that was seen with probability 0.8.

    Args:
        found: with its mean difference and what is detectable.
        tests: that share ``alpha``.
        alpha: chance of any false verdict.
        level: of intervals, at which ``found.detectable`` was worked out.

    Returns:
        None where there is no difference, nothing is known of its chance, or more than
        `MOST_DRAWS` would be needed.
    """
    size = abs(found.difference.value or 0.0)
    if not size or not found.detectable or found.draws < 2:
        return None
    error = found.detectable / reach(found.draws - 1, level)
    strict = 1.0 - alpha / tests
    spread = error * math.sqrt(found.draws * math.pi / 3)  # standard error of one draw
    low = max(2, least_draws(tests, alpha))
    if _finds(size, spread, low, strict):
        return low
    high = 2 * low
    while not _finds(size, spread, high, strict):
        if high > MOST_DRAWS:
            return None
        low, high = high, 2 * high
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (low, middle) if _finds(size, spread, middle, strict) else (middle, high)
    return high


def _finds(size: float, spread: float, draws: int, level: float) -> bool:
    return size >= spread / math.sqrt(draws) * reach(draws - 1, level)
