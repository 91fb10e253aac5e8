"""Statistics of a crowd, for comparison; nothing else is kept of recordings."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise
from typing import Any, TypeVar

import numpy as np

from crowdbot.core.realism.bins import (
    CELLS,
    DIAGRAM_EDGES,
    EDGES,
    FEATURES,
    FLOWS,
)
from crowdbot.core.realism.features import (
    CELL,
    DENSITY,
    LANES,
    NEAREST,
    PACE,
    SPEED,
    features,
)
from crowdbot.core.realism.json_numbers import number_or_nan, rounded
from crowdbot.core.realism.pairs import pair_correlation
from crowdbot.core.realism.tracks import CorridorTracks
from crowdbot.core.types.arrays import Array

#: Name of a cell: flow and density.
Cell = tuple[str, str]
_Value = TypeVar("_Value")
_LARGEST = 9e8
#: With samples from fewer windows, a curve would be chance.
_LEAST_WINDOWS = 8
#: Reported percentiles of the nearest distance.
PERCENTILES = (1.0, 5.0, 50.0)


@dataclass(frozen=True, slots=True, kw_only=True)
class Statistics:
    """Statistics of a crowd's behaviour, by flow and density.

    Attributes:
        histograms: cell -> feature -> (B,) numbers of samples by `EDGES`.
        diagram: flow -> (K, 2) density, 1/m^2, and mean speed, m/s.
        lanes: cell -> lane order, 0 to 1.
        nearest: cell -> percentiles 1, 5, 50 of the nearest distance, m.
        pairs: cell -> (B,) pair correlation by `PAIR_EDGES`; 1 is chance.
        overlap: share of person-time in which bodies overlap; NaN if sizes are unknown.
        people: people's rows by cell, from which samples are drawn; empty if only histograms were
            kept.
    """

    histograms: Mapping[Cell, Mapping[str, Array]]
    diagram: Mapping[str, Array]
    lanes: Mapping[Cell, float]
    nearest: Mapping[Cell, Array]
    pairs: Mapping[Cell, Array]
    overlap: float = float("nan")
    people: Mapping[Cell, Array] = field(default_factory=dict)

    def count(self, cell: Cell) -> int:
        """Number of samples of a cell."""
        found = self.histograms.get(cell)
        return 0 if found is None else int(np.sum(found["speed"]))

    def within(self, cells: Iterable[Cell]) -> Statistics:
        """Return the statistics of some cells only."""
        kept = set(cells)

        def some(of: Mapping[Cell, _Value]) -> dict[Cell, _Value]:
            return {cell: value for cell, value in of.items() if cell in kept}

        return replace(
            self,
            histograms=some(self.histograms),
            lanes=some(self.lanes),
            nearest=some(self.nearest),
            pairs=some(self.pairs),
            people=some(self.people),
        )

    def as_json(self) -> dict[str, Any]:
        """Return rounded numbers that `from_json` reads; histograms as shares of 10 000."""
        return {
            "cells": {
                "/".join(cell): {
                    "samples": self.count(cell),
                    "histograms": {f: _shares(h) for f, h in self.histograms[cell].items()},
                    "lanes": rounded(self.lanes.get(cell, np.nan), 3),
                    "nearest": [rounded(v, 3) for v in self.nearest[cell]],
                    "pairs": [rounded(v, 3) for v in self.pairs[cell]],
                }
                for cell in self.histograms
            },
            "diagram": {
                flow: [[rounded(v, 3) for v in row] for row in rows]
                for flow, rows in self.diagram.items()
            },
        }

    @classmethod
    def from_json(cls, data: Mapping[str, Any]) -> Statistics:
        """Read data from `as_json`; the result has no rows."""
        histograms, lanes, nearest, pairs = {}, {}, {}, {}
        for name, found in data["cells"].items():
            flow, _, density = name.partition("/")
            cell, count = (flow, density), found["samples"]
            histograms[cell] = {
                f: np.array(h, np.float64) * (count / max(1, sum(h)))
                for f, h in found["histograms"].items()
            }
            lanes[cell] = number_or_nan(found["lanes"])
            nearest[cell] = np.array([number_or_nan(v) for v in found["nearest"]])
            pairs[cell] = np.array([number_or_nan(v) for v in found["pairs"]])
        diagram = {flow: np.array(rows, np.float64) for flow, rows in data["diagram"].items()}
        return cls(
            histograms=histograms, diagram=diagram, lanes=lanes, nearest=nearest, pairs=pairs
        )


def statistics_of(tracks: Sequence[CorridorTracks]) -> Statistics:
    """Return the statistics of all people in some tracks, flow by flow."""
    by_flow = {flow: [t for t in tracks if t.flow == flow] for flow in FLOWS}
    histograms: dict[Cell, dict[str, Array]] = {}
    lanes, nearest, pairs, people = {}, {}, {}, {}
    diagram, close, all_ = {}, 0, 0
    for flow, some in by_flow.items():
        if not some:
            continue
        found = [features(t) for t in some]
        rows = np.concatenate([f[0] for f in found])
        windows = np.concatenate([f[1] for f in found])
        diagram[flow] = _diagram(windows)
        curves = pair_correlation(some)
        for number, density in enumerate(CELLS):
            cell = flow, density
            mine = rows[rows[:, CELL] == number]
            if not len(mine):
                continue
            people[cell], histograms[cell] = mine, histograms_of(mine)
            lanes[cell] = _mean(windows[windows[:, CELL] == number, LANES])
            nearest[cell] = np.percentile(np.minimum(mine[:, NEAREST], _LARGEST), PERCENTILES)
            pairs[cell] = curves[number]
        for t, (r, _) in zip(some, found, strict=True):
            if t.radius > 0.0:
                close += int(np.sum(r[:, NEAREST] < 2.0 * t.radius))
                all_ += len(r)
    return Statistics(
        histograms=histograms, diagram=diagram, lanes=lanes, nearest=nearest, pairs=pairs,
        overlap=close / all_ if all_ else float("nan"), people=people,
    )  # fmt: skip


def histograms_of(rows: Array) -> dict[str, Array]:
    """Return feature -> (B,) numbers of finite samples in people's rows."""
    histograms = {}
    for column, name in enumerate(FEATURES, SPEED):
        values = rows[:, column]
        values = np.minimum(values[~np.isnan(values)], _LARGEST)
        histograms[name] = np.histogram(values, EDGES[name])[0].astype(np.float64)
    return histograms


def _diagram(windows: Array) -> Array:
    """Return (K, 2): mean density and mean speed of windows with similar density."""
    rows = []
    for low, high in pairwise(DIAGRAM_EDGES):
        here = windows[(windows[:, DENSITY] >= low) & (windows[:, DENSITY] < high)]
        if len(here) >= _LEAST_WINDOWS:
            rows.append(here[:, [DENSITY, PACE]].mean(axis=0))
    return np.array(rows).reshape(-1, 2)


def _mean(values: Array) -> float:
    known = values[~np.isnan(values)]
    return float(known.mean()) if len(known) else float("nan")


def _shares(histogram: Array) -> list[int]:
    total = float(np.sum(histogram))
    return [round(10_000 * v / total) if total else 0 for v in histogram]
