"""Orders of planners: by the ranking rule, and by three other plausible rules beside it."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence, Set
from dataclasses import dataclass
from itertools import combinations

from crowdbot.core.statistics.ranking import SCORES, Aspect, Ranked, Standing, rank
from crowdbot.core.statistics.table import Table

#: Name of the ranking rule where a metric may decide the order instead.
RULE = "rule"


@dataclass(frozen=True, slots=True, kw_only=True)
class Order:
    """Ranks of planners by one rule.

    Attributes:
        name, text: of the rule, in a few words and in a sentence.
        ranks: planner -> 1 + number of planners that are ahead of it; equal ranks are ties.
    """

    name: str
    text: str
    ranks: Mapping[str, int]

    def shares_rank(self, planner: str) -> bool:
        """Return True if another planner has the same rank."""
        return list(self.ranks.values()).count(self.ranks.get(planner, 0)) > 1


@dataclass(frozen=True, slots=True, kw_only=True)
class Orders:
    """Orders by all rules, the ranking rule first.

    Attributes:
        pairs: standing of each pair of planners by the ranking rule.
        missing: aspects that no run has a score of; no rule orders without them.
    """

    orders: tuple[Order, ...]
    pairs: tuple[Ranked, ...]
    missing: tuple[Aspect, ...] = ()

    @property
    def rule(self) -> Order:
        """Return the order by the ranking rule."""
        return self.orders[0]

    @property
    def planners(self) -> list[str]:
        """Return all planners, the best by the ranking rule first."""
        return sorted(self.rule.ranks, key=lambda planner: (self.rule.ranks[planner], planner))

    @property
    def verdict(self) -> str:
        """Return the result of the ranking rule as a sentence without a full stop."""
        if self.missing:
            return f"the ranking rule needs scores that no run has: {', '.join(self.missing)}"
        if not self.pairs:
            return "one planner alone has no rank"
        apart = [x for x in map(_led, self.pairs) if x is not None]
        sentences = [
            f"{first} is ahead of {', '.join(other for a, other in apart if a == first)}"
            for first in dict.fromkeys(a for a, _ in apart)
        ]
        rest = len(self.pairs) - len(apart)
        if not sentences:
            return "no planner is ahead of another by the ranking rule"
        return "; ".join(sentences) + (
            f"; {rest} of {len(self.pairs)} pairs have no order" if rest else ""
        )


def orders(table: Table, marks: Set[str] = frozenset(), alpha: float = 0.05) -> Orders:
    """Return the orders of a table's planners by all rules.

    Args:
        table: table of the runs.
        marks: floors and ceilings; comparisons with them are corrected among themselves, so that
            running them costs the others no power.
        alpha: chance of any false verdict among the others.
    """
    pairs = list(combinations(table.planners, 2))
    own = [pair for pair in pairs if not set(pair) & marks]
    found = rank(table, own, alpha) + rank(table, [p for p in pairs if p not in own], alpha)
    held = {aspect for pair in found for aspect in pair.aspects}
    missing = tuple(aspect for aspect in SCORES if pairs and aspect not in held)
    decided = () if missing else found
    return Orders(
        orders=tuple(
            Order(name=name, text=text, ranks=_ranks(table.planners, decided, decide))
            for name, (text, decide) in _RULES.items()
        ),
        pairs=decided,
        missing=missing,
    )


def _by_rule(pair: Ranked) -> Standing:
    return pair.standing


def _by_first(*aspects: Aspect) -> Callable[[Ranked], Standing]:
    """Return a rule that orders pairs by their first aspect with a significant difference."""

    def decide(pair: Ranked) -> Standing:
        for aspect in aspects:
            verdict = pair.aspects[aspect].verdict if aspect in pair.aspects else "not ranked"
            if verdict in ("better", "worse"):
                return "ahead" if verdict == "better" else "behind"
        return "tied"

    return decide


#: Name -> sentence, decision about a pair; the first is the ranking rule.
_RULES: Mapping[str, tuple[str, Callable[[Ranked], Standing]]] = {
    "the ranking rule": (
        "Ahead is who is worse in none of safety, efficiency and acceptance, and better in "
        "efficiency or acceptance, with a loss of more than 0.05 in the other excluded.",
        _by_rule,
    ),
    "efficiency alone": ("Better in safe efficiency.", _by_first("efficiency")),
    "acceptance alone": ("Better in acceptance.", _by_first("acceptance")),
    "safety first": (
        "Fewer contacts at fault; where these are alike more efficient; then more accepted.",
        _by_first("safety", "efficiency", "acceptance"),
    ),
}


def _ranks(
    planners: Sequence[str], pairs: Sequence[Ranked], decide: Callable[[Ranked], Standing]
) -> dict[str, int]:
    ranks = dict.fromkeys(planners, 1)
    for pair in pairs:
        standing = decide(pair)
        if standing in ("ahead", "behind"):
            ranks[pair.other if standing == "ahead" else pair.planner] += 1
    return ranks


def _led(pair: Ranked) -> tuple[str, str] | None:
    """Return who is ahead of whom; None if the pair has no order."""
    if pair.standing == "ahead":
        return pair.planner, pair.other
    return (pair.other, pair.planner) if pair.standing == "behind" else None
