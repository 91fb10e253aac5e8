"""Scores of many runs as columns of numbers, which read like a sequence of `ScoreRow`.

Rows as objects would take a few hundred bytes each, and a campaign has hundreds of thousands.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import NamedTuple, TypeVar, overload

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.results.rows import ScoreRow

_Floats = NDArray[np.float64]
_Places = NDArray[np.int32]
_Value = TypeVar("_Value")


class ScoreLabel(NamedTuple):
    """Properties that all values of one score share."""

    category: str
    metric: str
    symbol: str
    variant: str
    unit: str
    better: str

    @property
    def name(self) -> tuple[str, str]:
        """Metric and variant."""
        return self.metric, self.variant


class ColumnState(NamedTuple):
    """Status and reason of a value."""

    status: str
    reason: str


@dataclass(frozen=True, slots=False, eq=False, kw_only=True)
class ScoreColumns(Sequence[ScoreRow]):
    """Scores of many runs, one array per column.

    Attributes:
        run_ids, labels, states: distinct values that the rows refer to.
        run, label, state: (n,) places in them.
        value, lower, upper: (n,); NaN where there is none.
    """

    run_ids: tuple[str, ...]
    labels: tuple[ScoreLabel, ...]
    states: tuple[ColumnState, ...]
    run: _Places
    label: _Places
    state: _Places
    value: _Floats
    lower: _Floats
    upper: _Floats

    @staticmethod
    def of(rows: Sequence[ScoreRow]) -> ScoreColumns:
        """Return rows as columns; columns are returned unchanged."""
        if isinstance(rows, ScoreColumns):
            return rows
        runs, labels, states = (
            IndexByValue[str](),
            IndexByValue[ScoreLabel](),
            IndexByValue[ColumnState](),
        )
        places = [
            (
                runs.place(r.run_id),
                labels.place(
                    ScoreLabel(r.category, r.metric, r.symbol, r.variant, r.unit, r.better)
                ),
                states.place(ColumnState(r.status, r.reason)),
            )
            for r in rows
        ]
        run, label, state = np.array(places, np.int32).reshape(-1, 3).T
        numbers = [
            np.array([math.nan if x is None else x for x in column], np.float64)
            for column in (
                [r.value for r in rows], [r.lower for r in rows], [r.upper for r in rows],
            )
        ]  # fmt: skip
        return ScoreColumns(
            run_ids=tuple(runs), labels=tuple(labels), states=tuple(states),
            run=run, label=label, state=state,
            value=numbers[0], lower=numbers[1], upper=numbers[2],
        )  # fmt: skip

    def __len__(self) -> int:
        return len(self.run)

    @overload
    def __getitem__(self, place: int) -> ScoreRow: ...
    @overload
    def __getitem__(self, place: slice) -> ScoreColumns: ...
    def __getitem__(self, place: int | slice) -> ScoreRow | ScoreColumns:
        """Return one row, or a part."""
        return self._part(place) if isinstance(place, slice) else self._row(range(len(self))[place])

    def __iter__(self) -> Iterator[ScoreRow]:
        return map(self._row, range(len(self)))

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Sequence):
            return NotImplemented
        return len(self) == len(other) and all(map(_same, self, other))

    __hash__ = None  # type: ignore[assignment]

    @property
    def metrics(self) -> frozenset[str]:
        """Names of all metrics."""
        return frozenset(self.labels[i].metric for i in np.unique(self.label))

    def of_runs(self, ids: Collection[str]) -> ScoreColumns:
        """Return the scores of some runs."""
        chosen = np.array([name in ids for name in self.run_ids], np.bool_)
        return self if chosen.all() else self._part(np.flatnonzero(chosen[self.run]))

    @cached_property
    def by_name(self) -> dict[tuple[str, str], NDArray[np.intp]]:
        """Return metric and variant -> places of its rows, in the order of first appearance."""
        small = len(self.labels) <= np.iinfo(np.uint16).max  # sorted by digits, much faster
        order = np.argsort(self.label.astype(np.uint16) if small else self.label, kind="stable")
        ends = np.searchsorted(self.label[order], np.arange(len(self.labels) + 1))
        parts = [order[a:b] for a, b in pairwise(ends)]
        found: dict[tuple[str, str], list[NDArray[np.intp]]] = {}
        for label, part in zip(self.labels, parts, strict=True):
            if len(part):
                found.setdefault(label.name, []).append(part)
        return {name: np.sort(np.concatenate(some)) for name, some in found.items()}

    @property
    def by_run(self) -> ScoreColumns:
        """Return the same scores in the order of their runs."""
        if np.all(self.run[1:] >= self.run[:-1]):
            return self
        return self._part(np.argsort(self.run, kind="stable"))

    def _row(self, place: int) -> ScoreRow:
        label, state = self.labels[self.label[place]], self.states[self.state[place]]
        return ScoreRow(
            run_id=self.run_ids[self.run[place]],
            **label._asdict(),
            value=_number(self.value[place], known=state.status == "ok"),
            status=state.status,
            reason=state.reason,
            lower=_number(self.lower[place]),
            upper=_number(self.upper[place]),
        )

    def _part(self, places: slice | NDArray[np.intp]) -> ScoreColumns:
        return ScoreColumns(
            run_ids=self.run_ids, labels=self.labels, states=self.states,
            run=self.run[places], label=self.label[places], state=self.state[places],
            value=self.value[places], lower=self.lower[places], upper=self.upper[places],
        )  # fmt: skip


class IndexByValue(dict[_Value, int]):
    """Values with indices in the order of first appearance."""

    def place(self, value: _Value) -> int:
        """Return the index of a value, which is added if it is new."""
        return self.setdefault(value, len(self))


def different(objects: Sequence[_Value]) -> tuple[list[_Value], NDArray[np.intp]]:
    """Return the different objects in order of first appearance, and the place of each (n,).

    Equal objects count as different: runs of the index share theirs.
    """
    found = {id(one): one for one in objects}
    places = {number: i for i, number in enumerate(found)}
    return list(found.values()), np.array([places[id(one)] for one in objects], np.intp)


def of_runs(scores: Sequence[ScoreRow], ids: Collection[str]) -> Sequence[ScoreRow]:
    """Return the scores of some runs."""
    if isinstance(scores, ScoreColumns):
        return scores.of_runs(ids)
    return tuple(s for s in scores if s.run_id in ids)


def metrics_of(scores: Sequence[ScoreRow]) -> frozenset[str]:
    """Return the names of all metrics of some scores."""
    if isinstance(scores, ScoreColumns):
        return scores.metrics
    return frozenset(s.metric for s in scores)


def _number(value: float, *, known: bool = False) -> float | None:
    return None if math.isnan(value) and not known else float(value)


def _same(a: ScoreRow, b: ScoreRow) -> bool:
    """Return True if two rows are equal, NaN included."""
    return a == b or repr(a) == repr(b)
