"""Series: one variant of one metric, in the order in which a report shows them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from crowdbot.core.scoring.four_scores import FOUR_SCORES, is_main, main_first
from crowdbot.core.statistics import Table, headline_names
from crowdbot.core.statistics.summary_estimator import Centre, centre_of

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


class Series(NamedTuple):
    """One variant of one metric.

    ``plain``: the corrected variant, or one of a metric that has no such variant. ``headline``:
    shown before anybody asks for more. ``centre``: what its runs are summed up by. ``over``: of a
    rate, the variant of the same metric that it is over.
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
    over: str = ""

    @property
    def name(self) -> tuple[str, str]:
        """Metric and variant."""
        return self.metric, self.variant


def all_series(table: Table, named: Sequence[str] = ()) -> list[Series]:
    """Every variant of every metric in some runs; those of the seed first in their category.

    The four scores are a category of their own, and come before all others; before them come the
    metrics that the suite names, with the variants that stand for them.

    Args:
        table: of all runs. A metric without a headline is represented by its plain variants.
        named: metrics of the suite, in its order.
    """
    headlines = set(headline_names(table))
    labels = {name: table.label(name) for name in table.names}
    represented = {metric for metric, _ in headlines}
    seeds = {metric for metric, variant in table.names if variant == "literal"}
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
                centre=centre_of(table, name),
                over=(table.exposure_name(name) or ("", ""))[1],
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


def _rank(category: str) -> tuple[int, str]:
    ranks = {name: i for i, name in enumerate(_FIRST)} | dict.fromkeys(_LAST, 99)
    return ranks.get(category, len(_FIRST)), category


def _place(series: Series) -> tuple[str, bool, str]:
    return series.metric, not series.plain, series.variant
