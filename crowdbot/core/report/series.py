"""Series: one variant of one metric, in the report's order."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from crowdbot.core.scoring.four_scores import FOUR_SCORES, beside_main, main_first
from crowdbot.core.statistics.summary import headline_names
from crowdbot.core.statistics.summary_estimator import Centre, centre_of
from crowdbot.core.statistics.table import Table

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
#: Categories without data in simulated runs.
_LAST = ("shared control", "questionnaire")

#: Category of the metrics that the suite names.
NAMED = "named by the suite"


class Series(NamedTuple):
    """Values of one variant of one metric, by planner and scenario.

    ``plain``: the corrected variant, or any if the metric has none. ``headline``: shown by default.
    ``centre``: the summary of its runs. ``over``: for a rate, the variant by which it is divided.
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
        """Return metric and variant."""
        return self.metric, self.variant


def all_series(table: Table, named: Sequence[str] = ()) -> list[Series]:
    """Return every variant of every metric in some runs; the original ones first in their category.

    The four main scores form a category before all others; before them come the metrics that the
    suite names, with their headline variants.

    Args:
        table: table of all runs. A metric without a headline is represented by its plain variants.
        named: metrics that the suite names, in order.
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
                category=FOUR_SCORES if beside_main(*name) else label.category,
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


def _named_first(series: list[Series], named: Sequence[str]) -> list[Series]:
    places = {metric: i for i, metric in enumerate(named)}
    first = [s._replace(category=NAMED) for s in series if s.headline and s.metric in places]
    first.sort(key=lambda s: places[s.metric])
    taken = {s.name for s in first}
    return [*first, *(s for s in series if s.name not in taken)]


def _rank(category: str) -> tuple[int, str]:
    ranks = {name: i for i, name in enumerate(_FIRST)} | dict.fromkeys(_LAST, 99)
    return ranks.get(category, len(_FIRST)), category


def _place(series: Series) -> tuple[str, bool, str]:
    return series.metric, not series.plain, series.variant
