"""What people answer when asked, computed."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from crowdbot.core.interfaces import References
from crowdbot.core.questionnaires import TLX_SCALES, USE_ITEMS, Answer
from crowdbot.core.score import Score
from crowdbot.core.trajectory import Trajectories
from crowdbot.plugins.metrics.questionnaire import NASA_TLX, USE, NasaTlxSpec, UseSpec

#: Number of pairs of scales that are compared.
PAIRS = 15


@dataclass(frozen=True, slots=True)
class NasaTlx:
    """Needs the answers of a NASA-TLX form."""

    spec: NasaTlxSpec

    def score(self, run: Trajectories, refs: References) -> Sequence[Score]:
        """``raw``: mean rating; ``weighted``: by how often each scale was chosen."""
        del run
        label, sheet = NASA_TLX.label, refs.questionnaires
        if sheet is None or not any(r is not None for r in sheet.tlx_ratings.values()):
            return label.all_undefined("no_answers")
        ratings = _complete(sheet.tlx_ratings, 100.0)
        if ratings is None:
            return label.all_undefined("invalid_ratings")
        raw = label.ok("raw", sum(ratings) / len(ratings))
        if not any(w is not None for w in sheet.tlx_weights.values()):
            return [raw, label.undefined("weighted", "no_weights")]
        weights = _complete(sheet.tlx_weights, 5.0)
        if weights is None or sum(weights) != PAIRS or any(w != int(w) for w in weights):
            return [raw, label.undefined("weighted", "invalid_weights")]
        total = sum(w * r for w, r in zip(weights, ratings, strict=True))
        return [raw, label.ok("weighted", total / PAIRS)]


@dataclass(frozen=True, slots=True)
class Use:
    """Needs the answers of a USE form; items that do not apply are left out."""

    spec: UseSpec

    def score(self, run: Trajectories, refs: References) -> Sequence[Score]:
        """Mean item of each dimension."""
        del run
        given = {} if refs.questionnaires is None else refs.questionnaires.use
        return [self._dimension(name, given.get(name, ())) for name in USE.label.variants]

    def _dimension(self, name: str, items: Sequence[Answer]) -> Score:
        answers = [a for a in items if a is not None]
        if not answers:
            return USE.label.undefined(name, "no_answers")
        if len(items) != USE_ITEMS[name] or not all(1 <= a <= 7 for a in answers):
            return USE.label.undefined(name, "invalid_items")
        extras = {"answered": float(len(answers))}
        return USE.label.ok(name, sum(answers) / len(answers), extras)


def _complete(given: Mapping[str, Answer], most: float) -> list[float] | None:
    """An answer for each scale, 0 to ``most``; None if one is missing or outside."""
    values = [given.get(scale) for scale in TLX_SCALES]
    known = [v for v in values if v is not None and 0 <= v <= most]
    return known if len(known) == len(values) else None
