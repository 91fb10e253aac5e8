"""Similarity of two sets of encounters, from 0 to 1."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from crowdbot.core.realism.compare import RealismScore
from crowdbot.core.realism.near_robots.features import FEATURES, SHARES
from crowdbot.core.realism.near_robots.statistics import LEAST, Cell, CellStatistics

#: Least range by which a difference is divided: errors of recorded positions, in the features'
#: units.
_RESOLUTION = {
    "gap": 0.1,
    "onset_ttc": 0.5,
    "onset_gap": 0.5,
    "deviation": 0.1,
    "lateral_acceleration": 0.2,
    "braking": 0.2,
    "slowest": 0.1,
}


def compared(recorded: Mapping[Cell, CellStatistics], least: int = LEAST) -> list[Cell]:
    """Return the cells with enough recorded encounters."""
    return [cell for cell, found in recorded.items() if found.count >= least]


def similarity(
    own: Mapping[Cell, CellStatistics],
    recorded: Mapping[Cell, CellStatistics],
    cells: Mapping[Cell, int],
) -> RealismScore:
    """Return the similarity of people's responses to recorded ones, means by weight.

    Args:
        own, recorded: distributions by cell; a cell without own encounters scores 0.
        cells: cell -> weight.
    """
    each = {c: parts_of(own[c], recorded[c]) if c in own else {} for c in cells}
    weights = {c: float(w) for c, w in cells.items()}
    scores = {c: float(np.mean(list(p.values()))) if p else 0.0 for c, p in each.items()}
    return RealismScore(
        score=_mean(scores, weights),
        cells=scores,
        parts={
            name: _mean({c: p[name] for c, p in each.items() if name in p}, weights)
            for name in FEATURES
            if any(name in p for p in each.values())
        },
    )


def parts_of(own: CellStatistics, recorded: CellStatistics) -> dict[str, float]:
    """Return feature -> similarity: 1 minus the mean distance of quantiles over their range.

    The range is that of the recorded 10 % and 90 % quantiles. Shares differ by their difference.
    Features that are undefined in the recordings are left out; if undefined for the compared
    people, they score 0.
    """
    parts = {}
    for name in FEATURES:
        if name in SHARES:
            there, here = recorded.shares[name], own.shares[name]
            if np.isfinite(there):
                parts[name] = 1.0 - abs(here - there) if np.isfinite(here) else 0.0
            continue
        q, p = recorded.quantiles[name], own.quantiles[name]
        if np.isfinite(q).all():
            scale = max(float(q[-2] - q[1]), _RESOLUTION[name])
            away = float(np.abs(p - q).mean()) / scale
            parts[name] = max(0.0, 1.0 - away) if np.isfinite(away) else 0.0
    return parts


def _mean(values: Mapping[Cell, float], weights: Mapping[Cell, float]) -> float:
    total = sum(weights[c] for c in values)
    return sum(weights[c] * v for c, v in values.items()) / total if total else float("nan")
