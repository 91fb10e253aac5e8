"""The four scores that answer whether a planner is good; everything else is detail.

One is primary: it orders planners. Three stand beside it and say at whose cost. Each has an
adversary that fools the other three; docs/explanation/four_scores.md has the argument. The
correction for multiple tests is for these four: who looks at 120 numbers finds something.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import NamedTuple, TypeVar

_Item = TypeVar("_Item")

#: What the group is called wherever it is shown.
FOUR_SCORES = "the four scores"


class MainScore(NamedTuple):
    """What it stands for, and the metric and variant that measure it."""

    role: str
    metric: str
    variant: str = "corrected"


PRIMARY = MainScore("safe efficiency", "safe_efficiency")
MAIN_SCORES = (
    PRIMARY,
    MainScore("contacts", "contacts_per_km"),
    MainScore("burden", "push_work", "rate"),
    MainScore("comfort", "intrusion", "rate"),
)
_PLACES = {(s.metric, s.variant): place for place, s in enumerate(MAIN_SCORES)}


def is_main(metric: str, variant: str) -> bool:
    """Whether a score is one of the four."""
    return (metric, variant) in _PLACES


def main_first(items: Iterable[_Item], name: Callable[[_Item], tuple[str, str]]) -> list[_Item]:
    """The four scores in their order, then all others in theirs.

    Args:
        items: whatever stands for scores.
        name: metric and variant of an item.
    """
    return sorted(items, key=lambda item: _PLACES.get(name(item), len(_PLACES)))
