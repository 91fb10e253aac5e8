"""Estimate: a number with its interval, or the reason for its absence; and counts of outcomes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

#: Possible outcomes of one score of one run. ``failed``: no value because the planner failed or the
#: run could not be made; a failed run with a value is ``ok``, but ranks below all others.
#: ``missing``: not run yet; reported but not compared.
Outcome = Literal["ok", "censored", "undefined", "failed", "missing"]
OUTCOMES: tuple[Outcome, ...] = ("ok", "censored", "undefined", "failed", "missing")


@dataclass(frozen=True, slots=True, kw_only=True)
class Estimate:
    """A number and its confidence interval.

    Attributes:
        value: None if it does not exist; ``reason`` says why.
        low, high: ends of the interval; None if missing or open on that side.
        reason: why there is no value or no interval; empty if both exist.
    """

    value: float | None = None
    low: float | None = None
    high: float | None = None
    reason: str = ""


NOTHING = Estimate(reason="not computed")


@dataclass(frozen=True, slots=True, kw_only=True)
class Counts:
    """Number of runs with each outcome, for one score; all runs are counted."""

    ok: int = 0
    censored: int = 0
    undefined: int = 0
    failed: int = 0
    missing: int = 0

    @property
    def tried(self) -> int:
        """Return the number of runs that are not missing."""
        return self.ok + self.censored + self.undefined + self.failed
