"""Timing of a live run's steps."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

Missed = Literal["stop", "hold", "fail"]


@dataclass(frozen=True, kw_only=True)
class StepPolicy:
    """Timing of a live run's steps.

    Attributes:
        rate: simulated seconds per second; None waits for the command of each step.
        external_clock: True if an external clock triggers steps.
        budget: s to wait for a step's commands.
        missed: behaviour of a step without a command.
        hold: s of simulated time for which a command is valid if steps do not wait.
        wait: s to wait until each robot has a driver.
        epoch: ns added to all stamps.
    """

    rate: float | None = None
    external_clock: bool = False
    budget: float = 5.0
    missed: Missed = "stop"
    hold: float = 0.5
    wait: float = math.inf
    epoch: int = 0

    @property
    def lockstep(self) -> bool:
        """Return True if each step waits for its commands."""
        return self.rate is None and not self.external_clock
