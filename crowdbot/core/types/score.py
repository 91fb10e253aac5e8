"""Score: one metric's value, variant, unit and status for one run."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Literal

from crowdbot.dsl.spec.metric_component import Better

Status = Literal["ok", "undefined", "censored"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Score:
    """One score: a value if and only if ``status`` is ``ok``.

    Otherwise a reason and perhaps bounds.

    ``extras`` holds further numbers that help to read the value; ``parameters`` the metric's
    parameters.
    """

    metric: str
    symbol: str
    category: str
    variant: str
    unit: str
    better: Better
    status: Status = "ok"
    value: float | None = None
    reason: str = ""
    lower: float | None = None
    upper: float | None = None
    extras: Mapping[str, float] = field(default_factory=dict)
    parameters: Mapping[str, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        if (self.value is not None) != (self.status == "ok"):
            raise ValueError(f"{self.metric}.{self.variant}: a value goes with status ok only")
        for number in (self.value, self.lower, self.upper, *self.extras.values()):
            if number is not None and not math.isfinite(number):
                raise ValueError(f"{self.metric}.{self.variant}: {number} must not escape")
