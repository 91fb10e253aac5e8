"""The four main scores, which show if a planner is good; all others are details.

One is primary and orders planners. The other three show side effects on people. Each prevents a
cheat that the other three miss, see docs/explanation/four_scores.md. The correction for multiple
tests covers these four: among 120 numbers, some differ by chance.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import NamedTuple, TypeVar

_Item = TypeVar("_Item")

#: Name of the group wherever it is shown.
FOUR_SCORES = "the four scores"


class MainScore(NamedTuple):
    """A main score: its meaning, and the metric and variant that measure it."""

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
#: Shown beside the primary score, but not tested: what people would say.
BESIDE_PRIMARY = MainScore("acceptance", "acceptance")
SHOWN = (PRIMARY, BESIDE_PRIMARY, *MAIN_SCORES[1:])
_PLACES = {(s.metric, s.variant): place for place, s in enumerate(SHOWN)}
_MAIN = frozenset((s.metric, s.variant) for s in MAIN_SCORES)


def is_main(metric: str, variant: str) -> bool:
    """Return True if a score is one of the four."""
    return (metric, variant) in _MAIN


def beside_main(metric: str, variant: str) -> bool:
    """Return True if a score is shown with the four: one of them, or acceptance."""
    return (metric, variant) in _PLACES


def name_of(metric: str, variant: str) -> str:
    """Return the name of a score for readers: its role if it is shown with the four."""
    return next((s.role for s in SHOWN if (s.metric, s.variant) == (metric, variant)), metric)


def main_first(items: Iterable[_Item], name: Callable[[_Item], tuple[str, str]]) -> list[_Item]:
    """Return the four scores in their order, acceptance second, then all others in theirs.

    Args:
        items: items that represent scores.
        name: metric and variant of an item.
    """
    return sorted(items, key=lambda item: _PLACES.get(name(item), len(_PLACES)))
