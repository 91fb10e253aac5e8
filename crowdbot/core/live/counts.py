"""Counters of a live run."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass
class LiveCounts:
    """Counts of steps, missed commands and lag in a live run.

    Attributes:
        steps: planner steps so far; all robots take one together.
        missed: steps without a new command in time, summed over robots.
        refused: commands that were not finite, came from a client that does not drive, or were for
            another step.
        lag, most_lag: delay of the simulation behind its clock, s.
    """

    steps: int = 0
    missed: int = 0
    refused: int = 0
    lag: float = 0.0
    most_lag: float = 0.0
