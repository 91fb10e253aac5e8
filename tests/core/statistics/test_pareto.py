"""The Pareto view: polite and impolite planners, dominated ones, intervals, plots."""

from __future__ import annotations

from itertools import pairwise
from types import SimpleNamespace
from typing import Any

import pytest

from crowdbot.core.statistics.estimate import Estimate
from crowdbot.core.statistics.pareto import HEIGHT, WIDTH, label_heights, pareto


def summary(**planners: tuple[float, float]) -> Any:
    """Planner -> safe efficiency and acceptance, each ± 0.1."""
    scores = []
    for planner, values in planners.items():
        for metric, value in zip(("safe_efficiency", "acceptance"), values, strict=True):
            mean = Estimate(value=value, low=value - 0.1, high=value + 0.1)
            scores.append(
                SimpleNamespace(metric=metric, variant="corrected", planner=planner, mean=mean)
            )
    return SimpleNamespace(scores=tuple(scores))


def test_neither_the_fast_nor_the_polite_planner_is_dominated() -> None:
    fast, polite, slow = pareto(summary(polite=(0.7, 0.8), fast=(0.9, 0.4), slow=(0.3, 0.5)))
    assert (fast.planner, polite.planner, slow.planner) == ("fast", "polite", "slow")
    assert fast.dominated_by == polite.dominated_by == ()
    assert slow.dominated_by == ("polite",)
    assert slow.surely
    assert slow.text == "dominated by polite, beyond the intervals"


def test_a_lead_within_the_intervals_is_marked_as_such() -> None:
    _, second = pareto(summary(a=(0.7, 0.7), b=(0.65, 0.69)))
    assert second.text == "dominated by a, within the intervals"


def test_equal_planners_do_not_dominate_each_other() -> None:
    assert [p.dominated_by for p in pareto(summary(a=(0.5, 0.5), b=(0.5, 0.5)))] == [(), ()]


def test_one_planner_or_one_score_is_no_view() -> None:
    assert pareto(summary(a=(0.5, 0.5))) == ()
    two = summary(a=(0.5, 0.5), b=(0.4, 0.6))
    two.scores = tuple(s for s in two.scores if s.metric == "acceptance")
    assert pareto(two) == ()


@pytest.mark.parametrize("value", [0.0, 0.05, 0.5, 1.0])
def test_everything_is_drawn_inside(value: float) -> None:
    for point in pareto(summary(a=(value, value), b=(0.5, 0.4))):
        at = point.plot
        assert all(0.0 <= at[k] <= WIDTH for k in ("x", "x0", "x1"))
        assert all(0.0 <= at[k] <= HEIGHT for k in ("y", "y0", "y1"))
        assert at["x0"] <= at["x"] <= at["x1"]
        assert at["y1"] <= at["y"] <= at["y0"]


def test_names_of_planners_that_are_alike_do_not_lie_over_each_other() -> None:
    points = pareto(summary(a=(0.9, 0.3), b=(0.91, 0.3), c=(0.7, 0.31), d=(0.5, 0.8)))
    heights = sorted(label_heights(points).values())
    assert len(heights) == 4
    assert all(low - high >= 14.0 for high, low in pairwise(heights))
    assert all(label_heights(points)[p.planner] <= p.plot["y"] - 8.0 for p in points)
