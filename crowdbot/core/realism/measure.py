"""Measure the realism of a crowd, simulated or from its runs, against recorded people."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from crowdbot.core.realism.bins import FEATURES, LEAST_SAMPLES
from crowdbot.core.realism.compare import RealismScore, ReportedErrors, beside
from crowdbot.core.realism.corridor import corridors, simulate
from crowdbot.core.realism.json_numbers import rounded
from crowdbot.core.realism.model import CrowdModel
from crowdbot.core.realism.reference import RealismReference
from crowdbot.core.realism.statistics import Statistics, statistics_of
from crowdbot.core.realism.tracks import CorridorTracks
from crowdbot.errors import InputError

#: Seeds of the corridors: the index varies by 0.022 for one, by 0.006 for the mean of sixteen.
SEEDS = tuple(range(1, 17))
#: Least share of the reference's cells with which runs have an index.
LEAST_COVERAGE = 0.25
#: Additional parts besides the five features, from 0 to 1.
DIAGRAM, LANES, PAIRS = "fundamental_diagram", "lanes", "pair_correlation"


@dataclass(frozen=True, slots=True, kw_only=True)
class Realism:
    """Similarity of a crowd to recorded people.

    Attributes:
        name: name of the crowd.
        score, low, high: mean over draws, smallest and largest.
        index: (score - floor)/(ceiling - floor).
        ceiling, floor: scores of recorded people and of people without avoidance.
        parts: the five features, then fundamental diagram, lanes and pair correlation; 1 is equal.
        cells: (flow, density) -> mean of the five features.
        beside: errors in their own units.
        statistics: statistics of the crowd in all draws.
        reference: the reference of the comparison, with the cells that count.
        of_cells: number of cells that the reference has in all; 0 if all count.
    """

    name: str
    score: float
    low: float
    high: float
    index: float
    ceiling: float
    floor: float
    parts: Mapping[str, float]
    cells: Mapping[tuple[str, str], float]
    beside: ReportedErrors
    statistics: Statistics
    reference: RealismReference
    of_cells: int = 0

    @property
    def coverage(self) -> str:
        """Return which cells count, if not all of the reference do; else an empty text."""
        names = ", ".join(f"{flow} {density}" for flow, density in self.reference.cells)
        count = len(self.reference.cells)
        if not self.of_cells or count == self.of_cells:
            return ""
        return f"{count} of {self.of_cells} conditions (people/m²): {names}"

    @property
    def line(self) -> str:
        """Return one line for the head of a report."""
        return (
            f"{self.name}, realism {self.score:.2f} "
            f"(recorded people {self.ceiling:.2f}, no avoidance {self.floor:.2f})"
        )

    def as_json(self) -> dict[str, Any]:
        """Return plain data for JSON."""
        b = self.beside
        return {
            "crowd": self.name,
            "index": rounded(self.index, 4),
            "score": rounded(self.score, 4),
            "score_range": [rounded(self.low, 4), rounded(self.high, 4)],
            "ceiling": rounded(self.ceiling, 4),
            "floor": rounded(self.floor, 4),
            "parts": {name: rounded(v, 4) for name, v in self.parts.items()},
            "coverage": [len(self.reference.cells), self.of_cells or len(self.reference.cells)],
            "cells": {"/".join(cell): rounded(v, 4) for cell, v in self.cells.items()},
            "beside": {
                "fundamental_diagram_error": rounded(b.diagram_error, 4),
                "lane_order_error": rounded(b.lane_error, 4),
                "nearest_error_m": [rounded(v, 4) for v in b.nearest_error],
                "pair_correlation_error": rounded(b.pair_error, 4),
                "overlap": rounded(b.overlap, 4),
            },
            "lane_order": {
                "/".join(c): [
                    rounded(self.statistics.lanes.get(c, np.nan), 4),
                    rounded(self.reference.whole.lanes[c], 4),
                ]
                for c in self.reference.cells
            },
            "nearest_m": {
                "/".join(c): [
                    [rounded(v, 4) for v in s.nearest[c]] if c in s.nearest else None
                    for s in (self.statistics, self.reference.whole)
                ]
                for c in self.reference.cells
            },
            "fundamental_diagram": {
                flow: [[rounded(v, 4) for v in row] for row in rows]
                for flow, rows in self.statistics.diagram.items()
            },
            "sources": list(self.reference.sources),
        }


def measure(
    name: str,
    model: CrowdModel,
    reference: RealismReference,
    seeds: Sequence[int] = SEEDS,
    walk: Callable[[CrowdModel, Sequence[int]], Sequence[Sequence[CorridorTracks]]] | None = None,
) -> Realism:
    """Simulate a crowd under the recorded conditions, and compare.

    Args:
        name: name of the crowd.
        reference: recorded people.
        seeds: seeds of positions and speeds.
        walk: function that simulates a model for each seed; default: in this process, one by one.

    Raises:
        PluginError: the policy fails.
    """
    found = (walk or walk_here)(model, seeds)
    return measure_tracks(name, found, reference)


def walk_here(model: CrowdModel, seeds: Sequence[int]) -> list[list[CorridorTracks]]:
    """Simulate all corridors of each seed in this process."""
    return [[simulate(model, c) for c in corridors(seed)] for seed in seeds]


def measure_tracks(
    name: str, draws: Sequence[Sequence[CorridorTracks]], reference: RealismReference
) -> Realism:
    """Compare tracks with the reference, draw by draw."""
    each = [reference.score(statistics_of(tracks), k) for k, tracks in enumerate(draws)]
    whole = statistics_of([t for tracks in draws for t in tracks])
    near = beside(whole, reference.whole)
    values = [s.score for s in each]
    score = float(np.mean(values))
    return Realism(
        name=name,
        score=score,
        low=min(values),
        high=max(values),
        index=reference.index(score),
        ceiling=reference.ceiling.score,
        floor=reference.floor.score,
        parts={**_parts(each), **_others(near)},
        cells={c: float(np.mean([s.cells[c] for s in each])) for c in each[0].cells},
        beside=near,
        statistics=whole,
        reference=reference,
    )


def measure_met(
    name: str, draws: Sequence[Sequence[CorridorTracks]], reference: RealismReference
) -> Realism:
    """Compare tracks of people in other conditions than the recorded ones, such as finished runs.

    Only cells with enough samples of these people count, for floor and ceiling too.

    Raises:
        InputError: there are enough samples in less than a quarter of the reference's cells.
    """
    whole = statistics_of([t for tracks in draws for t in tracks])
    met = [cell for cell in reference.cells if whole.count(cell) >= LEAST_SAMPLES]
    if not met or len(met) < LEAST_COVERAGE * len(reference.cells):
        raise InputError(
            f"{name}: too few people for an index: {len(met)} of {len(reference.cells)} conditions "
            f"of the recordings have {LEAST_SAMPLES} samples (0.3 to 2.4 people per m²); "
            "measure the suite or the crowd instead of the runs"
        )
    found = measure_tracks(name, draws, reference.within(met))
    return replace(found, of_cells=len(reference.cells))


def _parts(scores: Sequence[RealismScore]) -> dict[str, float]:
    return {f: float(np.mean([s.parts[f] for s in scores])) for f in FEATURES}


def _others(near: ReportedErrors) -> dict[str, float]:
    return {
        DIAGRAM: max(0.0, 1.0 - near.diagram_error),
        LANES: max(0.0, 1.0 - near.lane_error),
        PAIRS: max(0.0, 1.0 - near.pair_error),
    }
