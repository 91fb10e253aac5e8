"""Compare a claimed score with one that was computed here from the same trajectory."""

from __future__ import annotations

from crowdbot.core.bundle.tolerances import are_equal
from crowdbot.core.types.score import Score


def agree(a: Score, b: Score) -> bool:
    """Return True if two scores of one trajectory are the same up to rounding."""
    for name in ("status", "symbol", "category", "unit", "better", "reason"):
        if getattr(a, name) != getattr(b, name):
            return False
    ends = ((a.value, b.value), (a.lower, b.lower), (a.upper, b.upper))
    return all(
        x is y is None or (x is not None and y is not None and are_equal(x, y)) for x, y in ends
    )


def name_of(score: Score) -> str:
    """Return the name of a score: metric and variant."""
    return f"{score.metric}.{score.variant}"


def shown(score: Score) -> str:
    """Return a score's value as text, or the reason why it has none."""
    return f"{score.value!r}" if score.value is not None else f"{score.status} ({score.reason})"
