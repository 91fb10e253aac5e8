"""The report's table: every score as tidy CSV."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from pydantic_core import to_json

from crowdbot.core.report.contents import Contents
from crowdbot.core.report.encode import Attempt, status_of
from crowdbot.core.report.provenance import short
from crowdbot.core.results.failure import Failure
from crowdbot.core.results.rows import RunRow
from crowdbot.core.results.score_columns import ScoreColumns
from crowdbot.core.scoring.scores_csv import csv_cells

_RUN = ("suite", "scenario", "planner", "seed", "run_status", "run_id", "realisation", "density")
_SCORE = (
    "category", "metric", "symbol", "variant", "value", "unit", "better", "status", "reason",
    "lower", "upper",
)  # fmt: skip

_END = b"\r\n"
#: End of a line without bounds.
_NO_BOUNDS = f",{_END.decode()}"
#: Stands for what all lines of a run begin with; texts of scores have no such character.
_START = "\0"
#: Smallest size of a number that is written without an exponent, and the first with one again.
_PLAIN = 1e-4, 1e16


def csv_parts(contents: Contents) -> Iterator[bytes]:
    """Yield the header, then the lines of each attempt: one per score, or one without scores.

    Texts that many lines share are quoted once. NaN, a value that is not there, is an empty cell.
    """
    axes = [axis["name"] for axis in contents.axes]
    scores = ScoreColumns.of(contents.results.scores).by_run
    ends = np.searchsorted(scores.run, np.arange(len(scores.run_ids) + 1))
    place_of = {name: i for i, name in enumerate(scores.run_ids)}
    lines = _Lines.of(scores)
    yield csv_cells((*_RUN, *(f"axis.{name}" for name in axes), *_SCORE)).encode() + _END
    for attempt in contents.attempts:
        labels = [attempt.axes.get(name, "") for name in axes]
        head = csv_cells((*_run_cells(attempt), *labels)).encode()
        place = place_of.get(attempt.run_id) if isinstance(attempt, RunRow) else None
        own = slice(0) if place is None else slice(ends[place], ends[place + 1])
        yield lines.of_run(head, own) or _line_without_scores(head, attempt)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class _Lines:
    """Lines of scores, run by run.

    A text of ASCII is joined much faster than one of other letters, so the UTF-8 of texts passes
    for Latin-1 until a run's lines are complete.

    Attributes:
        before: text in front of the value, by label, with a mark for what all lines of a run begin
            with; ``behind``: after the value, without bounds.
        label, kind, value, lower, upper: (n,) of each score; ``kind`` is its place in ``behind``.
    """

    before: Sequence[str]
    behind: Sequence[str]
    label: NDArray[np.int32]
    kind: NDArray[np.intp]
    value: NDArray[np.float64]
    lower: NDArray[np.float64]
    upper: NDArray[np.float64]

    @staticmethod
    def of(scores: ScoreColumns) -> _Lines:
        """Prepare scores that are ordered by run."""
        count = max(1, len(scores.states))
        pair = scores.label.astype(np.intp) * count + scores.state
        there = np.bincount(pair, minlength=1) > 0
        pairs = [divmod(k, count) for k in np.flatnonzero(there).tolist()]
        cells = [csv_cells((*scores.labels[a][4:], *scores.states[b])) for a, b in pairs]
        return _Lines(
            before=[_latin(f"{_START},{csv_cells(label[:4])},") for label in scores.labels],
            behind=[_latin(f",{text},{_NO_BOUNDS}") for text in cells],
            label=scores.label, kind=(np.cumsum(there) - 1)[pair], value=scores.value,
            lower=scores.lower, upper=scores.upper,
        )  # fmt: skip

    def of_run(self, head: bytes, own: slice) -> bytes:
        """Return the lines of one run; empty without scores."""
        kinds, lower, upper = self.kind[own], self.lower[own], self.upper[own]
        rest = [*map(self.behind.__getitem__, kinds.tolist())]
        for i in (~(np.isnan(lower) & np.isnan(upper))).nonzero()[0].tolist():
            bounds = f"{_number(lower[i])},{_number(upper[i])}"
            rest[i] = f"{rest[i].removesuffix(_NO_BOUNDS)}{bounds}{_NO_BOUNDS[1:]}"
        parts = [""] * (3 * len(rest))
        parts[0::3] = map(self.before.__getitem__, self.label[own].tolist())
        parts[1::3] = number_texts(self.value[own])
        parts[2::3] = rest
        return "".join(parts).replace(_START, head.decode("latin-1")).encode("latin-1")


def number_texts(numbers: NDArray[np.float64]) -> list[str]:
    """Return numbers (n,) as Python writes them; NaN as an empty text.

    Numbers without an exponent, which are most, are written together in compiled code.
    """
    if not len(numbers):
        return []
    texts = to_json(numbers.tolist()).decode()[1:-1].replace("NaN", "").split(",")
    size = np.abs(numbers)
    with_exponent = (size < _PLAIN[0]) & (size > 0.0) | (size >= _PLAIN[1])
    for i in with_exponent.nonzero()[0].tolist():
        texts[i] = repr(float(numbers[i]))
    return texts


def _latin(text: str) -> str:
    return text.encode().decode("latin-1")


def _number(value: float) -> str:
    return "" if np.isnan(value) else repr(float(value))


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
