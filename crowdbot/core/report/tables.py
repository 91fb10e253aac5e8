"""The report's table: every score as tidy CSV."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import islice
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pydantic_core import to_json

from crowdbot.core.report.contents import Contents
from crowdbot.core.report.encode import Attempt, status_of
from crowdbot.core.report.provenance import short
from crowdbot.core.results.failure import Failure
from crowdbot.core.results.rows import RunRow
from crowdbot.core.results.score_columns import ScoreColumns
from crowdbot.core.scoring.scores_csv import csv_cells, csv_lines

_RUN = ("suite", "scenario", "planner", "seed", "run_status", "run_id", "realisation", "density")
_SCORE = (
    "category", "metric", "symbol", "variant", "value", "unit", "better", "status", "reason",
    "lower", "upper",
)  # fmt: skip

_END = b"\r\n"
#: Stands for what all lines of a run begin with; texts of scores have no such character.
_START = b"\0"
#: Smallest size of a number that is written without an exponent, and the first with one again.
_PLAIN = 1e-4, 1e16
#: Attempts whose lines are made together.
_AT_ONCE = 64


def csv_parts(contents: Contents) -> Iterator[bytes]:
    """Yield the header, then the lines of each attempt: one per score, or one without scores.

    Texts that many lines share are quoted once. NaN, a value that is not there, is an empty cell.
    """
    axes = [axis["name"] for axis in contents.axes]
    lines = _Lines.of(ScoreColumns.of(contents.results.scores).by_run)
    yield csv_cells((*_RUN, *(f"axis.{name}" for name in axes), *_SCORE)).encode() + _END
    attempts = iter(contents.attempts)
    while some := [*islice(attempts, _AT_ONCE)]:
        cells = [(*_run_cells(a), *(a.axes.get(name, "") for name in axes)) for a in some]
        heads = [line.encode() for line in csv_lines(cells)]
        ids = [a.run_id if isinstance(a, RunRow) else None for a in some]
        for attempt, head, own in zip(some, heads, lines.of_runs(heads, ids), strict=True):
            yield own or _line_without_scores(head, attempt)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class _Lines:
    """Lines of scores that are ordered by run.

    Attributes:
        place: id of a run -> its place; its scores are those from ``ends[place]`` on.
        first: text in front of the first value of a run, by label.
        between: text from behind a value to the next one, or to the end of the run's lines;
            ``cut``: what is in it before the comma between bounds.
        scores: the scores.
        kind: (n,) place of each score's text in ``between``.
    """

    place: Mapping[str, int]
    ends: Sequence[int]
    first: Sequence[bytes]
    between: Sequence[bytes]
    cut: Sequence[int]
    scores: ScoreColumns
    kind: NDArray[np.intp]

    @staticmethod
    def of(scores: ScoreColumns) -> _Lines:
        """Prepare scores that are ordered by run."""
        ends = np.searchsorted(scores.run, np.arange(len(scores.run_ids) + 1))
        first = [b"%b,%b," % (_START, csv_cells(label[:4]).encode()) for label in scores.labels]
        state, pairs = _numbered(scores.label, scores.state, len(scores.states))
        cells = csv_lines((*scores.labels[a][4:], *scores.states[b]) for a, b in pairs)
        behind = [b",%b," % text.encode() for text in cells]
        following = np.append(scores.label[1:], len(first))
        following[ends[1:][ends[1:] > 0] - 1] = len(first)
        kind, joints = _numbered(state, following, len(first) + 1)
        before = [*first, b""]
        return _Lines(
            place={name: i for i, name in enumerate(scores.run_ids)},
            ends=ends.tolist(),
            first=first,
            between=[b"%b,%b%b" % (behind[a], _END, before[b]) for a, b in joints],
            cut=[len(behind[a]) for a, _ in joints],
            scores=scores,
            kind=kind,
        )

    def of_runs(self, heads: Sequence[bytes], ids: Sequence[str | None]) -> Iterator[bytes]:
        """Yield the lines of some runs, each begun by its head; empty without scores."""
        places = [None if name is None else self.place.get(name) for name in ids]
        owns = [range(0) if p is None else range(*self.ends[p : p + 2]) for p in places]
        rows = np.concatenate([np.arange(own.start, own.stop) for own in owns])
        values, rest, labels = number_texts(self.scores.value[rows]), self._rest(rows), self.first
        start = 0
        for head, own in zip(heads, owns, strict=True):
            stop = start + len(own)
            parts = [b""] * (1 + 2 * len(own))
            parts[1::2], parts[2::2] = values[start:stop], rest[start:stop]
            if own:
                parts[0] = labels[self.scores.label[own.start]]
            yield b"".join(parts).replace(_START, head)
            start = stop

    def _rest(self, rows: NDArray[np.intp]) -> list[bytes]:
        """Return the texts behind the values of some scores, with their bounds."""
        lower, upper, kinds = self.scores.lower[rows], self.scores.upper[rows], self.kind[rows]
        rest = [*map(self.between.__getitem__, kinds.tolist())]
        for i in (~(np.isnan(lower) & np.isnan(upper))).nonzero()[0].tolist():
            bounds = b",".join(number_texts(np.array([lower[i], upper[i]])))
            cut = self.cut[kinds[i]]
            rest[i] = b"%b%b%b" % (rest[i][:cut], bounds, rest[i][cut + 1 :])
        return rest


def _numbered(
    one: NDArray[np.integer[Any]], other: NDArray[np.integer[Any]], count: int
) -> tuple[NDArray[np.intp], list[tuple[int, int]]]:
    """Return the number of each pair (n,), and the different pairs; ``other`` is below count."""
    pair = one.astype(np.intp) * max(1, count) + other
    there = np.bincount(pair, minlength=1) > 0
    pairs = [divmod(k, max(1, count)) for k in np.flatnonzero(there).tolist()]
    return (np.cumsum(there) - 1)[pair], pairs


def number_texts(numbers: NDArray[np.float64]) -> list[bytes]:
    """Return numbers (n,) as Python writes them; NaN as an empty text.

    Numbers without an exponent, which are most, are written together in compiled code.
    """
    if not len(numbers):
        return []
    texts = to_json(numbers.tolist())[1:-1].replace(b"NaN", b"").split(b",")
    size = np.abs(numbers)
    with_exponent = (size < _PLAIN[0]) & (size > 0.0) | (size >= _PLAIN[1])
    for i in with_exponent.nonzero()[0].tolist():
        texts[i] = repr(float(numbers[i])).encode()
    return texts


def _run_cells(attempt: Attempt) -> tuple[str, ...]:
    cells = (attempt.suite, attempt.scenario, attempt.planner, str(attempt.seed))
    if isinstance(attempt, Failure):
        return (*cells, status_of(attempt), "", "", "")
    more = (
        attempt.status,
        short(attempt.run_id),
        short(attempt.realisation_hash),
        _cell(attempt.density),
    )
    return (*cells, *more)


def _line_without_scores(head: bytes, attempt: Attempt) -> bytes:
    reason = attempt.error if isinstance(attempt, Failure) else "not_scored"
    cells = {"status": status_of(attempt), "reason": reason}
    without = csv_cells([cells.get(name, "") for name in _SCORE]).encode()
    return b"%b,%b%b" % (head, without, _END)


def _cell(value: str | float | None) -> str:
    if isinstance(value, str):
        return value
    return "" if value is None else repr(float(value))
