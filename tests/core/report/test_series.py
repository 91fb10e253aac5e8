"""What a series is summed up by, and which one stands for its metric."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import pytest

from crowdbot.core.report.series import Series, all_series
from crowdbot.core.results.results import Results
from crowdbot.core.results.rows import ScoreRow
from crowdbot.core.scoring.score_scale import ScoreScale
from crowdbot.core.statistics.table import Table
from tests.core.statistics.made_up_results import run


def rows(metric: str, variant: str, *values: float | None, **more: Any) -> list[ScoreRow]:
    fields = {"category": "a", "symbol": "X", "unit": "1", "better": "lower", "reason": ""} | more
    return [
        ScoreRow(
            run_id=str(i), metric=metric, variant=variant, value=v, lower=None, upper=None,
            status="undefined" if v is None else "ok", **fields,
        )
        for i, v in enumerate(values)
    ]  # fmt: skip


def series(scores: list[ScoreRow], named: Sequence[str] = (), **scales: ScoreScale) -> list[Series]:
    """What is shown of some scores of one planner; ``scales`` of corrected variants."""
    runs = tuple(run("a", f"s{i}", f"d{i}", run_id=str(i)) for i in range(9))
    known = {(metric, "corrected"): scale for metric, scale in scales.items()}
    return all_series(Table(Results(runs=runs, scores=tuple(scores), scales=known)), named)


YES_OR_NO = ScoreScale(minimum=0.0, maximum=1.0, integer=True)


@pytest.mark.parametrize(
    ("scale", "centre"),
    [
        (ScoreScale(), "mean"),
        (ScoreScale(minimum=0.0, integer=True), "mean"),
        (ScoreScale(minimum=0.0, maximum=1.0), "mean"),
        (YES_OR_NO, "share"),
        (ScoreScale(rate_over="way"), "rate"),
        (ScoreScale(rate_over="driven_way"), "mean"),  # the runs do not have it
    ],
)
@pytest.mark.parametrize("values", [(1.0, 2.0, 0.0), (0.0, 0.0, 9.0), (None,)])
def test_the_metric_alone_decides_the_centre(
    scale: ScoreScale, values: tuple[float | None, ...], centre: str
) -> None:
    scores = rows("m", "corrected", *values) + rows("m", "way", *(1.0 for _ in values))
    found = {s.variant: s for s in series(scores, m=scale)}
    assert found["corrected"].centre == centre
    assert found["corrected"].over == ("way" if centre == "rate" else "")
    assert found["way"].centre == "mean"


def test_headlines_and_plain_variants() -> None:
    scores = [
        *rows("has", "literal", 1.0), *rows("has", "corrected", 1.0), *rows("has", "extra", 1.0),
        *rows("without", "raw", 1.0), *rows("without", "literal", 1.0),
        *rows("stands_in", "corrected", None), *rows("stands_in", "restricted", 1.0),
    ]  # fmt: skip
    found = {s.name: s for s in series(scores)}
    headlines = {name for name, s in found.items() if s.headline}
    assert headlines == {("has", "corrected"), ("without", "literal"), ("stands_in", "restricted")}
    plain = {name for name, s in found.items() if s.plain}
    assert plain == {("has", "corrected"), ("without", "raw"), ("stands_in", "corrected")}


def test_known_categories_come_first_and_in_them_the_metrics_of_the_seed() -> None:
    scores = [
        *rows("a", "corrected", 1.0, category="questionnaire"),
        *rows("b", "corrected", 1.0, category="motion"),
        *rows("c", "corrected", 1.0, category="collision"),
        *rows("d", "corrected", 1.0, category="collision"),
        *rows("d", "literal", 1.0, category="collision"),
        *rows("e", "corrected", 1.0, category="task"),
    ]
    names = [f"{s.metric}.{s.variant}" for s in series(scores)]
    assert names == ["e.corrected", "d.corrected", "d.literal", "c.corrected", "b.corrected",
                     "a.corrected"]  # fmt: skip


def test_the_four_scores_are_a_category_of_their_own_and_come_first() -> None:
    scores = [
        *rows("push_work", "total", 1.0, category="burden"),
        *rows("push_work", "rate", 1.0, category="burden"),
        *rows("relative_jerk", "literal", 1.0, category="task"),
        *rows("safe_efficiency", "corrected", 1.0, category="task"),
    ]
    found = series(scores)
    assert [(s.metric, s.variant, s.category) for s in found] == [
        ("safe_efficiency", "corrected", "the four scores"),
        ("push_work", "rate", "the four scores"),
        ("relative_jerk", "literal", "task"),
        ("push_work", "total", "burden"),
    ]


def test_what_the_suite_names_comes_before_the_four_scores_in_its_order() -> None:
    scores = [
        *rows("safe_efficiency", "corrected", 1.0, category="task"),
        *rows("delay", "corrected", 1.0, category="task"),
        *rows("risk", "literal", 1.0, category="collision"),
        *rows("risk", "corrected", 1.0, category="collision"),
    ]
    found = series(scores, named=["risk", "not_scored", "delay"])
    assert [(s.metric, s.variant, s.category) for s in found] == [
        ("risk", "corrected", "named by the suite"),
        ("delay", "corrected", "named by the suite"),
        ("safe_efficiency", "corrected", "the four scores"),
        ("risk", "literal", "collision"),
    ]


def test_metrics_that_the_suite_names_come_first_in_its_order() -> None:
    scores = [
        *rows("safe_efficiency", "corrected", 1.0), *rows("a", "literal", 1.0),
        *rows("b", "corrected", 1.0), *rows("c", "corrected", 1.0), *rows("b", "literal", 1.0),
    ]  # fmt: skip
    found = [s.name for s in series(scores, named=("c", "b", "gone"))]
    assert found[:3] == [("c", "corrected"), ("b", "corrected"), ("safe_efficiency", "corrected")]
    assert sorted(found) == sorted({(s.metric, s.variant) for s in scores}), "each once"
