"""The recorded people that crowds are compared with, as shipped or from the user's files."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache
from importlib import resources
from pathlib import Path
from typing import Any

from crowdbot.core.realism.compare import RealismScore, compared_cells, score
from crowdbot.core.realism.corridor import corridors, simulate
from crowdbot.core.realism.model import CrowdModel, avoid_nobody, ghosts
from crowdbot.core.realism.recordings import read_tracks
from crowdbot.core.realism.statistics import Cell, Statistics, statistics_of
from crowdbot.core.realism.tracks import CorridorTracks
from crowdbot.core.trajectories.data_sets.homography import AS_STATED, VideoScale
from crowdbot.errors import InputError

SHIPPED = "recorded_corridors.json"
#: With this many recordings each is compared with the rest; else halves are.
_FEWEST_FOLDS = 3
#: Names of the floors: people without avoidance, and straight lines through each other.
FLOORS: Mapping[str, CrowdModel] = {
    "avoid nobody": CrowdModel(policy=avoid_nobody),
    "straight lines": CrowdModel(policy=ghosts),
}


@dataclass(frozen=True, slots=True, kw_only=True)
class RealismReference:
    """Recorded people; parts of them, the folds, are compared with the rest for the ceiling.

    Attributes:
        halves: statistics of alternating recordings.
        whole: statistics of all recordings.
        floors: name -> statistics of people without avoidance.
        sources: sources of the recordings.
        folds: pairs of a reference for crowds, and the other recordings, whose score against it is
            the ceiling: each recording and the rest, or each half and the other.
    """

    halves: tuple[Statistics, Statistics]
    whole: Statistics
    floors: Mapping[str, Statistics]
    sources: tuple[str, ...]
    folds: tuple[tuple[Statistics, Statistics], ...]

    def score(self, crowd: Statistics, seed: int = 0) -> RealismScore:
        """Return the mean of the scores against the first of each fold."""
        return _mean([score(crowd, one, seed) for one, _ in self.folds])

    @property
    def ceiling(self) -> RealismScore:
        """Return the mean score of each fold against the other recordings: the best possible."""
        return _mean([score(others, one) for one, others in self.folds])

    @property
    def floor(self) -> RealismScore:
        """Return the better score of the floors."""
        return max((self.score(f) for f in self.floors.values()), key=lambda s: s.score)

    def index(self, value: float) -> float:
        """Return (score - floor)/(ceiling - floor): 0 for ghosts, 1 for recorded people."""
        low, high = self.floor.score, self.ceiling.score
        return (value - low) / (high - low) if high > low else float("nan")

    @property
    def cells(self) -> list[Cell]:
        """Return the cells that count."""
        return compared_cells(self.whole)

    def within(self, cells: Sequence[Cell]) -> RealismReference:
        """Return the reference with only some cells, also for floor and ceiling."""
        first, second = (half.within(cells) for half in self.halves)
        return replace(
            self,
            halves=(first, second),
            whole=self.whole.within(cells),
            floors={name: floor.within(cells) for name, floor in self.floors.items()},
            folds=tuple((a.within(cells), b.within(cells)) for a, b in self.folds),
        )

    def as_json(self) -> dict[str, Any]:
        """Return data that `from_json` reads."""
        return {
            "sources": list(self.sources),
            "halves": [half.as_json() for half in self.halves],
            "whole": self.whole.as_json(),
            "floors": {name: f.as_json() for name, f in self.floors.items()},
        }

    @classmethod
    def from_json(cls, data: Mapping[str, Any]) -> RealismReference:
        """Read data from `as_json`."""
        first, second = (Statistics.from_json(half) for half in data["halves"])
        return cls(
            halves=(first, second),
            whole=Statistics.from_json(data["whole"]),
            floors={name: Statistics.from_json(f) for name, f in data["floors"].items()},
            sources=tuple(data["sources"]),
            folds=((first, second), (second, first)),
        )


@cache
def shipped() -> RealismReference:
    """Return the recorded corridors shipped with crowdbot, as derived numbers."""
    text = resources.files(__package__).joinpath(SHIPPED).read_text(encoding="utf-8")
    return RealismReference.from_json(json.loads(text))


def reference_of(
    tracks: Sequence[CorridorTracks],
    sources: Sequence[str],
    floors: Mapping[str, Statistics] | None = None,
) -> RealismReference:
    """Build a reference from tracks; alternating tracks go to the two halves.

    Each of three recordings or more is compared with all others, so that few or short ones lower
    the ceiling less than halves would. One recording alone is halved in time.

    Raises:
        InputError: there is nothing to compare.
    """
    if not tracks:
        raise InputError("a reference needs at least one recording")
    halves = _halved(tracks[0]) if len(tracks) == 1 else _alternate(tracks)
    first, second = (statistics_of(half) for half in halves)
    reference = RealismReference(
        halves=(first, second),
        whole=statistics_of(tracks),
        floors=shipped().floors if floors is None else floors,
        sources=tuple(sources),
        folds=_folds(tracks) or _shared([(first, second), (second, first)]),
    )
    if not any(compared_cells(half) for half in reference.halves):
        raise InputError(
            f"{', '.join(sources)}: no one walks among 0.3 to 2.4 people per m² in windows of 4 m"
        )
    if not reference.folds:
        raise InputError(
            f"{', '.join(sources)}: no two parts have people at the same density, so that nothing "
            "says how alike recorded people are; give more or longer recordings"
        )
    return reference


def read_reference(files: Sequence[Path], scale: VideoScale = AS_STATED) -> RealismReference:
    """Read a reference from the user's files, in the formats of `read_tracks`.

    Args:
        files: recordings.
        scale: of tables among them.

    Raises:
        InputError: a file cannot be read, or there is nothing to compare in it.
    """
    return reference_of([read_tracks(f, scale) for f in files], [str(f) for f in files])


def floors_of(seeds: Sequence[int]) -> dict[str, Statistics]:
    """Simulate people without avoidance and return their statistics."""
    return {
        name: statistics_of([simulate(model, c) for seed in seeds for c in corridors(seed)])
        for name, model in FLOORS.items()
    }


def _alternate(
    tracks: Sequence[CorridorTracks],
) -> tuple[Sequence[CorridorTracks], Sequence[CorridorTracks]]:
    """Return alternating tracks in two halves, flow by flow."""
    first: list[CorridorTracks] = []
    second: list[CorridorTracks] = []
    for flow in ("uni", "counter"):
        some = [t for t in tracks if t.flow == flow]
        first += some[::2]
        second += some[1::2]
    return first, second


def _folds(tracks: Sequence[CorridorTracks]) -> tuple[tuple[Statistics, Statistics], ...]:
    """Return each recording with all others; none if there are two."""
    if len(tracks) < _FEWEST_FOLDS:
        return ()
    return _shared(
        [
            (statistics_of([own]), statistics_of([t for k, t in enumerate(tracks) if k != i]))
            for i, own in enumerate(tracks)
        ]
    )


def _shared(
    pairs: Sequence[tuple[Statistics, Statistics]],
) -> tuple[tuple[Statistics, Statistics], ...]:
    """Return the pairs in cells that both have, without those that share none."""
    both = [[c for c in compared_cells(a) if c in compared_cells(b)] for a, b in pairs]
    return tuple((a.within(c), b) for (a, b), c in zip(pairs, both, strict=True) if c)


def _halved(tracks: CorridorTracks) -> tuple[Sequence[CorridorTracks], Sequence[CorridorTracks]]:
    middle = (tracks.first + tracks.last) // 2
    return [replace(tracks, last=middle)], [replace(tracks, first=middle)]


def _mean(scores: Sequence[RealismScore]) -> RealismScore:
    some = [s for s in scores if s.parts]
    if not some:
        return scores[0]
    cells = dict.fromkeys(c for s in some for c in s.cells)
    return RealismScore(
        score=sum(s.score for s in some) / len(some),
        parts={f: sum(s.parts[f] for s in some) / len(some) for f in some[0].parts},
        cells={c: _of(c, some) for c in cells},
    )


def _of(cell: tuple[str, str], scores: Sequence[RealismScore]) -> float:
    known = [s.cells[cell] for s in scores if cell in s.cells]
    return sum(known) / len(known)
