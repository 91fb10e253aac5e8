"""The ranking rule: safety is a condition; efficiency and acceptance are weighed up.

A planner is ahead of another if it is worse in none of safety, efficiency and acceptance, and
better in efficiency or acceptance. A planner that is only safer is not ahead: robots that park or
quit are safe, too. Everything else is a tie, or a trade of one for the other. Verdicts are about
means, with Holm's correction for all tests of one call (`comparison`).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Literal

import numpy as np

from crowdbot.core.statistics.comparison import Comparison, Verdict, compare, with_verdict
from crowdbot.core.statistics.sign_flip import holm
from crowdbot.core.statistics.table import Name, Table

Aspect = Literal["safety", "efficiency", "acceptance"]
Standing = Literal["ahead", "behind", "tied", "traded"]

#: The score of each aspect: the first that the runs have.
SCORES: Mapping[Aspect, tuple[Name, ...]] = {
    "safety": (("contacts_per_km", "at_fault"),),
    "efficiency": (("safe_efficiency", "corrected"),),
    "acceptance": (("acceptance", "corrected"), ("intrusion", "rate")),
}


@dataclass(frozen=True, slots=True, kw_only=True)
class Ranked:
    """One planner beside another, by the rule.

    Attributes:
        planner, other: labels.
        standing: of ``planner``; ``traded``: better in one aspect, worse in another.
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
    wanted = [(pair, a, name) for pair in pairs for a, name in names.items() if name is not None]
    found = [compare(table, name, *pair) for pair, _, name in wanted]
    tested = [i for i, (x, _) in enumerate(found) if x.p is not None]
    p = dict(zip(tested, holm(np.array([found[i][0].p for i in tested], dtype=float)), strict=True))
    apart: dict[tuple[str, str], dict[Aspect, Comparison]] = {}
    for i, (pair, aspect, _) in enumerate(wanted):
        held = p.get(i)
        one = with_verdict(*found[i], None if held is None else float(held), alpha)
        apart.setdefault(pair, {})[aspect] = one
    return tuple(
        Ranked(planner=a, other=b, aspects=aspects, standing=_standing(aspects))
        for (a, b), aspects in apart.items()
    )


def _first(table: Table, scores: Iterable[Name]) -> Name | None:
    return next((name for name in scores if name in table.names), None)


def _standing(aspects: Mapping[Aspect, Comparison]) -> Standing:
    verdicts: dict[Aspect, Verdict] = {aspect: x.verdict for aspect, x in aspects.items()}
    weighed = {v for aspect, v in verdicts.items() if aspect != "safety"}
    better, worse = "better" in weighed, "worse" in verdicts.values()
    loses = "worse" in weighed
    if better and worse:
        return "traded"
    if better:
        return "ahead"
    if not loses:
        return "tied"
    return "traded" if verdicts.get("safety") == "better" else "behind"
