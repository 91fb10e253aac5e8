"""Scoring of questionnaires."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from crowdbot.plugin import References, Score, ScoreFactory, Trajectories
from crowdbot.plugin.for_metrics import TLX_SCALES, USE_ITEMS, Answer
from crowdbot.plugins.metrics.questionnaire import NASA_TLX, USE, NasaTlxSpec, UseSpec

#: Number of pairs of scales that are compared.
PAIRS = 15


@dataclass(frozen=True, slots=True)
class NasaTlx:
    """Scores ``nasa_tlx``. Needs the answers of a NASA-TLX form."""

    spec: NasaTlxSpec

    def score(self, run: Trajectories, refs: References) -> Sequence[Score]:
        """Score ``raw``: mean rating; ``weighted``: by how often each scale was chosen."""
        del run
        factory, sheet = ScoreFactory(NASA_TLX), refs.questionnaires
        if sheet is None or not any(r is not None for r in sheet.tlx_ratings.values()):
            return factory.all_undefined("no_answers")
        ratings = _complete(sheet.tlx_ratings, 100.0)
        if ratings is None:
            return factory.all_undefined("invalid_ratings")
        raw = factory.ok("raw", sum(ratings) / len(ratings))
        if not any(w is not None for w in sheet.tlx_weights.values()):
            return [raw, factory.undefined("weighted", "no_weights")]
        weights = _complete(sheet.tlx_weights, 5.0)
        if weights is None or sum(weights) != PAIRS or any(w != int(w) for w in weights):
            return [raw, factory.undefined("weighted", "invalid_weights")]
        total = sum(w * r for w, r in zip(weights, ratings, strict=True))
        return [raw, factory.ok("weighted", total / PAIRS)]


@dataclass(frozen=True, slots=True)
class Use:
    """Scores ``use``. Needs the answers of a USE form; items that do not apply are left out."""

    spec: UseSpec

    def score(self, run: Trajectories, refs: References) -> Sequence[Score]:
        """Score the mean item of each dimension."""
        del run
        given = {} if refs.questionnaires is None else refs.questionnaires.use
        return [self._dimension(name, given.get(name, ())) for name in ScoreFactory(USE).variants]

    def _dimension(self, name: str, items: Sequence[Answer]) -> Score:
        answers = [a for a in items if a is not None]
        if not answers:
            return ScoreFactory(USE).undefined(name, "no_answers")
        if len(items) != USE_ITEMS[name] or not all(1 <= a <= 7 for a in answers):
            return ScoreFactory(USE).undefined(name, "invalid_items")
        extras = {"answered": float(len(answers))}
        return ScoreFactory(USE).ok(name, sum(answers) / len(answers), extras)


def _complete(given: Mapping[str, Answer], most: float) -> list[float] | None:
    """Return an answer per scale, 0 to ``most``; None if one is missing or out of range."""
    values = [given.get(scale) for scale in TLX_SCALES]
    known = [v for v in values if v is not None and 0 <= v <= most]
    return known if len(known) == len(values) else None
