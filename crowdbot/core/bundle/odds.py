"""The probability of detecting edited runs of a bundle by repeating a sample of its runs."""

from __future__ import annotations

from math import comb

#: Shares of edited runs for which odds are given, besides a single run.
_SHARES = (0.02, 0.1)


def odds_of_finding(runs: int, again: int) -> dict[int, float]:
    """Return number of edited runs -> probability that at least one of them is repeated.

    Args:
        runs: runs of the bundle.
        again: runs that are made again, drawn without replacement.
    """
    edited = dict.fromkeys([1, *(round(runs * share) for share in _SHARES)])
    return {
        k: 1.0 - comb(runs - k, again) / comb(runs, again)
        for k in edited
        if 1 <= k <= runs and 0 <= again <= runs
    }
