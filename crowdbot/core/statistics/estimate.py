"""Estimate: a number with its interval, or why there is none; what kinds of outcomes there were."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

#: What can come of one score of one run.
#:
#: ``failed``: without a value because the planner failed or the run could not be made. Where such
#: a run has one it is ``ok``; in ranks it is worse than anything else all the same.
#: ``missing``: nobody has tried yet; not compared, but told.
Outcome = Literal["ok", "censored", "undefined", "failed", "missing"]
OUTCOMES: tuple[Outcome, ...] = ("ok", "censored", "undefined", "failed", "missing")


@dataclass(frozen=True, slots=True, kw_only=True)
class Estimate:
    """A number and the interval that covers the true one.

    Attributes:
        value: None where it does not exist; ``reason`` says why.
        low, high: ends of the interval; None where there is none, or it is open on that side.
        reason: why there is no value, or no interval; empty if there are both.
    """

    value: float | None = None
    low: float | None = None
    high: float | None = None
    reason: str = ""


NOTHING = Estimate(reason="not computed")


@dataclass(frozen=True, slots=True, kw_only=True)
class Counts:
    """How many runs ended in which way, as one score sees it; nothing is left out."""

    ok: int = 0
    censored: int = 0
    undefined: int = 0
    failed: int = 0
    missing: int = 0

    @property
    def tried(self) -> int:
        """All but the missing ones."""
        return self.ok + self.censored + self.undefined + self.failed
