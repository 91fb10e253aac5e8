"""Scoring of questionnaires."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from crowdbot.plugin import References, Score, Trajectories
from crowdbot.plugin.for_metrics import TLX_SCALES, USE_ITEMS, Answer
from crowdbot.plugins.metrics.declared_build import DeclaredMetric, UndefinedError
from crowdbot.plugins.metrics.questionnaire import NasaTlxSpec, UseSpec

#: Number of pairs of scales that are compared.
PAIRS = 15


class NasaTlx(DeclaredMetric[NasaTlxSpec]):
    """Scores ``nasa_tlx``: mean rating (``raw``), and weighted by chosen scales (``weighted``).

    Needs the answers of a NASA-TLX form.
    """

    def _scores(self, _: Trajectories, refs: References) -> Sequence[Score]:
        sheet = refs.questionnaires
        if sheet is None or not any(r is not None for r in sheet.tlx_ratings.values()):
            raise UndefinedError("no_answers")
        ratings = _complete(sheet.tlx_ratings, 100.0)
        if ratings is None:
            raise UndefinedError("invalid_ratings")
        raw = self.factory.ok("raw", sum(ratings) / len(ratings))
        if not any(w is not None for w in sheet.tlx_weights.values()):
            return [raw, self.factory.undefined("weighted", "no_weights")]
        weights = _complete(sheet.tlx_weights, 5.0)
        if weights is None or sum(weights) != PAIRS or any(w != int(w) for w in weights):
            return [raw, self.factory.undefined("weighted", "invalid_weights")]
        total = sum(w * r for w, r in zip(weights, ratings, strict=True))
        return [raw, self.factory.ok("weighted", total / PAIRS)]


class Use(DeclaredMetric[UseSpec]):
    """Scores ``use``: the mean item of each dimension.

    Needs the answers of a USE form; items that do not apply are left out.
    """

    def _scores(self, _: Trajectories, refs: References) -> Sequence[Score]:
        given = {} if refs.questionnaires is None else refs.questionnaires.use
        return [self._dimension(name, given.get(name, ())) for name in self.factory.variants]

    def _dimension(self, name: str, items: Sequence[Answer]) -> Score:
        answers = [a for a in items if a is not None]
        if not answers:
            return self.factory.undefined(name, "no_answers")
        if len(items) != USE_ITEMS[name] or not all(1 <= a <= 7 for a in answers):
            return self.factory.undefined(name, "invalid_items")
        extras = {"answered": float(len(answers))}
        return self.factory.ok(name, sum(answers) / len(answers), extras)


def _complete(given: Mapping[str, Answer], most: float) -> list[float] | None:
    """Return an answer per scale, 0 to ``most``; None if one is missing or out of range."""
    values = [given.get(scale) for scale in TLX_SCALES]
    known = [v for v in values if v is not None and 0 <= v <= most]
    return known if len(known) == len(values) else None
