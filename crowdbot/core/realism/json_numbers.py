"""Numbers in JSON, where an unknown one is null."""

from __future__ import annotations

import math


def rounded(value: float, digits: int) -> float | None:
    """Return a number with some digits after the point; None unless it is finite."""
    return round(float(value), digits) if math.isfinite(value) else None


def number_or_nan(value: float | None) -> float:
    """Return a number that `rounded` wrote; NaN for None."""
    return math.nan if value is None else float(value)
