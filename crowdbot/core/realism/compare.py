"""Similarity of two crowds' statistics: scores from 0 to 1, and further errors."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from crowdbot.core.realism.bins import CELLS, FEATURES, FLOWS, LEAST_SAMPLES
from crowdbot.core.realism.statistics import Cell, Statistics, histograms_of
from crowdbot.core.types.arrays import Array

#: Sample size on both sides, since the divergence of few samples is larger than that of many.
SAMPLES = 2000
#: Added to each bin, so that an empty bin is not impossible.
_PRIOR = 0.1
#: With fewer samples the crowd scores 0 in that cell.
_FEWEST = 30


@dataclass(frozen=True, slots=True, kw_only=True)
class RealismScore:
    """The comparison of one crowd with another.

    Attributes:
        score: mean of all parts of all cells.
        parts: feature -> mean over cells.
        cells: (flow, density) -> mean over features.
    """

    score: float
    parts: Mapping[str, float]
    cells: Mapping[Cell, float]


@dataclass(frozen=True, slots=True, kw_only=True)
class ReportedErrors:
    """Errors that are reported in addition to the score.

    Attributes:
        diagram_error: mean relative error of speed over the recorded curve.
        lane_error: mean absolute error of the lane order.
        nearest_error: mean absolute error of the 1, 5, 50 % nearest distances, (3,) m.
        pair_error: mean absolute error of the pair correlation.
        overlap: share of person-time in which bodies overlap.
    """

    diagram_error: float
    lane_error: float
    nearest_error: Array
    pair_error: float
    overlap: float


def compared_cells(reference: Statistics) -> list[Cell]:
    """Return the cells with enough recorded samples."""
    cells = [(flow, density) for flow in FLOWS for density in CELLS]
    return [c for c in cells if reference.count(c) >= LEAST_SAMPLES]


def similarity(p: Array, q: Array) -> float:
    """Return 1 - sqrt of the Jensen-Shannon divergence (base 2) of two histograms with equal bins.

    Both are scaled to `SAMPLES` samples.
    """
    a, b = (SAMPLES * h / max(float(np.sum(h)), 1e-12) + _PRIOR for h in (p, q))
    a, b = a / a.sum(), b / b.sum()
    m = 0.5 * (a + b)
    divergence = 0.5 * np.sum(a * np.log2(a / m)) + 0.5 * np.sum(b * np.log2(b / m))
    return float(1.0 - np.sqrt(max(0.0, divergence)))


def score(crowd: Statistics, reference: Statistics, seed: int = 0) -> RealismScore:
    """Score a crowd against the reference: mean of 1 - sqrt(JSD) over cells and features.

    Args:
        crowd: statistics; if they have rows, `SAMPLES` of them are drawn in each cell.
        reference: decides which cells count.
        seed: seed of the draw.
    """
    rng = np.random.default_rng([seed, 0x5EA1])
    found: dict[tuple[Cell, str], float] = {}
    for cell in compared_cells(reference):
        sample = _sample(crowd, cell, rng)
        for name in FEATURES:
            found[cell, name] = (
                0.0
                if sample is None
                else similarity(sample[name], reference.histograms[cell][name])
            )
    cells = compared_cells(reference)
    return RealismScore(
        score=float(np.mean(list(found.values()))) if found else float("nan"),
        parts={f: float(np.mean([found[c, f] for c in cells])) for f in FEATURES if cells},
        cells={c: float(np.mean([found[c, f] for f in FEATURES])) for c in cells},
    )


def _sample(crowd: Statistics, cell: Cell, rng: np.random.Generator) -> Mapping[str, Array] | None:
    if crowd.count(cell) < _FEWEST:
        return None
    rows = crowd.people.get(cell)
    if rows is None or len(rows) <= SAMPLES:
        return crowd.histograms[cell]
    return histograms_of(rows[rng.choice(len(rows), SAMPLES, replace=False)])


def beside(crowd: Statistics, reference: Statistics) -> ReportedErrors:
    """Return the additional errors; NaN if there is nothing to compare."""
    cells = [c for c in compared_cells(reference) if crowd.count(c) >= _FEWEST]
    counter = [c for c in cells if c[0] == "counter"]
    return ReportedErrors(
        diagram_error=_mean(
            [abs(e) for flow in FLOWS for e in diagram_errors(crowd, reference, flow)]
        ),
        lane_error=_mean([abs(crowd.lanes[c] - reference.lanes[c]) for c in counter]),
        nearest_error=np.array(
            [_mean([abs(crowd.nearest[c][k] - reference.nearest[c][k]) for c in cells])
             for k in range(3)]
        ),
        pair_error=_mean([_curve_error(crowd.pairs[c], reference.pairs[c]) for c in cells]),
        overlap=crowd.overlap,
    )  # fmt: skip


def diagram_errors(crowd: Statistics, reference: Statistics, flow: str) -> Array:
    """Return relative speed errors at the crowd's densities, against the recorded curve."""
    curve, own = reference.diagram.get(flow), crowd.diagram.get(flow)
    if curve is None or own is None or len(curve) < 2 or not len(own):
        return np.zeros(0)
    inside = own[(own[:, 0] >= curve[0, 0] - 0.1) & (own[:, 0] <= curve[-1, 0] + 0.1)]
    recorded = np.interp(inside[:, 0], curve[:, 0], curve[:, 1])
    return np.asarray(inside[:, 1] / recorded - 1.0)


def _curve_error(own: Array, recorded: Array) -> float:
    known = np.isfinite(own) & np.isfinite(recorded)
    return float(np.mean(np.abs(own - recorded)[known])) if known.any() else float("nan")


def _mean(values: list[float]) -> float:
    known = [v for v in values if np.isfinite(v)]
    return float(np.mean(known)) if known else float("nan")
