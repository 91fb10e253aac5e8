"""Series: one variant of one metric, in the order in which a report shows them."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import NamedTuple

from crowdbot.core.results.rows import ScoreRow

#: Categories that come first; the others follow by name.
_FIRST = ("task", "path efficiency", "effect on crowd", "collision", "similarity", "proximity")
#: Categories that no simulated run has data for.
_LAST = ("shared control", "questionnaire")


class Series(NamedTuple):
    """One variant of one metric.

    ``plain``: the corrected variant, or one of a metric that has no such variant. ``headline``:
    shown before anybody asks for more.
    """

    metric: str
    variant: str
    symbol: str
    category: str
    unit: str
    better: str
    plain: bool
    headline: bool

    @property
    def name(self) -> tuple[str, str]:
        """Metric and variant."""
        return self.metric, self.variant


def all_series(
    scores: Sequence[ScoreRow], headlines: Collection[tuple[str, str]]
) -> list[Series]:
    """Every variant of every metric in some scores.

    Args:
        scores: of all runs.
        headlines: (metric, variant) that stand for their metrics; a metric without one is
            represented by its plain variants.
    """
    labels = {(s.metric, s.variant): s for s in reversed(scores)}
    represented = {metric for metric, _ in headlines}
    found = []
    for name, label in labels.items():
        has_corrected = (label.metric, "corrected") in labels
        plain = label.variant == "corrected" if has_corrected else label.variant != "literal"
        headline = name in headlines if label.metric in represented else plain
        found.append(
            Series(
                metric=label.metric,
                variant=label.variant,
                symbol=label.symbol,
                category=label.category,
                unit=label.unit,
                better=label.better,
                plain=plain,
                headline=headline,
            )
        )
    return sorted(found, key=_place)


def _place(series: Series) -> tuple[int, str, str, bool, str]:
    ranks = {name: i for i, name in enumerate(_FIRST)} | {n: 99 for n in _LAST}
    rank = ranks.get(series.category, len(_FIRST))
    return (rank, series.category, series.metric, not series.plain, series.variant)
