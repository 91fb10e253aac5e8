"""Results laid out by what is paired: scenario and seed in rows, planners in columns."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.results.results import Results
from crowdbot.core.results.rows import WITHOUT_RUN, RunRow, ScoreRow
from crowdbot.core.scoring.score_scale import UNKNOWN, ScoreScale
from crowdbot.core.statistics.clusters import Clusters, Floats
from crowdbot.core.statistics.estimate import OUTCOMES, Counts
from crowdbot.core.types.ending import has_failed
from crowdbot.dsl.suite.matrix import DRAW

#: Suite, scenario, seed: what runs are paired by.
Key = tuple[str, str, int]
#: Metric and variant.
Name = tuple[str, str]

_Read = tuple[int, str, tuple[float, float]]

OK, CENSORED, UNDEFINED, FAILED, MISSING = range(len(OUTCOMES))

#: What people score in metrics that compare with them, where it is not 1, the ratio of equals.
#: None: it is not among the scores, so that no distance can be told.
REFERENCES: Mapping[str, float | None] = {"overtaking_count": None}


@dataclass(frozen=True, slots=True, eq=False)
class Column:
    """One score of one planner in every row of the table.

    Attributes:
        outcome: (n,) index into `OUTCOMES`.
        low, high: (n,) bounds of the value: equal where it is known, infinite where nothing is.
        failed: (n,) where the planner failed or no run could be made; there may be a value.
        reasons: why values are missing -> how often.
    """

    outcome: NDArray[np.int8]
    low: Floats
    high: Floats
    failed: NDArray[np.bool_]
    reasons: Mapping[str, int]

    @property
    def known(self) -> NDArray[np.bool_]:
        """Where there is a value."""
        return np.asarray(self.outcome == OK)

    @property
    def counts(self) -> Counts:
        """How many of each."""
        return counts_of(self.outcome)


class Table:
    """Rows are scenario x seed, columns planner x score.

    A run whose planner failed keeps its values: it is a run whose robot did not arrive. One that
    could not be made (`Results.failures`) counts as failed unless it was made after all.
    """

    def __init__(self, results: Results) -> None:
        self.runs = {(r.planner, _key(r)): r for r in results.runs}
        made = {(f.planner, (f.suite, f.scenario, f.seed)): f.error for f in results.failures}
        self.failures = {place: why for place, why in made.items() if place not in self.runs}
        places = [*self.runs, *self.failures]
        self.keys: tuple[Key, ...] = tuple(dict.fromkeys(key for _, key in places))
        self.planners = tuple(sorted({planner for planner, _ in places}))
        self.scales = results.scales
        self._rows = _by_score(results.scores)
        self._columns: dict[tuple[Name, str], Column] = {}
        self._attempts: dict[str, list[tuple[RunRow | None, bool]]] = {}

    @cached_property
    def names(self) -> tuple[Name, ...]:
        """All scores, sorted."""
        return tuple(sorted(self._rows))

    def label(self, name: Name) -> ScoreRow:
        """A row that says unit, category and direction of a score."""
        return next(iter(self._rows[name].values()))

    @cached_property
    def draws(self) -> tuple[str, ...]:
        """The crowd draw of each row; where nobody walks, the scenario itself."""
        found = {key: _draw(run) for (_, key), run in self.runs.items()}
        known = {key[:2]: draw for key, draw in found.items()}
        return tuple(found.get(k) or known.get(k[:2]) or f"{k[0]}/{k[1]}" for k in self.keys)

    @cached_property
    def conditions(self) -> tuple[str, ...]:
        """What the suite says of each row: its labels on all axes but `DRAW`."""
        found = {key: _condition(key, run.axes) for (_, key), run in self.runs.items()}
        known = {key[:2]: condition for key, condition in found.items()}
        return tuple(found.get(k) or known.get(k[:2]) or f"{k[0]}/{k[1]}" for k in self.keys)

    @cached_property
    def clusters(self) -> Clusters:
        """The crowd draws of all rows; conditions are strata where each has several draws."""
        return Clusters.of(self.draws, self.conditions)

    def reference(self, name: Name) -> float | None:
        """What a score that compares with people is to be near to."""
        return REFERENCES.get(name[0], 1.0)

    def scale(self, name: Name) -> ScoreScale:
        """Bounds of a score, and what it is a rate over."""
        return self.scales.get(name, UNKNOWN)

    def exposure_name(self, name: Name) -> Name | None:
        """The score that a rate is over; None where it is not a rate, or the runs lack that."""
        over = name[0], self.scale(name).rate_over
        return over if over[1] and over in self._rows else None

    def exposure(self, name: Name, planner: str) -> Floats | None:
        """What a rate of one planner is over in each row, (n,); NaN where that is not known.

        None where the score is not a rate, or the runs do not have what it is over.
        """
        over = self.exposure_name(name)
        if over is None:
            return None
        column = self.column(over, planner)
        return np.where(column.known & (column.low > 0.0), column.low, np.nan)

    def column(self, name: Name, planner: str) -> Column:
        """One score of one planner."""
        if (name, planner) not in self._columns:
            self._columns[name, planner] = self._column(name, planner)
        return self._columns[name, planner]

    def _column(self, name: Name, planner: str) -> Column:
        rows, tried = self._rows.get(name, {}), self._tried(planner)
        found = [
            _without_run(name[0]) if lost else _read(run, rows.get(run.run_id) if run else None)
            for run, lost in tried
        ]
        outcome = np.array([kind for kind, _, _ in found], dtype=np.int8)
        low, high = np.array([bounds for *_, bounds in found], dtype=np.float64).reshape(-1, 2).T
        failed = [lost or (run is not None and has_failed(run.status)) for run, lost in tried]
        reasons = Counter(why for _, why, _ in found if why)
        return Column(
            outcome, low.copy(), high.copy(), np.array(failed, np.bool_),
            dict(sorted(reasons.items())),
        )  # fmt: skip

    def _tried(self, planner: str) -> list[tuple[RunRow | None, bool]]:
        """For each row the run of a planner, and whether it could not be made."""
        if planner not in self._attempts:
            places = [(planner, key) for key in self.keys]
            self._attempts[planner] = [(self.runs.get(p), p in self.failures) for p in places]
        return self._attempts[planner]


def counts_of(outcome: NDArray[np.int8]) -> Counts:
    """How many of each outcome."""
    found = np.bincount(outcome, minlength=len(OUTCOMES))
    return Counts(**dict(zip(OUTCOMES, map(int, found), strict=True)))


def _by_score(scores: Sequence[ScoreRow]) -> dict[Name, dict[str, ScoreRow]]:
    found: dict[Name, dict[str, ScoreRow]] = {}
    for row in scores:
        found.setdefault((row.metric, row.variant), {})[row.run_id] = row
    return found


def _key(run: RunRow) -> Key:
    return run.suite, run.scenario, run.seed


def _draw(run: RunRow) -> str:
    """Its people; without people, or with none that are known, the scenario itself."""
    nobody = run.density is None and run.record.agents == "none"
    return f"{run.suite}/{run.scenario}" if nobody else run.realisation_hash


def _condition(key: Key, axes: Mapping[str, str]) -> str:
    """Labels on all axes but `DRAW`; the scenario itself where there are none."""
    labels = [f"{axis}={label}" for axis, label in axes.items() if axis != DRAW]
    return "/".join([key[0], *(labels or ([] if DRAW in axes else [key[1]]))])


def _without_run(metric: str) -> _Read:
    """Outcome, reason and bounds of a score of an attempt that left no run."""
    if metric in WITHOUT_RUN:
        return OK, "", (WITHOUT_RUN[metric], WITHOUT_RUN[metric])
    return FAILED, "no_run", (-math.inf, math.inf)


def _read(run: RunRow | None, score: ScoreRow | None) -> _Read:
    """Outcome, reason and bounds of one score of one run."""
    nothing = (-math.inf, math.inf)
    if run is None:
        return MISSING, "", nothing
    has_value = score is not None and score.status == "ok" and score.value is not None
    if has_failed(run.status) and not has_value:
        return FAILED, run.status, nothing
    if score is None:
        return UNDEFINED, "not_scored", nothing
    if score.status == "censored":
        return CENSORED, score.reason, (_end(score.lower, -1.0), _end(score.upper, 1.0))
    if score.status != "ok" or score.value is None:
        return UNDEFINED, score.reason or "no_value", nothing
    if not math.isfinite(score.value):
        return UNDEFINED, "not_finite", nothing
    return OK, "", (score.value, score.value)


def _end(bound: float | None, side: float) -> float:
    return side * math.inf if bound is None or math.isnan(bound) else bound
