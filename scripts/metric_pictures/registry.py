"""Which function draws which metric."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from scripts.metric_pictures.figure import Figure
    from scripts.metric_pictures.world import World

    Draw = Callable[[World, str], Figure]


@dataclass(frozen=True)
class Drawing:
    """How a metric is drawn, and what the picture shows in one sentence."""

    draw: Draw
    shows: str


#: Metric -> drawing.
DRAWINGS: dict[str, Drawing] = {}


def draws(metric: str, shows: str) -> Callable[[Draw], Draw]:
    """Say that a function draws a metric."""

    def remember(draw: Draw) -> Draw:
        assert metric not in DRAWINGS, metric
        DRAWINGS[metric] = Drawing(draw, shows)
        return draw

    return remember
