"""Compare claimed scores with those on new people, to find planners fitted to published draws."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from crowdbot.core.bundle.rerun_verdict import FINE, Rerun, RerunVerdict
from crowdbot.core.scoring.four_scores import MAIN_SCORES, MainScore
from crowdbot.core.types.score import Score

#: Probability with which an honest planner is called worse, over all main scores.
_LEVEL = 0.01
_FEWEST = 4  # pairs


@dataclass(frozen=True, slots=True, kw_only=True)
class FreshScore:
    """One main score in claimed runs, and in runs of the same scenarios with new people.

    Attributes:
        claimed, fresh: means over the pairs.
        pairs: number of scenarios with both values.
        p: probability of a mean this much worse if both are of one planner; 1 for too few pairs.
    """

    score: MainScore
    claimed: float
    fresh: float
    pairs: int
    p: float

    @property
    def is_worse(self) -> bool:
        """Return True if the new score is significantly worse."""
        return self.p < _LEVEL / len(MAIN_SCORES)

    def __str__(self) -> str:
        """Return one line."""
        verdict = ": worse than claimed" if self.is_worse else ""
        return (
            f"{self.score.metric}: claimed {self.claimed:.4g}, on new people {self.fresh:.4g} "
            f"({self.pairs} runs, p = {self.p:.2g}){verdict}"
        )


def with_fresh(verdict: RerunVerdict, fresh: Sequence[Rerun]) -> RerunVerdict:
    """Return the verdict with this comparison; a bundle whose scores are worse does not pass.

    Args:
        verdict: that on the bundle's own runs.
        fresh: runs of the bundle's scenarios with new people; each names the run it belongs to.
    """
    found = list(_fresh_scores(fresh))
    worse = [one for one in found if one.is_worse]
    findings = tuple(f"{one}; were the published draws learnt by heart?" for one in worse)
    outcome = verdict.outcome
    if outcome in FINE and worse:
        outcome = "worse on new people"
    lines = tuple(map(str, found)) or ("no main score has values in both",)
    return replace(verdict, outcome=outcome, findings=(*verdict.findings, *findings), fresh=lines)


def _fresh_scores(fresh: Sequence[Rerun]) -> Iterator[FreshScore]:
    for main in MAIN_SCORES:
        pairs = [
            (a.value, b.value, a.better)
            for run in fresh
            for a in [_of(main, run.claimed.scores)]
            for b in [_of(main, run.scores)]
            if a is not None and b is not None and a.value is not None and b.value is not None
        ]
        if pairs:
            signs = [1.0 if better == "higher" else -1.0 for *_, better in pairs]
            gains = [s * (a - b) for s, (a, b, _) in zip(signs, pairs, strict=True)]
            yield FreshScore(
                score=main,
                claimed=sum(a for a, _, _ in pairs) / len(pairs),
                fresh=sum(b for _, b, _ in pairs) / len(pairs),
                pairs=len(pairs),
                p=_chance(gains),
            )


def _of(main: MainScore, scores: Sequence[Score]) -> Score | None:
    return next((s for s in scores if (s.metric, s.variant) == (main.metric, main.variant)), None)


def _chance(gains: Sequence[float]) -> float:
    """Return the one-sided p value of a paired t test; 1 for too few pairs or no difference."""
    count = len(gains)
    mean = sum(gains) / count
    if count < _FEWEST or mean <= 0.0:
        return 1.0
    spread = math.sqrt(sum((g - mean) ** 2 for g in gains) / (count - 1))
    if spread == 0.0:
        return 0.0
    from scipy import stats

    return float(stats.t.sf(mean / (spread / math.sqrt(count)), count - 1))
