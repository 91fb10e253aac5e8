"""Number of crowd draws that a verdict needs: the minimum, and for the observed difference.

Runs in one crowd are correlated, so draws count, not runs. The least number follows from the test:
with G draws no p is below 2^(1 - G) (`sign_flip`), and Holm's first step wants alpha / tests. The
number for a difference of size d is that of a two-sided t test at the level alpha / tests with
power 0.8, from the observed standard error, which falls with the square root of the draws.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

from crowdbot.core.scoring.four_scores import is_main
from crowdbot.core.statistics.comparison import Comparison, reach
from crowdbot.core.statistics.sign_flip import least_p
from crowdbot.core.statistics.summary import Summary
from crowdbot.core.support.text import plural

#: Largest number of draws worth simulating: a difference that needs more counts as none.
MOST_DRAWS = 100_000


@dataclass(frozen=True, slots=True, kw_only=True)
class SampleSize:
    """Size of a sample, compared with the size needed for a verdict.

    Attributes:
        draws: independent crowd draws that two planners share; maximum over pairs of planners.
        pairs: pairs of the same scenario and seed among them.
        least: draws below which no difference, however large, is significant.
        tests, alpha: comparisons that share the probability ``alpha`` of a false verdict.
    """

    draws: int
    pairs: int
    least: int
    tests: int
    alpha: float

    @property
    def too_small(self) -> bool:
        """Return True if no verdict is possible."""
        return self.draws < self.least

    @property
    def text(self) -> str:
        """Return the missing number of draws in words; empty if a verdict is possible."""
        if not self.too_small:
            return ""
        return (
            f"The sample is too small for any verdict between planners: "
            f"{plural(self.draws, 'different crowd')}; a verdict needs at least {self.least}"
        )


def sample_size(summary: Summary) -> SampleSize | None:
    """Return the sample size of the deciding comparisons; None without any."""
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
    """Return the smallest number of draws that can give a verdict with this many tests."""
    draws = 1
    while least_p(draws) * tests > alpha:
        draws += 1
    return draws


def draws_needed(comparison: Comparison, tests: int, alpha: float, level: float) -> int | None:
    """Return the draws that would detect the observed difference with probability 0.8.

    Args:
        comparison: the comparison, with its mean and detectable difference.
        tests: number of tests that share ``alpha``.
        alpha: probability of any false verdict.
        level: confidence level used for ``found.detectable``.

    Returns:
        None without a difference or standard error, or if more than `MOST_DRAWS` would be needed.
    """
    size = abs(comparison.difference.value or 0.0)
    if not size or not comparison.detectable or comparison.draws < 2:
        return None
    error = comparison.detectable / reach(comparison.draws - 1, level)
    strict = 1.0 - alpha / tests
    spread = error * math.sqrt(comparison.draws)  # standard error of one draw
    low = max(2, least_draws(tests, alpha))
    return fewest(low, lambda n: size >= spread / math.sqrt(n) * reach(n - 1, strict))


def fewest(low: int, suffice: Callable[[int], bool]) -> int | None:
    """Return the smallest number of draws, from ``low`` on, that suffices; more do, too.

    Returns:
        None if more than `MOST_DRAWS` would be needed.
    """
    high = low
    while not suffice(high):
        if high > MOST_DRAWS:
            return None
        low, high = high, 2 * high
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (low, middle) if suffice(middle) else (middle, high)
    return high
