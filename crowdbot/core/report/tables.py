"""The report's table: every score as tidy CSV."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

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


def csv_parts(contents: Contents) -> Iterator[bytes]:
    """Yield the header, then the lines of each attempt: one per score, or one without scores.

    Texts that many lines share are quoted once. NaN, a value that is not there, is an empty cell.
    """
    axes = [axis["name"] for axis in contents.axes]
    scores = ScoreColumns.of(contents.results.scores)
    order = np.argsort(scores.run, kind="stable")
    ends = np.searchsorted(scores.run[order], np.arange(len(scores.run_ids) + 1))
    place_of = {name: i for i, name in enumerate(scores.run_ids)}
    lines = _Lines.of(scores, order)
    yield csv_cells((*_RUN, *(f"axis.{name}" for name in axes), *_SCORE)).encode() + _END
    for attempt in contents.attempts:
        labels = [attempt.axes.get(name, "") for name in axes]
        head = csv_cells((*_run_cells(attempt), *labels)).encode()
        place = place_of.get(attempt.run_id) if isinstance(attempt, RunRow) else None
        own = slice(0) if place is None else slice(ends[place], ends[place + 1])
        without = csv_cells(_without_scores(attempt)).encode()
        yield lines.of_run(head, own) or b"%b,%b%b" % (head, without, _END)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class _Lines:
    """Lines of scores, run by run.

    A text of ASCII is joined much faster than one of other letters, so the UTF-8 of texts passes
    for Latin-1 until a run's lines are complete.

    Attributes:
        before: text in front of the value, by label; ``behind``: after the value, without bounds.
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
    def of(scores: ScoreColumns, order: NDArray[np.intp]) -> _Lines:
        """Prepare scores, in an order by run."""
        count = max(1, len(scores.states))
        kinds, kind = np.unique(scores.label.astype(np.int64) * count + scores.state,
                                return_inverse=True)  # fmt: skip
        pairs = [divmod(k, count) for k in kinds.tolist()]
        cells = [csv_cells((*scores.labels[a][4:], *scores.states[b])) for a, b in pairs]
        return _Lines(
            before=[_latin(f",{csv_cells(label[:4])},") for label in scores.labels],
            behind=[_latin(f",{text},") for text in cells],
            label=scores.label[order], kind=kind[order], value=scores.value[order],
            lower=scores.lower[order], upper=scores.upper[order],
        )  # fmt: skip

    def of_run(self, head: bytes, own: slice) -> bytes:
        """Return the lines of one run; empty without scores."""
        start, end, behind = head.decode("latin-1"), _END.decode(), self.behind
        rest = [f"{behind[k]},{end}" for k in self.kind[own].tolist()]
        lower, upper = self.lower[own], self.upper[own]
        for i in np.flatnonzero(~(np.isnan(lower) & np.isnan(upper))).tolist():
            rest[i] = f"{behind[self.kind[own][i]]}{_number(lower[i])},{_number(upper[i])}{end}"
        before = map(self.before.__getitem__, self.label[own].tolist())
        lines = zip(before, self.value[own].tolist(), rest, strict=True)
        text = "".join([f"{start}{a}{'' if x != x else repr(x)}{b}" for a, x, b in lines])
        return text.encode("latin-1")


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


def _without_scores(attempt: Attempt) -> tuple[str, ...]:
    reason = attempt.error if isinstance(attempt, Failure) else "not_scored"
    cells = {"status": status_of(attempt), "reason": reason}
    return tuple(cells.get(name, "") for name in _SCORE)


def _cell(value: str | float | None) -> str:
    if isinstance(value, str):
        return value
    return "" if value is None else repr(float(value))
