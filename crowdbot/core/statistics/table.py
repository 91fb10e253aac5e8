"""Results as a paired table: scenario and seed in rows, planners in columns."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.results.failure import Failure
from crowdbot.core.results.results import Results
from crowdbot.core.results.rows import WITHOUT_RUN, RunRow, ScoreRow
from crowdbot.core.results.score_columns import ColumnState, IndexByValue, ScoreColumns, different
from crowdbot.core.scoring.score_scale import UNKNOWN, ScoreScale
from crowdbot.core.statistics.clusters import Clusters, Floats
from crowdbot.core.statistics.estimate import OUTCOMES, Counts
from crowdbot.core.types.ending import Ending, has_failed
from crowdbot.dsl.suite.matrix import DRAW

#: Suite, scenario, seed: the key for pairing runs.
Key = tuple[str, str, int]
#: Metric and variant.
Name = tuple[str, str]

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
        unscored: (n,) True if a run was not scored in this, or its score was not kept: it is
            undefined for that reason.
        reasons: why values are missing -> how often.
    """

    outcome: NDArray[np.int8]
    low: Floats
    high: Floats
    failed: NDArray[np.bool_]
    unscored: NDArray[np.bool_]
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
        self.runs = {(r.planner, key_of(r)): r for r in results.runs}
        made = {(f.planner, (f.suite, f.scenario, f.seed)): f.error for f in results.failures}
        self.failures = {place: why for place, why in made.items() if place not in self.runs}
        places = [*self.runs, *self.failures]
        self.keys: tuple[Key, ...] = tuple(dict.fromkeys(key for _, key in places))
        self.planners = tuple(sorted({planner for planner, _ in places}))
        self.scales = results.scales
        self._scores = ScoreColumns.of(results.scores)
        self._columns: dict[tuple[Name, str], Column] = {}
        self._attempts: dict[str, _Attempts] = {}
        self._labels: dict[str, AxisLabels] = {}
        self._lacking: dict[str, NDArray[np.bool_]] = {}
        self._place_of = {name: i for i, name in enumerate(self._scores.run_ids)}

    @cached_property
    def names(self) -> tuple[Name, ...]:
        """Return the names of all scores, sorted."""
        return tuple(sorted(self._scores.by_name))

    def label(self, name: Name) -> ScoreRow:
        """Return a row with unit, category and direction of a score."""
        return self._scores[int(self._scores.by_name[name][0])]

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

    def labels_on(self, axis: str) -> tuple[str, ...]:
        """Return the label of each row on one axis; empty where its suite has no such axis."""
        found = {key[:2]: run.axes[axis] for (_, key), run in self.runs.items() if axis in run.axes}
        return tuple(found.get(key[:2], "") for key in self.keys)

    @cached_property
    def places(self) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
        """Return indices of each row's condition, and of its draw in that condition, (n,) each."""
        inside = [f"{c}\0{d}" for c, d in zip(self.conditions, self.draws, strict=True)]
        found = [np.unique(names, return_inverse=True)[1] for names in (self.conditions, inside)]
        return found[0].astype(np.intp), found[1].astype(np.intp)

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
        return over if over[1] and over in self._scores.by_name else None

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
        """Return a mask (n,) of rows that a planner should have run but has not.

        These are all scenarios of a suite with the run seeds that it has in any of them. Floor and
        ceiling planners are yardsticks: they run in part of a suite, and lack nothing.
        """
        if planner not in self._lacking:
            self._lacking[planner] = self._find_lacking(planner)
        return self._lacking[planner]

    def _find_lacking(self, planner: str) -> NDArray[np.bool_]:
        attempts = self._tried(planner)
        tried = attempts.run | attempts.lost
        if attempts.roles & {"floor", "ceiling"}:
            return np.zeros_like(tried)
        seeds = {key[::2] for key, here in zip(self.keys, tried, strict=True) if here}
        return ~tried & np.array([key[::2] in seeds for key in self.keys], np.bool_)

    def arrived(self, planner: str) -> NDArray[np.bool_]:
        """Return a mask (n,) of rows in which a planner's robot arrived."""
        return self._tried(planner).arrived

    def axis_labels(self, planner: str) -> AxisLabels:
        """Return the labels of one planner's runs on all axes."""
        if planner not in self._labels:
            self._labels[planner] = AxisLabels.of([self.runs.get((planner, k)) for k in self.keys])
        return self._labels[planner]

    def column(self, name: Name, planner: str) -> Column:
        """Return one score of one planner."""
        if (name, planner) not in self._columns:
            self._columns[name, planner] = self._column(name, planner)
        return self._columns[name, planner]

    def _column(self, name: Name, planner: str) -> Column:
        tried, scores = self._tried(planner), self._scores
        place = self._places(name, tried)
        scored = place >= 0
        state = np.where(scored, scores.state[place], -1) if len(scores) else place
        value, lower, upper = (
            np.where(scored, numbers[place], np.nan) if len(scores) else np.full(len(place), np.nan)
            for numbers in (scores.value, scores.lower, scores.upper)
        )
        kinds = np.array([*map(_kind, scores.states), UNDEFINED], np.int8)[state]
        outcome = np.where(tried.run, kinds, MISSING).astype(np.int8)
        outcome[tried.run & tried.failed & (kinds != OK)] = FAILED
        infinite = (outcome == OK) & ~np.isfinite(value)
        outcome[infinite] = UNDEFINED
        low, high = np.full(len(outcome), -math.inf), np.full(len(outcome), math.inf)
        for ends, bounds in ((low, lower), (high, upper)):
            ends[outcome == OK] = value[outcome == OK]
            bounded = (outcome == CENSORED) & ~np.isnan(bounds)
            ends[bounded] = bounds[bounded]
        reasons = Counter({"not_finite": int(infinite.sum())})
        reasons.update(tried.status[i] for i in np.flatnonzero(outcome == FAILED).tolist())
        unknown = ((outcome == UNDEFINED) | (outcome == CENSORED)) & ~infinite
        for number, times in enumerate(np.bincount(state[unknown] + 1).tolist(), -1):
            reasons[_reason(scores.states[number]) if number >= 0 else "not_scored"] += times
        if tried.lost.any():
            kind, reason, (low[tried.lost], high[tried.lost]) = _without_run(name[0])
            outcome[tried.lost] = kind
            reasons[reason] += int(tried.lost.sum())
        counted = {why: n for why, n in sorted(reasons.items()) if why and n}
        unscored = (outcome == UNDEFINED) & ~scored
        return Column(outcome, low, high, tried.failed.copy(), unscored, counted)

    def _places(self, name: Name, tried: _Attempts) -> NDArray[np.intp]:
        """Return the place of a score in each row among all scores, (n,); -1 without it."""
        of_run = np.full(len(self._place_of) + 1, -1, np.intp)
        rows = self._scores.by_name.get(name)
        if rows is not None:
            of_run[self._scores.run[rows]] = rows
        return of_run[tried.place]

    def _tried(self, planner: str) -> _Attempts:
        if planner not in self._attempts:
            places = [(planner, key) for key in self.keys]
            runs = [self.runs.get(place) for place in places]
            lost = np.array([place in self.failures for place in places], np.bool_)
            self._attempts[planner] = _Attempts.of(runs, lost, self._place_of)
        return self._attempts[planner]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class AxisLabels:
    """Labels of the r runs of a planner.

    Attributes:
        rows: (r,) their rows in the table.
        axes: axis -> its labels in order of appearance, and (r,) the place of each run's.
        density: (r,) realised density, 1/m²; NaN without people.
    """

    rows: NDArray[np.intp]
    axes: Mapping[str, tuple[tuple[str, ...], NDArray[np.intp]]]
    density: Floats

    @staticmethod
    def of(runs: Sequence[RunRow | None]) -> AxisLabels:
        """Collect labels from the runs of all rows, None where there is none."""
        there = [(i, run) for i, run in enumerate(runs) if run is not None]
        axes = {}
        named, which = different([run.axes for _, run in there])
        for axis in dict.fromkeys(a for labels in named for a in labels):
            order = IndexByValue[str]()
            index = [order.place(labels.get(axis, "")) for labels in named]
            axes[axis] = tuple(order), np.array(index, np.intp)[which]
        density = [math.nan if run.density is None else run.density for _, run in there]
        rows = np.array([i for i, _ in there], np.intp)
        return AxisLabels(rows=rows, axes=axes, density=np.array(density, np.float64))


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class _Attempts:
    """A planner's attempts to run each row.

    Attributes:
        run: (n,) True if there is a run; ``lost``: if it could not be made.
        failed: (n,) True if it was lost, or the planner failed; ``arrived``: if the robot arrived.
        place: (n,) place of the run among those with scores; -1 without.
        status: status of each run, empty without.
        roles: roles of the runs.
    """

    run: NDArray[np.bool_]
    lost: NDArray[np.bool_]
    failed: NDArray[np.bool_]
    arrived: NDArray[np.bool_]
    place: NDArray[np.intp]
    status: Sequence[str]
    roles: frozenset[str]

    @staticmethod
    def of(
        runs: Sequence[RunRow | None], lost: NDArray[np.bool_], place_of: Mapping[str, int]
    ) -> _Attempts:
        status = ["" if run is None else run.status for run in runs]
        bad = {word for word in set(status) if word and has_failed(word)}
        places = [-1 if run is None else place_of.get(run.run_id, -1) for run in runs]
        return _Attempts(
            run=np.array([run is not None for run in runs], np.bool_),
            lost=lost,
            failed=lost | np.array([word in bad for word in status], np.bool_),
            arrived=np.array([word == Ending.ARRIVED for word in status], np.bool_),
            place=np.array(places, np.intp),
            status=status,
            roles=frozenset(run.role for run in runs if run is not None),
        )


def counts_of(outcome: NDArray[np.int8]) -> Counts:
    """Return the number of each outcome."""
    found = np.bincount(outcome, minlength=len(OUTCOMES))
    return Counts(**dict(zip(OUTCOMES, map(int, found), strict=True)))


def key_of(run: RunRow | Failure) -> Key:
    """Return what runs of several planners share: suite, scenario and seed."""
    return run.suite, run.scenario, run.seed


def _draw(run: RunRow) -> str:
    """Return the name of the crowd draw; the scenario itself without known people."""
    without_people = run.density is None and run.agents == "none"
    return f"{run.suite}/{run.scenario}" if without_people else run.realisation_hash


def _condition(key: Key, axes: Mapping[str, str]) -> str:
    """Return the labels on all axes except `DRAW`; the scenario itself if there are none."""
    labels = [f"{axis}={label}" for axis, label in axes.items() if axis != DRAW]
    return "/".join([key[0], *(labels or ([] if DRAW in axes else [key[1]]))])


def _without_run(metric: str) -> tuple[int, str, tuple[float, float]]:
    """Return outcome, reason and bounds of a score of an attempt without a run."""
    if metric in WITHOUT_RUN:
        return OK, "", (WITHOUT_RUN[metric], WITHOUT_RUN[metric])
    return FAILED, "no_run", (-math.inf, math.inf)


def _kind(state: ColumnState) -> int:
    return {"ok": OK, "censored": CENSORED}.get(state.status, UNDEFINED)


def _reason(state: ColumnState) -> str:
    return state.reason or ("" if state.status == "censored" else "no_value")
