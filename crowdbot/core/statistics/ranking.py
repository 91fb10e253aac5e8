"""The ranking rule: safety is a condition; efficiency and acceptance are weighed up.

A planner is ahead of another if it is worse in none of safety, efficiency and acceptance, and
better in efficiency or acceptance. A planner that is only safer is not ahead: robots that park or
quit are safe, too. Everything else is a tie, open, or a trade of one for the other. Verdicts are
about means, with Holm's correction for all tests of one call (`comparison`). The correction guards
against a false *better*; it would also hide a loss, and so help a false *ahead*. A loss therefore
stands in the way at its own p value already. Nor may few runs hide one: who gains in efficiency
must be shown to lose at most 0.05 in acceptance, and the other way round; else the pair is
open.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from crowdbot.core.statistics.comparison import Comparison, compare, with_verdict
from crowdbot.core.statistics.judged import loses_at_most
from crowdbot.core.statistics.sign_flip import holm
from crowdbot.core.statistics.table import Name, Table

Aspect = Literal["safety", "efficiency", "acceptance"]
Standing = Literal["ahead", "behind", "tied", "traded", "open"]

#: The score of each aspect: the first that the runs have.
SCORES: Mapping[Aspect, tuple[Name, ...]] = {
    "safety": (("contacts_per_km", "at_fault"),),
    "efficiency": (("safe_efficiency", "corrected"),),
    "acceptance": (("acceptance", "corrected"), ("intrusion", "rate")),
}
#: Largest loss in a score, in its unit, of a planner that is ahead by another one. Rates of
#: contacts and of intrusion have none: no loss of these is negligible in all crowds.
MARGINS: Mapping[Name, float] = {
    ("safe_efficiency", "corrected"): 0.05,
    ("acceptance", "corrected"): 0.05,
}


@dataclass(frozen=True, slots=True, kw_only=True)
class Ranked:
    """One planner beside another, by the rule.

    Attributes:
        planner, other: labels.
        standing: of ``planner``; ``traded``: better in one aspect, worse in another, of which at
            least one holds with Holm's correction; ``open``: better in one, and a loss in
            another of more than `MARGINS` is not excluded.
        aspects: aspect -> comparison, as far as the runs have the scores.
    """

    planner: str
    other: str
    standing: Standing
    aspects: Mapping[Aspect, Comparison]


def rank(table: Table, pairs: Iterable[tuple[str, str]], alpha: float = 0.05) -> tuple[Ranked, ...]:
    """Return the standing of each first planner beside the second.

    Args:
        table: table of the runs.
        pairs: labels.
        alpha: chance of any false verdict in all of these comparisons.
    """
    names = {aspect: _first(table, scores) for aspect, scores in SCORES.items()}
    tests = [(pair, a, name) for pair in pairs for a, name in names.items() if name is not None]
    compared = [compare(table, name, *pair) for pair, _, name in tests]
    tested = [i for i, (x, _) in enumerate(compared) if x.p is not None]
    p = np.array([compared[i][0].p for i in tested], dtype=float)
    corrected = dict(zip(tested, holm(p).tolist(), strict=True))
    sides: dict[tuple[str, str], list[_Side]] = {}
    for i, (pair, aspect, name) in enumerate(tests):
        one = with_verdict(*compared[i], corrected.get(i), alpha)
        sign = compared[i][1].sign if one.p is not None and one.p <= alpha else 0
        sides.setdefault(pair, []).append(_Side(aspect, name, one, sign))
    return tuple(
        Ranked(
            planner=a, other=b, standing=_standing(table, found, alpha),
            aspects={side.aspect: side.comparison for side in found},
        )
        for (a, b), found in sides.items()
    )  # fmt: skip


@dataclass(frozen=True, slots=True)
class _Side:
    """One aspect of a pair; ``sign`` is that of its difference, 0 unless p <= alpha by itself."""

    aspect: Aspect
    name: Name
    comparison: Comparison
    sign: int


def _first(table: Table, scores: Iterable[Name]) -> Name | None:
    return next((name for name in scores if name in table.names), None)


def _standing(table: Table, sides: Sequence[_Side], alpha: float) -> Standing:
    """Return the standing; the rule is the same from both planners' points of view."""
    weighed = [side for side in sides if side.aspect != "safety"]
    verdicts = {side.comparison.verdict for side in weighed}
    signs = {side.sign for side in sides}
    if "better" not in verdicts and "worse" not in verdicts:
        return "tied"
    if {-1, 1} <= signs:
        return "traded"
    ahead = "better" in verdicts
    if all(_little_lost(table, side, ahead, alpha) for side in weighed if not side.sign):
        return "ahead" if ahead else "behind"
    return "open"


def _little_lost(table: Table, side: _Side, ahead: bool, alpha: float) -> bool:
    """Return False if the planner that gains may lose more than its margin in this aspect."""
    margin = MARGINS.get(side.name)
    pair = (side.comparison.a, side.comparison.b)
    winner, other = pair if ahead else pair[::-1]
    return margin is None or loses_at_most(table, side.name, winner, other, margin, alpha=alpha)
