"""The report's table: every score as tidy CSV."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from itertools import islice

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
    lines = _Lines(ScoreColumns.of(contents.results.scores).by_run)
    yield csv_cells((*_RUN, *(f"axis.{name}" for name in axes), *_SCORE)).encode() + _END
    attempts = iter(contents.attempts)
    while some := [*islice(attempts, _AT_ONCE)]:
        cells = [(*_run_cells(a), *(a.axes.get(name, "") for name in axes)) for a in some]
        heads = [line.encode() for line in csv_lines(cells)]
        ids = [a.run_id if isinstance(a, RunRow) else None for a in some]
        for attempt, head, own in zip(some, heads, lines.of_runs(heads, ids), strict=True):
            yield own or _line_without_scores(head, attempt)


class _Lines:
    """Lines of scores that are ordered by run."""

    def __init__(self, scores: ScoreColumns) -> None:
        self._scores = scores
        self._place = {name: i for i, name in enumerate(scores.run_ids)}
        ends = np.searchsorted(scores.run, np.arange(len(scores.run_ids) + 1))
        self._ends: list[int] = ends.tolist()
        firsts = [b"%b,%b," % (_START, csv_cells(label[:4]).encode()) for label in scores.labels]
        self._firsts = [*firsts, b""]  # the last for the end of a run
        self._behind = _Texts(self._make_behind)
        self._between = _Texts(self._make_between)

    def of_runs(self, heads: Sequence[bytes], ids: Sequence[str | None]) -> Iterator[bytes]:
        """Yield the lines of some runs, each begun by its head; empty without scores."""
        places = [None if name is None else self._place.get(name) for name in ids]
        owns = [range(0) if p is None else range(*self._ends[p : p + 2]) for p in places]
        rows = np.concatenate([np.arange(own.start, own.stop) for own in owns])
        stops = np.cumsum([len(own) for own in owns if own], dtype=np.intp)
        values, rest = number_texts(self._scores.value[rows]), self._rest(rows, stops)
        start = 0
        for head, own in zip(heads, owns, strict=True):
            stop = start + len(own)
            parts = [b""] * (1 + 2 * len(own))
            parts[1::2], parts[2::2] = values[start:stop], rest[start:stop]
            if own:
                parts[0] = self._firsts[self._scores.label[own.start]]
            yield b"".join(parts).replace(_START, head)
            start = stop

    def _rest(self, rows: NDArray[np.intp], stops: NDArray[np.intp]) -> list[bytes]:
        """Return the CSV text after each of some values, up to the next value or run.

        Args:
            rows: (n,) places of the scores.
            stops: where each run ends among them.
        """
        scores = self._scores
        label, lower, upper = (x[rows] for x in (scores.label, scores.lower, scores.upper))
        pair = label.astype(np.intp) * len(scores.states) + scores.state[rows]
        following = np.append(label[1:], 0)[: len(label)]
        following[stops - 1] = len(scores.labels)
        numbers = pair * len(self._firsts) + following
        rest = [*map(self._between.__getitem__, numbers.tolist())]
        for i in (~(np.isnan(lower) & np.isnan(upper))).nonzero()[0].tolist():
            behind = self._behind[int(pair[i])]
            bounds = b",".join(number_texts(np.array([lower[i], upper[i]])))
            rest[i] = b"%b%b%b" % (behind, bounds, rest[i][len(behind) + 1 :])
        return rest

    def _make_behind(self, pair: int) -> bytes:
        """Return the CSV text between a value and its bounds, for a pair of label and state."""
        label, state = divmod(pair, len(self._scores.states))
        cells = (*self._scores.labels[label][4:], *self._scores.states[state])
        return b",%b," % csv_cells(cells).encode()

    def _make_between(self, number: int) -> bytes:
        """Return the CSV text between a value without bounds and the next value."""
        pair, following = divmod(number, len(self._firsts))
        return b"%b,%b%b" % (self._behind[pair], _END, self._firsts[following])


class _Texts(dict[int, bytes]):
    """Texts by number, made when they are first asked for."""

    def __init__(self, make: Callable[[int], bytes]) -> None:
        super().__init__()
        self._make = make

    def __missing__(self, number: int) -> bytes:
        self[number] = text = self._make(number)
        return text


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
