"""Series: one variant of one metric, in the order in which a report shows them."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from typing import Literal, NamedTuple

from crowdbot.core.results.rows import ScoreRow
from crowdbot.core.scoring.four_scores import FOUR_SCORES, is_main, main_first

#: Categories that come first; the others follow by name.
_FIRST = (
    FOUR_SCORES,
    "task",
    "burden",
    "path efficiency",
    "effect on crowd",
    "collision",
    "similarity",
    "proximity",
)
#: Categories that no simulated run has data for.
_LAST = ("shared control", "questionnaire")

#: Category of the metrics that the suite names.
NAMED = "named by the suite"

Centre = Literal["share", "mean", "interquartile mean"]


class Series(NamedTuple):
    """One variant of one metric.

    ``plain``: the corrected variant, or one of a metric that has no such variant. ``headline``:
    shown before anybody asks for more. ``centre``: what its runs are summed up by.
    """

    metric: str
    variant: str
    symbol: str
    category: str
    unit: str
    better: str
    plain: bool
    headline: bool
    centre: Centre

    @property
    def name(self) -> tuple[str, str]:
        """Metric and variant."""
        return self.metric, self.variant


def all_series(
    scores: Sequence[ScoreRow],
    headlines: Collection[tuple[str, str]],
    ranges: Mapping[str, str],
    named: Sequence[str] = (),
) -> list[Series]:
    """Every variant of every metric in some scores; those of the seed first in their category.

    The four scores are a category of their own, and come before all others; before them come the
    metrics that the suite names, with the variants that stand for them.

    Args:
        scores: of all runs.
        headlines: (metric, variant) that stand for their metrics; a metric without one is
            represented by its plain variants.
        ranges: metric -> its range, as its card says.
        named: metrics of the suite, in its order.
    """
    labels = {(s.metric, s.variant): s for s in reversed(scores)}
    represented = {metric for metric, _ in headlines}
    values = _values(scores)
    seeds = {s.metric for s in scores if s.variant == "literal"}
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
                category=FOUR_SCORES if is_main(*name) else label.category,
                unit=label.unit,
                better=label.better,
                plain=plain,
                headline=headline,
                centre=_centre(ranges.get(label.metric, ""), values.get(name, [])),
            )
        )
    found.sort(key=lambda s: (*_rank(s.category), s.metric not in seeds, *_place(s)))
    return _named_first(main_first(found, lambda s: s.name), named)


def _named_first(found: list[Series], named: Sequence[str]) -> list[Series]:
    places = {metric: i for i, metric in enumerate(named)}
    first = [s._replace(category=NAMED) for s in found if s.headline and s.metric in places]
    first.sort(key=lambda s: places[s.metric])
    taken = {s.name for s in first}
    return [*first, *(s for s in found if s.name not in taken)]


def _centre(range_: str, values: Sequence[float]) -> Centre:
    """What sums up a series.

    The middle half has no room for rare events: nine runs without a collision and one with three
    would be no collision at all. So counts, and what is zero in most runs, have their mean. So have
    scores that are 0 for a failure ("0, or ..."): a quarter of failures would be trimmed off.
    """
    if range_.startswith("0 or 1"):
        return "share"
    rare = sum(value == 0 for value in values) > len(values) / 2
    return "mean" if rare or range_.startswith("0, ") else "interquartile mean"


def _values(scores: Sequence[ScoreRow]) -> dict[tuple[str, str], list[float]]:
    found: dict[tuple[str, str], list[float]] = {}
    for s in scores:
        if s.value is not None:
            found.setdefault((s.metric, s.variant), []).append(s.value)
    return found


def _rank(category: str) -> tuple[int, str]:
    ranks = {name: i for i, name in enumerate(_FIRST)} | dict.fromkeys(_LAST, 99)
    return ranks.get(category, len(_FIRST)), category


def _place(series: Series) -> tuple[str, bool, str]:
    return series.metric, not series.plain, series.variant
