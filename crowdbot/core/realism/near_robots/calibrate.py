"""Fit the parameters of a response to people recorded near robots."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

from crowdbot.core.realism.calibrate import HELD_OUT_DRAWS, Fitted, digest, registry_of
from crowdbot.core.realism.near_robots.encounters import RobotEncounter, encounters_of
from crowdbot.core.realism.near_robots.measure import measure
from crowdbot.core.realism.near_robots.recordings import read_clips
from crowdbot.core.realism.near_robots.reference import (
    RobotReference,
    read_reference,
    reference_of,
    shipped,
)
from crowdbot.core.realism.near_robots.responses import open_responding, response_of_crowd
from crowdbot.core.realism.near_robots.statistics import LEAST, cell_of
from crowdbot.errors import CrowdbotError

#: Loss of a response that cannot be simulated.
_WORST = 1.0


@dataclass(frozen=True, slots=True, kw_only=True)
class RobotFitTask(Fitted):
    """The definition of a fit of a response to robots."""

    @property
    def ceiling(self) -> float:
        """Return the score of one half of the recordings against the other."""
        whole = _whole(self.files)
        _halves(self.files)  # too few encounters are an error before anything is simulated
        weights = whole.weights
        return sum(n * whole.ceilings[c] for c, n in weights.items()) / sum(weights.values())

    @property
    def inputs(self) -> list[Any]:
        """Return the values that identify this fit in its log."""
        return ["robot", self.crowd, self.overrides, [_digests(Path(f)) for f in self.files]]

    def loss(self, overrides: Sequence[str], seed: int) -> float:
        """Return 1 - score against the first half."""
        try:
            return 1.0 - self._score(overrides, _halves(self.files)[0], (seed,))
        except CrowdbotError:
            return _WORST

    def scores(self, overrides: Sequence[str]) -> tuple[float, float]:
        """Return the scores against both halves; the second with held-out draws."""
        first, second = _halves(self.files)
        return (
            self._score(overrides, first, (1, 2)),
            self._score(overrides, second, HELD_OUT_DRAWS[:2]),
        )

    def _score(
        self, overrides: Sequence[str], reference: RobotReference, seeds: Sequence[int]
    ) -> float:
        registry = registry_of(self.plugins, self.allowed)
        crowd = open_responding(self.crowd, registry, [*self.overrides, *overrides])
        return measure(self.crowd, response_of_crowd(crowd, registry), reference, seeds).score


@cache
def _whole(files: tuple[str, ...]) -> RobotReference:
    return read_reference([Path(f) for f in files]) if files else shipped()


@cache
def _halves(files: tuple[str, ...]) -> tuple[RobotReference, RobotReference]:
    """Return every second encounter of each cell, and the others; shipped statistics twice."""
    if not files:
        return shipped(), shipped()
    clips = [clip for file in files for clip in read_clips(Path(file))]
    halves: tuple[list[RobotEncounter], list[RobotEncounter]] = ([], [])
    seen: dict[tuple[str, str], int] = {}
    for e in encounters_of(clips):
        number = seen[cell_of(e)] = seen.get(cell_of(e), -1) + 1
        halves[number % 2].append(e)
    first, second = (reference_of(half, files, least=LEAST // 2) for half in halves)
    return first, second


def _digests(path: Path) -> list[str]:
    files = sorted(path.rglob("*")) if path.is_dir() else [path]
    return [digest(f) for f in files if f.is_file()]
