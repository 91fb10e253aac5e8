"""The page about crowds: numbers and curves against those of recorded people, in one file."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from crowdbot.core.realism.bins import EDGES, FEATURES, FLOWS, PAIR_EDGES, UNITS
from crowdbot.core.realism.measure import Realism
from crowdbot.core.realism.tables import rows
from crowdbot.core.support.html_page import render_page
from crowdbot.core.types.arrays import Array

_WIDTH, _HEIGHT, _BASE = 240.0, 130.0, 116.0
_TITLES = {
    "speed": "Speed",
    "acceleration": "Acceleration",
    "turning": "Turning rate",
    "nearest": "Nearest neighbour",
    "time_to_collision": "Time to collision",
}
_ONE_WAY = {"uni": "one direction", "counter": "counterflow"}


def render(title: str, crowds: Sequence[Realism]) -> str:
    """Return the page as text; equal input gives equal text."""
    sources = list(dict.fromkeys(s for c in crowds for s in c.reference.sources))
    return render_page(
        __package__,
        styles=("crowdbot.core.support:plain_page.css", "page.css"),
        title=title,
        crowds=[_section(c) for c in crowds],
        sources=sources,
    )


def _section(realism: Realism) -> dict[str, Any]:
    low, high = realism.low, realism.high
    return {
        "name": realism.name,
        "index": f"{realism.index:.2f}",
        "score": f"{realism.score:.3f}",
        "range": f" ({low:.3f} to {high:.3f} over draws)" * (low < high),
        "floor": f"{realism.floor:.3f}",
        "ceiling": f"{realism.ceiling:.3f}",
        "coverage": realism.coverage,
        "rows": rows(realism),
        "figures": [
            ("Fundamental diagram", [_diagram(realism, flow) for flow in FLOWS]),
            *((_TITLES[f], [_histogram(realism, f, cell) for cell in _cells(realism)])
              for f in FEATURES),
            ("Pair correlation", [_pairs(realism, cell) for cell in _cells(realism)]),
        ],
    }  # fmt: skip


def _cells(realism: Realism) -> list[tuple[str, str]]:
    return realism.reference.cells


def _histogram(realism: Realism, feature: str, cell: tuple[str, str]) -> dict[str, str]:
    edges = EDGES[feature]
    own = realism.statistics.histograms.get(cell, {}).get(feature, np.zeros(len(edges) - 1))
    recorded = realism.reference.whole.histograms[cell][feature]
    shares = [h / max(1e-12, float(np.sum(h))) for h in (own, recorded)]
    top = max(1e-9, *(float(s.max()) for s in shares))
    ends = edges[0], edges[-2] if edges[-1] > 100.0 else edges[-1]
    return {
        "own": _steps(shares[0], top),
        "real": _steps(shares[1], top),
        "left": f"{ends[0]:g}",
        "right": f"{ends[1]:g}{' and more' if edges[-1] > 100.0 else ''} {UNITS[feature]}",
        "top": f"{100 * top:.0f} %",
        "caption": f"{_ONE_WAY[cell[0]]}, {cell[1]} people/m²",
    }


def _pairs(realism: Realism, cell: tuple[str, str]) -> dict[str, str]:
    own = realism.statistics.pairs.get(cell, np.full(len(PAIR_EDGES) - 1, np.nan))
    recorded = realism.reference.whole.pairs[cell]
    top = max(1.0, float(np.nanmax(np.concatenate([own, recorded, [1.0]]))))
    return {
        "own": _steps(np.nan_to_num(own), top),
        "real": _steps(np.nan_to_num(recorded), top),
        "left": "0",
        "right": f"{PAIR_EDGES[-1]:g} m",
        "top": f"{top:.1f}",
        "caption": f"{_ONE_WAY[cell[0]]}, {cell[1]} people/m²",
    }


def _diagram(realism: Realism, flow: str) -> dict[str, str]:
    own = realism.statistics.diagram.get(flow, np.zeros((0, 2)))
    recorded = realism.reference.whole.diagram.get(flow, np.zeros((0, 2)))
    return {
        "own": _line(own, 2.5, 2.0),
        "real": _line(recorded, 2.5, 2.0),
        "left": "0",
        "right": "2.5 people/m²",
        "top": "2 m/s",
        "caption": f"mean speed, {_ONE_WAY[flow]}",
    }


def _steps(shares: Array, top: float) -> str:
    """Return a path along the tops of bins of equal width."""
    width = _WIDTH / len(shares)
    parts = []
    for k, share in enumerate(shares):
        y = _BASE - (_BASE - 14.0) * float(share) / top
        parts.append(f"{'M' if k == 0 else 'L'}{k * width:.1f} {y:.1f}H{(k + 1) * width:.1f}")
    return "".join(parts)


def _line(points: Array, right: float, top: float) -> str:
    return "".join(
        f"{'M' if k == 0 else 'L'}{_WIDTH * x / right:.1f} {_BASE - (_BASE - 14.0) * y / top:.1f}"
        for k, (x, y) in enumerate(points)
    )
