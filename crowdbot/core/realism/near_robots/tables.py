"""The index of a response as rows of text."""

from __future__ import annotations

import numpy as np

from crowdbot.core.realism.near_robots.features import FEATURES, SHARES
from crowdbot.core.realism.near_robots.measure import RobotRealism

_MIDDLE = 9  # of the 19 quantiles
_NAMES = {
    "gap": "smallest gap, m",
    "onset_ttc": "onset before they would meet, s",
    "onset_gap": "gap at the onset, m",
    "deviation": "off the straight line, m",
    "lateral_acceleration": "sideways, 95 %, m/s²",
    "braking": "braking, 95 %, m/s²",
    "slowest": "slowest, of the initial speed",
    "evades": "share who evade",
    "passes_first": "share who pass first",
}
CELL_HEAD = ["encounter", "recorded", "index", "these people", "recorded people", "ignore it"]
FEATURE_HEAD = ["encounter", "feature", "these people", "recorded"]


def cell_rows(realism: RobotRealism) -> list[list[str]]:
    """Return rows: cell, recorded encounters, index, score, ceiling and floor."""
    rows = [
        ["all", str(sum(realism.reference.weights.values())), f"{realism.index:.2f}"]
        + [f"{v:.3f}" for v in (realism.score, realism.ceiling, realism.floor)]
    ]
    for cell, (index, *scores) in realism.cells.items():
        count = str(realism.reference.whole[cell].count)
        rows.append([" ".join(cell), count, _two(index), *(f"{v:.3f}" for v in scores)])
    return rows


def part_rows(realism: RobotRealism) -> list[list[str]]:
    """Return rows: feature, similarity of these people and of those who ignore the robot."""
    return [[_NAMES[n], f"{a:.3f}", f"{b:.3f}"] for n, (a, b) in realism.parts.items()]


def feature_rows(realism: RobotRealism) -> list[list[str]]:
    """Return rows: cell, feature, median or share of these people and of recorded people."""
    rows = []
    for cell in realism.cells:
        own, recorded = realism.statistics.get(cell), realism.reference.whole[cell]
        for name in FEATURES:
            values = [
                np.nan if s is None
                else s.shares[name] if name in SHARES else s.quantiles[name][_MIDDLE]
                for s in (own, recorded)
            ]  # fmt: skip
            if np.isfinite(values[1]):
                rows.append([" ".join(cell), _NAMES[name], *(_two(float(v)) for v in values)])
    return rows


def _two(value: float) -> str:
    return f"{value:.2f}" if np.isfinite(value) else "–"
