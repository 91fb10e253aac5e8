"""Pareto view of planners: safe efficiency against acceptance.

A planner is dominated if another one is at least as good in both and better in one. Efficiency
alone prefers robots that do not give way; acceptance alone prefers robots that hardly drive.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from crowdbot.core.scoring.four_scores import BESIDE_PRIMARY, PRIMARY
from crowdbot.core.statistics.estimate import Estimate
from crowdbot.core.statistics.summary import Summary

#: Size of the plot, and its margins to the left and below, px; both axes go from 0 to 1.
WIDTH, HEIGHT, _LEFT, _BELOW, _EDGE = 420.0, 320.0, 46.0, 40.0, 14.0
#: Height of a line of text, px.
_LINE = 14.0


@dataclass(frozen=True, slots=True, kw_only=True)
class ParetoPoint:
    """A planner's means of both scores.

    Attributes:
        planner: name of the planner.
        efficiency, acceptance: means with their intervals.
        dominated_by: planners that are at least as good in both and better in one.
        surely: True if one of them is better in both beyond all intervals.
    """

    planner: str
    efficiency: Estimate
    acceptance: Estimate
    dominated_by: tuple[str, ...] = ()
    surely: bool = False

    @property
    def text(self) -> str:
        """Return who dominates the planner, or that none does."""
        if not self.dominated_by:
            return "not dominated"
        how = "beyond the intervals" if self.surely else "within the intervals"
        return f"dominated by {', '.join(self.dominated_by)}, {how}"

    @property
    def plot(self) -> dict[str, float]:
        """Return px: centre x, y and ends x0, x1, y0, y1 of the intervals."""
        x0, x, x1 = (_x(v) for v in _ends(self.efficiency))
        y0, y, y1 = (_y(v) for v in _ends(self.acceptance))
        return {"x": x, "x0": x0, "x1": x1, "y": y, "y0": y0, "y1": y1}


def pareto(summary: Summary) -> tuple[ParetoPoint, ...]:
    """Return planners with both scores, the most efficient first; empty for fewer than two."""
    found: dict[str, dict[str, Estimate]] = {}
    for score in summary.scores:
        for main in (PRIMARY, BESIDE_PRIMARY):
            same = (score.metric, score.variant) == (main.metric, main.variant)
            if same and score.mean.value is not None:
                found.setdefault(score.planner, {})[main.metric] = score.mean
    points = [
        ParetoPoint(
            planner=planner,
            efficiency=both[PRIMARY.metric],
            acceptance=both[BESIDE_PRIMARY.metric],
        )
        for planner, both in found.items()
        if len(both) == 2
    ]
    if len(points) < 2:
        return ()
    marked = [_marked(point, points) for point in points]
    return tuple(sorted(marked, key=lambda p: (-(p.efficiency.value or 0.0), p.planner)))


def label_heights(points: Sequence[ParetoPoint]) -> dict[str, float]:
    """Return the y position of each planner's name beside its point, px, without overlap."""
    heights, most = dict[str, float](), HEIGHT
    for point in sorted(points, key=lambda p: (-p.plot["y"], p.planner)):
        most = min(point.plot["y"] - 8.0, most - _LINE)
        heights[point.planner] = round(most, 1)
    return heights


def _marked(point: ParetoPoint, points: Sequence[ParetoPoint]) -> ParetoPoint:
    better = [other for other in points if _dominates(other, point)]
    return ParetoPoint(
        planner=point.planner,
        efficiency=point.efficiency,
        acceptance=point.acceptance,
        dominated_by=tuple(sorted(other.planner for other in better)),
        surely=any(
            _above(o.efficiency, point.efficiency) and _above(o.acceptance, point.acceptance)
            for o in better
        ),
    )


def _dominates(a: ParetoPoint, b: ParetoPoint) -> bool:
    ours = a.efficiency.value or 0.0, a.acceptance.value or 0.0
    theirs = b.efficiency.value or 0.0, b.acceptance.value or 0.0
    return ours != theirs and ours[0] >= theirs[0] and ours[1] >= theirs[1]


def _above(a: Estimate, b: Estimate) -> bool:
    """Return True if the whole interval of a is above that of b."""
    return a.low is not None and b.high is not None and a.low > b.high


def _ends(estimate: Estimate) -> tuple[float, float, float]:
    """Return low end, value and high end within 0 and 1; the value where an end is missing."""
    value = estimate.value or 0.0
    ends = (estimate.low, value, estimate.high)
    low, middle, high = (min(1.0, max(0.0, value if v is None else v)) for v in ends)
    return low, middle, high


def _x(value: float) -> float:
    return round(_LEFT + value * (WIDTH - _LEFT - _EDGE), 1)


def _y(value: float) -> float:
    return round(HEIGHT - _BELOW - value * (HEIGHT - _BELOW - _EDGE), 1)
