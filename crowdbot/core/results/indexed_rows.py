"""Conversion between runs and the rows of ``results.sqlite``.

Texts that many runs share are stored once. A record is stored compressed and parsed on demand: most
queries need only the other columns.
"""

from __future__ import annotations

import json
import sqlite3
import zlib
from collections.abc import Iterable, Mapping, Sequence
from functools import cached_property
from itertools import pairwise
from typing import Any, cast

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.results.rows import RUN_COLUMNS, RunRow
from crowdbot.core.results.score_columns import ColumnState, IndexByValue, ScoreColumns, ScoreLabel
from crowdbot.core.runs.run_record import RunRecord
from crowdbot.core.types.score import Score

#: Columns with texts that runs share, by their number in the table ``texts``.
_SHARED = ("axes", "conditions", "provenance", "more", "labels", "states")
#: Properties of runs that are stored together as one shared text.
IN_MORE = (
    "changes", "source", "by_person", "role", "agents", "crowd", "suite_metrics", "axis_words",
    "replaced_draws",
)  # fmt: skip
_PLAIN = tuple(RUN_COLUMNS)
_TRUTHS = tuple(name for name, kind in RUN_COLUMNS.items() if kind == "BOOLEAN")
_SELECTED = (*_PLAIN, "moment", *_SHARED, "record", "scores")
_BYTES = 3 * 8 + 2  # of a score: value, bounds, state


class _ParsedRecord:
    """The record of an indexed run, parsed each time: thousands of them would fill memory."""

    def __get__(self, run: IndexedRun | None, owner: type) -> Any:
        if run is None:  # dataclasses ask for a default
            raise AttributeError("record")
        return RunRecord.model_validate_json(zlib.decompress(run._packed))


class IndexedRun(RunRow):
    """A run from the index, whose record is parsed on demand."""

    _packed: bytes = b""

    @staticmethod
    def of(known: Mapping[str, Any], more: Mapping[str, Any], packed: bytes) -> IndexedRun:
        """Return a run from its columns, the shared texts, and its compressed record."""
        run = object.__new__(IndexedRun)
        run.__dict__.update(known, **more, entry="", _packed=packed)
        return run

    record: RunRecord = cast(RunRecord, _ParsedRecord())

    def __repr__(self) -> str:
        return f"IndexedRun(directory={self.directory!r}, entry={self.entry!r})"


class _FromRecord:
    """A property of `RunRow` that an instance attribute of the same name overrides.

    Columns of the index are plain attributes of a run: pages read millions of them.
    """

    def __init__(self, plain: Any) -> None:
        self._plain = plain
        self.__doc__ = plain.__doc__

    def __get__(self, run: IndexedRun | None, owner: type) -> Any:
        if run is None:
            return self
        plain = self._plain
        return plain.func(run) if isinstance(plain, cached_property) else plain.__get__(run, owner)


for _name in (*_PLAIN, "moment", "axes", "conditions", "provenance", *IN_MORE):
    if _name != "directory":
        setattr(IndexedRun, _name, _FromRecord(vars(RunRow)[_name]))


class Texts:
    """The table of shared texts."""

    def __init__(self, database: sqlite3.Connection) -> None:
        self._database = database
        self._values: dict[int, Any] = {}
        self._numbers: dict[str, int] = {}

    def number(self, value: Any) -> int:
        """Return the index of a JSON value, which is added if it is new."""
        text = json.dumps(value)
        if text not in self._numbers:
            self._database.execute("INSERT OR IGNORE INTO texts (text) VALUES (?)", [text])
            (number,) = self._database.execute(
                "SELECT id FROM texts WHERE text = ?", [text]
            ).fetchone()
            self._numbers[text] = number
        return self._numbers[text]

    def value(self, number: int) -> Any:
        """Return the value with an index, the same object each time."""
        if not self._values:
            found = self._database.execute("SELECT id, text FROM texts")
            self._values = {i: json.loads(text) for i, text in found}
        return self._values[number]


def row_of(run: RunRow, scores: Sequence[Score], texts: Texts) -> dict[str, Any]:
    """Return the columns of a run with its scores."""
    ordered = sorted(scores, key=lambda s: (s.metric, s.variant))
    states = IndexByValue[tuple[str, str]]()
    state = np.array([states.place((s.status, s.reason)) for s in ordered], "<u2")
    numbers = [
        np.array([np.nan if x is None else x for x in column], "<f8")
        for column in zip(*((s.value, s.lower, s.upper) for s in ordered), strict=True)
    ] or [np.empty(0, "<f8")] * 3
    labels = [(s.category, s.metric, s.symbol, s.variant, s.unit, s.better) for s in ordered]
    shared = {
        "axes": dict(run.axes),
        "conditions": dict(run.conditions),
        "provenance": dict(run.provenance),
        "more": {name: getattr(run, name) for name in IN_MORE},
        "labels": labels,
        "states": list(states),
    }
    return {
        **{name: getattr(run, name) for name in _PLAIN},
        "position": run.record.position,
        "moment": None if run.moment is None else json.dumps(run.moment),
        **{name: texts.number(value) for name, value in shared.items()},
        "record": zlib.compress(run.record.model_dump_json(exclude_unset=True).encode(), 1),
        "scores": b"".join(a.tobytes() for a in (*numbers, state)),
    }


def read_all(database: sqlite3.Connection, order: str) -> tuple[tuple[RunRow, ...], ScoreColumns]:
    """Return all runs in some order, and their scores by run, metric and variant."""
    texts, runs, found = Texts(database), list[RunRow](), dict[int, _Packed]()
    query = f"SELECT {', '.join(_SELECTED)} FROM runs {order}"  # noqa: S608  names of ours
    for place, row in enumerate(database.execute(query)):
        known = dict(zip(_PLAIN, row, strict=False))
        known |= {name: bool(known[name]) for name in _TRUTHS}
        moment, *shared, labels, states, record, scores = row[len(_PLAIN) :]
        axes, conditions, provenance, more = map(texts.value, shared)
        known |= {"axes": axes, "conditions": conditions, "provenance": provenance}
        known["moment"] = None if moment is None else json.loads(moment)
        runs.append(IndexedRun.of(known, more, record))
        found.setdefault(labels, _Packed()).add(place, known["run_id"], states, scores)
    return tuple(runs), _columns(found, texts)


class _Packed:
    """Scores of runs that have the same labels.

    Attributes:
        places: of the runs in their order; ``ids``: of the runs.
        states: number of each run's states.
        scores: packed values of one run after the other.
    """

    def __init__(self) -> None:
        self.places, self.ids, self.states = list[int](), list[str](), list[int]()
        self.scores = bytearray()

    def add(self, place: int, run_id: str, states: int, scores: bytes) -> None:
        """Add a run."""
        self.places.append(place)
        self.ids.append(run_id)
        self.states.append(states)
        self.scores += scores


def _columns(found: Mapping[int, _Packed], texts: Texts) -> ScoreColumns:
    """Return the scores of runs by number of their labels."""
    known = IndexByValue[str](), IndexByValue[ScoreLabel](), IndexByValue[ColumnState]()
    parts = [_part(packed, texts.value(number), known, texts) for number, packed in found.items()]
    if len(parts) == 1:
        columns = list(parts[0][1:])
    else:
        order = np.concatenate([place for place, *_ in parts] or [np.empty(0, np.int32)])
        by_run = np.argsort(order, kind="stable")
        joined = zip(*(part[1:] for part in parts), strict=True)
        columns = [np.concatenate(some)[by_run] for some in joined]
    run, label, state, value, lower, upper = columns or _nothing()
    return ScoreColumns(
        run_ids=tuple(known[0]), labels=tuple(known[1]), states=tuple(known[2]),
        run=run, label=label, state=state, value=value, lower=lower, upper=upper,
    )  # fmt: skip


def _nothing() -> list[NDArray[Any]]:
    return [np.empty(0, kind) for kind in ("i4", "i4", "i4", "f8", "f8", "f8")]


def _part(
    found: _Packed,
    names: Sequence[Sequence[str]],
    known: tuple[IndexByValue[str], IndexByValue[ScoreLabel], IndexByValue[ColumnState]],
    texts: Texts,
) -> tuple[NDArray[Any], ...]:
    """Return places, then columns, of the scores of runs that have the same labels."""
    ids, labels, states = known
    label = np.array([labels.place(ScoreLabel(*one)) for one in names], "i4")
    width, count = len(label), len(found.ids)
    packed = np.frombuffer(found.scores, np.uint8).reshape(count, width * _BYTES)
    ends = [0, 8 * width, 16 * width, 24 * width, _BYTES * width]
    cut = [np.ascontiguousarray(packed[:, a:b]) for a, b in pairwise(ends)]
    value, lower, upper = (one.view("<f8").ravel() for one in cut[:3])
    state = cut[3].view("<u2").astype("i4")
    kinds = np.array(found.states)
    for kind in np.unique(kinds):
        table = np.array([states.place(ColumnState(*one)) for one in texts.value(int(kind))], "i4")
        here = kinds == kind
        state[here] = table[state[here]] if len(table) else state[here]
    run = np.array([ids.place(name) for name in found.ids], "i4")
    return (
        np.repeat(np.asarray(found.places, "i4"), width), np.repeat(run, width),
        np.tile(label, count), state.ravel(), value, lower, upper,
    )  # fmt: skip


def columns_of_table() -> Iterable[tuple[str, str]]:
    """Return names and types of the columns of runs besides `RUN_COLUMNS`."""
    yield from (("stamp", "TEXT"), ("position", "INTEGER"), ("moment", "TEXT"))
    yield from ((name, "INTEGER") for name in _SHARED)
    yield from (("record", "BLOB"), ("scores", "BLOB"))
