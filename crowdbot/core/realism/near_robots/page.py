"""The page about responses to robots: index, table and distributions, in one file."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from crowdbot.core.realism.near_robots.features import FEATURES, SHARES
from crowdbot.core.realism.near_robots.measure import RobotRealism
from crowdbot.core.realism.near_robots.statistics import LEVELS, Cell
from crowdbot.core.realism.near_robots.tables import (
    CELL_HEAD,
    FEATURE_HEAD,
    cell_rows,
    feature_rows,
)
from crowdbot.core.support.html_page import render_page
from crowdbot.core.types.arrays import Array

_WIDTH, _BASE, _TOP = 240.0, 116.0, 14.0


def render(title: str, measured: Sequence[RobotRealism]) -> str:
    """Return the page as text; equal input gives equal text."""
    sources = list(dict.fromkeys(s for one in measured for s in one.reference.sources))
    return render_page(
        __package__,
        styles=("crowdbot.core.support:plain_page.css", "crowdbot.core.realism:page.css"),
        title=title,
        responses=[_section(one) for one in measured],
        sources=sources,
    )


def _section(one: RobotRealism) -> dict[str, Any]:
    return {
        "name": one.name,
        "index": f"{one.index:.2f}",
        "score": f"{one.score:.3f}",
        "floor": f"{one.floor:.3f}",
        "ceiling": f"{one.ceiling:.3f}",
        "tables": [
            ("Kinds of encounter and speed", CELL_HEAD, cell_rows(one)),
            ("Medians and shares", FEATURE_HEAD, feature_rows(one)),
        ],
        "figures": [
            (name.replace("_", " "), [_figure(one, name, cell) for cell in one.cells])
            for name in FEATURES
            if name not in SHARES
        ],
    }


def _figure(one: RobotRealism, name: str, cell: Cell) -> dict[str, str]:
    """Return the cumulative distributions of a feature."""
    recorded = one.reference.whole[cell].quantiles[name]
    own = one.statistics[cell].quantiles[name] if cell in one.statistics else recorded * np.nan
    known = np.concatenate([q[np.isfinite(q)] for q in (recorded, own)])
    low, high = (float(known.min()), float(known.max())) if len(known) else (0.0, 1.0)
    high = max(high, low + 1e-6)
    unit = FEATURES[name]
    return {
        "own": _curve(own, low, high),
        "real": _curve(recorded, low, high),
        "left": f"{low:.2f}",
        "right": f"{high:.2f} {unit}".strip(),
        "top": "95 %",
        "caption": " ".join(cell),
    }


def _curve(values: Array, low: float, high: float) -> str:
    if not np.isfinite(values).all():
        return ""
    points = zip(_WIDTH * (values - low) / (high - low), LEVELS, strict=True)
    return "".join(
        f"{'L' if k else 'M'}{x:.1f} {_BASE - (_BASE - _TOP) * float(level):.1f}"
        for k, (x, level) in enumerate(points)
    )
