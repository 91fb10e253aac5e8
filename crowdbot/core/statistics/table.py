"""Results as a paired table: scenario and seed in rows, planners in columns."""

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
from crowdbot.core.types.ending import Ending, has_failed
from crowdbot.dsl.suite.matrix import DRAW

#: Suite, scenario, seed: the key for pairing runs.
Key = tuple[str, str, int]
#: Metric and variant.
Name = tuple[str, str]

_Read = tuple[int, str, tuple[float, float]]

OK, CENSORED, UNDEFINED, FAILED, MISSING = range(len(OUTCOMES))

#: Reference value of metrics that compare with people, if it is not 1, the ratio of equals. None:
#: it is not among the scores, so no distance can be computed.
REFERENCES: Mapping[str, float | None] = {"overtaking_count": None}


@dataclass(frozen=True, slots=True, eq=False)
class Column:
    """One score of one planner in every row of the table.

    Attributes:
        outcome: (n,) index into `OUTCOMES`.
        low, high: (n,) bounds of the value: equal if known, infinite if nothing is known.
        failed: (n,) True if the planner failed or no run could be made; there may be a value.
        reasons: why values are missing -> how often.
    """

    outcome: NDArray[np.int8]
    low: Floats
    high: Floats
    failed: NDArray[np.bool_]
    reasons: Mapping[str, int]

    @property
    def known(self) -> NDArray[np.bool_]:
        """Return a mask of known values."""
        return np.asarray(self.outcome == OK)

    @property
    def counts(self) -> Counts:
        """Return the number of each outcome."""
        return counts_of(self.outcome)


class Table:
    """A table with scenario x seed in rows and planner x score in columns.

    A run whose planner failed keeps its values: it is a run whose robot did not arrive. A run that
    could not be made (`Results.failures`) counts as failed unless a later attempt succeeded.
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
        """Return a row with unit, category and direction of a score."""
        return next(iter(self._rows[name].values()))

    @cached_property
    def draws(self) -> tuple[str, ...]:
        """Return the crowd draw of each row; the scenario itself if it has no people."""
        found = {key: _draw(run) for (_, key), run in self.runs.items()}
        known = {key[:2]: draw for key, draw in found.items()}
        return tuple(found.get(k) or known.get(k[:2]) or f"{k[0]}/{k[1]}" for k in self.keys)

    @cached_property
    def conditions(self) -> tuple[str, ...]:
        """Return the condition of each row: its labels on all axes except `DRAW`."""
        found = {key: _condition(key, run.axes) for (_, key), run in self.runs.items()}
        known = {key[:2]: condition for key, condition in found.items()}
        return tuple(found.get(k) or known.get(k[:2]) or f"{k[0]}/{k[1]}" for k in self.keys)

    @cached_property
    def clusters(self) -> Clusters:
        """Return the crowd draws of all rows; conditions are strata if each has several draws."""
        return Clusters.of(self.draws, self.conditions)

    def reference(self, name: Name) -> float | None:
        """Return the target value of a score that compares with people."""
        return REFERENCES.get(name[0], 1.0)

    def scale(self, name: Name) -> ScoreScale:
        """Return the bounds of a score, and the exposure of a rate."""
        return self.scales.get(name, UNKNOWN)

    def exposure_name(self, name: Name) -> Name | None:
        """Return the score by which a rate is divided.

        None if not a rate or missing in the runs.
        """
        over = name[0], self.scale(name).rate_over
        return over if over[1] and over in self._rows else None

    def exposure(self, name: Name, planner: str) -> Floats | None:
        """Return the exposure of one planner's rate in each row, (n,); NaN if unknown.

        None if the score is not a rate, or the runs lack its exposure.
        """
        over = self.exposure_name(name)
        if over is None:
            return None
        column = self.column(over, planner)
        return np.where(column.known & (column.low > 0.0), column.low, np.nan)

    def lacking(self, planner: str) -> NDArray[np.bool_]:
        """Return a mask (n,) of rows that a planner should have run and has not.

        These are all scenarios of a suite with the run seeds that it has in any of them. Floors and
        ceilings are measures: they run in part of a suite, and lack nothing.
        """
        tried = np.array([run is not None or lost for run, lost in self._tried(planner)], np.bool_)
        roles = {run.role for run, _ in self._tried(planner) if run is not None}
        if roles & {"floor", "ceiling"}:
            return np.zeros_like(tried)
        seeds = {key[::2] for key, here in zip(self.keys, tried, strict=True) if here}
        return ~tried & np.array([key[::2] in seeds for key in self.keys], np.bool_)

    def arrived(self, planner: str) -> NDArray[np.bool_]:
        """Return a mask (n,) of rows in which a planner's robot arrived."""
        runs = (run for run, _ in self._tried(planner))
        return np.array([run is not None and run.status == Ending.ARRIVED for run in runs], bool)

    def column(self, name: Name, planner: str) -> Column:
        """Return one score of one planner."""
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
        """Return a planner's run for each row, and True if it could not be made."""
        if planner not in self._attempts:
            places = [(planner, key) for key in self.keys]
            self._attempts[planner] = [(self.runs.get(p), p in self.failures) for p in places]
        return self._attempts[planner]


def counts_of(outcome: NDArray[np.int8]) -> Counts:
    """Return the number of each outcome."""
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
    """Return the name of the crowd draw; the scenario itself without known people."""
    nobody = run.density is None and run.record.agents == "none"
    return f"{run.suite}/{run.scenario}" if nobody else run.realisation_hash


def _condition(key: Key, axes: Mapping[str, str]) -> str:
    """Return the labels on all axes except `DRAW`; the scenario itself if there are none."""
    labels = [f"{axis}={label}" for axis, label in axes.items() if axis != DRAW]
    return "/".join([key[0], *(labels or ([] if DRAW in axes else [key[1]]))])


def _without_run(metric: str) -> _Read:
    """Return outcome, reason and bounds of a score of an attempt without a run."""
    if metric in WITHOUT_RUN:
        return OK, "", (WITHOUT_RUN[metric], WITHOUT_RUN[metric])
    return FAILED, "no_run", (-math.inf, math.inf)


def _read(run: RunRow | None, score: ScoreRow | None) -> _Read:
    """Return outcome, reason and bounds of one score of one run."""
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
