"""People recorded near robots, with which responses are compared: shipped or from own files."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from importlib import resources
from pathlib import Path
from typing import Any

import numpy as np

from crowdbot.core.realism.near_robots.compare import compared, similarity
from crowdbot.core.realism.near_robots.encounters import RobotEncounter, encounters_of
from crowdbot.core.realism.near_robots.features import features_of
from crowdbot.core.realism.near_robots.recordings import read_clips
from crowdbot.core.realism.near_robots.scenes import SceneTable, scenes_of, table_of
from crowdbot.core.realism.near_robots.statistics import (
    LEAST,
    Cell,
    CellStatistics,
    cell_of,
    statistics_of,
)
from crowdbot.core.types.arrays import Array
from crowdbot.errors import InputError

SHIPPED = "recorded_near_robots.json"
#: Random halvings of the recordings whose mean similarity is the ceiling.
_HALVINGS = 20


@dataclass(frozen=True, slots=True, kw_only=True)
class RobotReference:
    """Recorded responses to robots that simulated people are compared with.

    Attributes:
        whole: cell -> distributions of all recordings; only cells that are compared.
        ceilings: cell -> similarity of one half of the recordings to the other.
        tables: cell -> distributions from which scenes are drawn; empty with own recordings.
        encounters: own recorded encounters, which are replayed; empty with shipped statistics.
        sources: sources of the recordings.
    """

    whole: Mapping[Cell, CellStatistics]
    ceilings: Mapping[Cell, float]
    tables: Mapping[Cell, SceneTable]
    encounters: Sequence[RobotEncounter]
    sources: tuple[str, ...]

    @property
    def weights(self) -> dict[Cell, int]:
        """Return cell -> number of recorded encounters."""
        return {cell: found.count for cell, found in self.whole.items()}

    def drawn(self, seed: int) -> list[RobotEncounter]:
        """Return encounters to simulate: the recorded ones, or scenes of a random draw."""
        if self.encounters:
            return list(self.encounters)
        return [e for table in self.tables.values() for e in scenes_of(table, seed)]

    def as_json(self) -> dict[str, Any]:
        """Return data that `from_json` reads, without encounters."""
        return {
            "sources": list(self.sources),
            "cells": [
                {
                    "kind": cell[0],
                    "speed": cell[1],
                    "ceiling": round(self.ceilings[cell], 4),
                    "features": found.as_json(),
                    "scenes": self.tables[cell].as_json(),
                }
                for cell, found in self.whole.items()
            ],
        }

    @classmethod
    def from_json(cls, data: Mapping[str, Any]) -> RobotReference:
        """Read data from `as_json`."""
        cells = {(c["kind"], c["speed"]): c for c in data["cells"]}
        return cls(
            whole={k: CellStatistics.from_json(c["features"]) for k, c in cells.items()},
            ceilings={k: float(c["ceiling"]) for k, c in cells.items()},
            tables={k: SceneTable.from_json(c["scenes"]) for k, c in cells.items()},
            encounters=(),
            sources=tuple(data["sources"]),
        )


@cache
def shipped() -> RobotReference:
    """Return the statistics of recordings that are shipped with crowdbot."""
    text = resources.files(__package__).joinpath(SHIPPED).read_text(encoding="utf-8")
    return RobotReference.from_json(json.loads(text))


def reference_of(
    encounters: Sequence[RobotEncounter],
    sources: Sequence[str],
    *,
    scenes: bool = False,
    least: int = LEAST,
) -> RobotReference:
    """Build a reference from recorded encounters.

    Args:
        scenes: keep distributions to draw scenes from instead of the encounters.
        least: encounters that a cell needs.

    Raises:
        InputError: no cell has enough encounters.
    """
    features = features_of(encounters, [e.person for e in encounters])
    whole = statistics_of(encounters, features)
    cells = compared(whole, least)
    if not cells:
        raise InputError(
            f"{', '.join(sources)}: {len(encounters)} meetings of people and robot; "
            f"{least} of one kind and speed are needed"
        )
    members = {c: [e for e in encounters if cell_of(e) == c] for c in cells}
    return RobotReference(
        whole={c: whole[c] for c in cells},
        ceilings=_ceilings(encounters, features, cells),
        tables={c: table_of(members[c]) for c in cells} if scenes else {},
        encounters=() if scenes else tuple(e for c in cells for e in members[c]),
        sources=tuple(sources),
    )


def read_reference(files: Sequence[Path]) -> RobotReference:
    """Read a reference from the user's recordings, in the formats of `read_clips`.

    Raises:
        InputError: a file cannot be read, or there are too few meetings.
    """
    clips = [clip for file in files for clip in read_clips(file)]
    return reference_of(encounters_of(clips), [str(f) for f in files])


def _ceilings(
    encounters: Sequence[RobotEncounter], features: Array, cells: Sequence[Cell]
) -> dict[Cell, float]:
    """Return the mean similarity of random halves of the recordings, by cell."""
    rng = np.random.default_rng(0)
    found: dict[Cell, list[float]] = {c: [] for c in cells}
    for cell in cells:
        rows = np.flatnonzero([cell_of(e) == cell for e in encounters])
        for _ in range(_HALVINGS):
            mixed = rng.permutation(rows)
            a, b = mixed[: len(mixed) // 2], mixed[len(mixed) // 2 :]
            first, second = (statistics_of([encounters[k] for k in h], features[h]) for h in (a, b))
            found[cell].append(similarity(first, second, {cell: 1}).score)
    return {cell: float(np.mean(values)) for cell, values in found.items()}
