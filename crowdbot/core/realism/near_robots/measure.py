"""Measure people's response to a robot against people recorded near robots."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from crowdbot.core.realism.compare import RealismScore
from crowdbot.core.realism.json_numbers import rounded
from crowdbot.core.realism.near_robots.compare import similarity
from crowdbot.core.realism.near_robots.encounters import RobotEncounter
from crowdbot.core.realism.near_robots.features import features_of
from crowdbot.core.realism.near_robots.reference import RobotReference
from crowdbot.core.realism.near_robots.replay import Response, walk_all
from crowdbot.core.realism.near_robots.statistics import Cell, CellStatistics, statistics_of
from crowdbot.errors import InputError

#: Names of a cell's numbers.
_SCORES = ("index", "score", "ceiling", "floor")
#: Draws of scenes and attention.
SEEDS = (1, 2)


@dataclass(frozen=True, slots=True, kw_only=True)
class RobotRealism:
    """Similarity of people's response to that of recorded people.

    Attributes:
        name: name of the crowd or response.
        score: similarity to recorded people; ``parts`` has it by feature.
        ceiling, floor: similarity of one half of the recordings to the other, and of people who
            ignore the robot and walk straight on.
        cells: cell -> index, similarity, ceiling and floor.
        statistics: cell -> distributions of these people.
        reference: the recorded people.
    """

    name: str
    score: float
    ceiling: float
    floor: float
    parts: Mapping[str, tuple[float, float]]
    cells: Mapping[Cell, tuple[float, float, float, float]]
    statistics: Mapping[Cell, CellStatistics]
    reference: RobotReference

    @property
    def index(self) -> float:
        """Return (score - floor)/(ceiling - floor): 0 ignores robots, 1 is recorded people."""
        return _index(self.score, self.floor, self.ceiling)

    @property
    def line(self) -> str:
        """Return one line for the head of a report."""
        return (
            f"{self.name}, response to robots {self.score:.2f} "
            f"(real {self.ceiling:.2f}, ignoring {self.floor:.2f})"
        )

    def as_json(self) -> dict[str, Any]:
        """Return plain data for JSON."""
        return {
            "response": self.name,
            "index": rounded(self.index, 4),
            "score": rounded(self.score, 4),
            "ceiling": rounded(self.ceiling, 4),
            "floor": rounded(self.floor, 4),
            "parts": {n: {"own": rounded(a, 4), "ignoring": rounded(b, 4)}
                      for n, (a, b) in self.parts.items()},
            "cells": {
                "/".join(cell): {
                    "recorded": self.reference.whole[cell].count,
                    **{n: rounded(v, 4) for n, v in zip(_SCORES, values, strict=True)},
                }
                for cell, values in self.cells.items()
            },
            "sources": list(self.reference.sources),
        }  # fmt: skip


def measure(
    name: str, response: Response, reference: RobotReference, seeds: Sequence[int] = SEEDS
) -> RobotRealism:
    """Simulate people beside the robots of a reference, and compare them with recorded people.

    Raises:
        PluginError: the crowd's policy fails.
    """
    drawn = {seed: reference.drawn(seed) for seed in seeds}
    encounters = [e for some in drawn.values() for e in some]
    people = [w for seed, some in drawn.items() for w in walk_all(response, some, seed)]
    own = statistics_of(encounters, features_of(encounters, people))
    return compare(name, own, _straight(encounters), reference)


def measure_encounters(
    name: str, encounters: Sequence[RobotEncounter], reference: RobotReference
) -> RobotRealism:
    """Compare the people of finished runs with recorded people; the floor is straight walking.

    Raises:
        InputError: no person met the robot as recorded people did.
    """
    own = statistics_of(encounters, features_of(encounters, [e.person for e in encounters]))
    known = {cell: found for cell, found in reference.whole.items() if cell in own}
    if not known:
        raise InputError(f"{name}: no one walks into the robot's way as recorded people did")
    return compare(name, own, _straight(encounters), reference, known)


def compare(
    name: str,
    own: Mapping[Cell, CellStatistics],
    ignoring: Mapping[Cell, CellStatistics],
    reference: RobotReference,
    cells: Mapping[Cell, CellStatistics] | None = None,
) -> RobotRealism:
    """Compare distributions with those of a reference; by default in all its cells."""
    weights = {c: f.count for c, f in (reference.whole if cells is None else cells).items()}
    found, floor = (similarity(s, reference.whole, weights) for s in (own, ignoring))
    ceiling = sum(weights[c] * reference.ceilings[c] for c in weights) / sum(weights.values())
    return RobotRealism(
        name=name,
        score=found.score,
        ceiling=ceiling,
        floor=floor.score,
        parts={n: (v, floor.parts[n]) for n, v in found.parts.items()},
        cells=_cells(found, floor, reference),
        statistics=own,
        reference=reference,
    )


def _straight(encounters: Sequence[RobotEncounter]) -> dict[Cell, CellStatistics]:
    """Return the distributions of people who ignore the robot and walk straight on."""
    return statistics_of(encounters, features_of(encounters, [e.straight for e in encounters]))


def _cells(
    found: RealismScore, floor: RealismScore, reference: RobotReference
) -> dict[Cell, tuple[float, float, float, float]]:
    out = {}
    for cell, score in found.cells.items():
        low, high = floor.cells[cell], reference.ceilings[cell]
        out[cell] = _index(score, low, high), score, high, low
    return out


def _index(score: float, floor: float, ceiling: float) -> float:
    return (score - floor) / (ceiling - floor) if ceiling > floor else float("nan")
