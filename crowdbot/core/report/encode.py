"""Columns for the page: names as numbers, scores as arrays. `data.js` reads them."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from crowdbot.core.report.packing import PackedNumbers, deflate
from crowdbot.core.report.series import Series
from crowdbot.core.results.failure import Failure
from crowdbot.core.results.results import Results
from crowdbot.core.results.rows import WITHOUT_RUN, RunRow
from crowdbot.core.results.score_columns import ScoreColumns
from crowdbot.core.types.ending import ATTEMPTED, Ending, has_failed

#: Code of a score that a run does not have.
ABSENT = 65535
#: State of a score with a value.
OK = ("ok", "")
#: Largest length of a traceback excerpt.
_LINES, _WIDTH = 24, 400

Attempt = RunRow | Failure


class Names:
    """A list of texts with indices in the order of first use."""

    def __init__(self, *first: str) -> None:
        self.places = {name: i for i, name in enumerate(first)}

    def place(self, name: str) -> int:
        """Return the index of a text, adding it if new."""
        return self.places.setdefault(name, len(self.places))

    @property
    def texts(self) -> list[str]:
        """Return all texts, by index."""
        return list(self.places)


def attempts(results: Results) -> list[Attempt]:
    """Return all attempts: runs, and failures that no later successful run replaced."""
    made = {(r.suite, r.scenario, r.planner, r.seed) for r in results.runs}
    failed = [f for f in results.failures if (f.suite, f.scenario, f.planner, f.seed) not in made]
    return [*results.runs, *failed]


def axes_of(results: Results) -> list[dict[str, Any]]:
    """Return the suite's axes in order: ``name``, ``labels``, and readable texts for both.

    ``title`` describes the axis, ``words`` its values. If runs lack these or disagree, the suite's
    names are used.
    """
    found: dict[str, dict[str, set[tuple[str, str]]]] = {}
    tried: list[Attempt] = [*results.runs, *results.failures]
    for one in tried:
        words_of = one.axis_words if isinstance(one, RunRow) else {}
        for name, label in one.axes.items():
            titles = found.setdefault(name, {}).setdefault(label, set())
            if words := words_of.get(name):
                titles.add((words[0], words[1]))
    return [_axis(name, labels) for name, labels in found.items()]


def _axis(name: str, labels: Mapping[str, set[tuple[str, str]]]) -> dict[str, Any]:
    titles = {title for pairs in labels.values() for title, _ in pairs}
    words = [next(iter(pairs))[1] if len(pairs) == 1 else x for x, pairs in labels.items()]
    agreed = len(titles) == 1 and len(set(words)) == len(words)
    return {
        "name": name,
        "labels": list(labels),
        "title": titles.pop() if agreed else name.replace("_", " "),
        "words": words if agreed else list(labels),
    }


def status_of(attempt: Attempt) -> str:
    """Return the outcome of an attempt."""
    return attempt.status if isinstance(attempt, RunRow) else Ending.NO_RUN


def encode_runs(
    tried: Sequence[Attempt],
    planners: Sequence[str],
    axes: Sequence[Mapping[str, Any]],
    replays: Mapping[str, str],
) -> dict[str, Any]:
    """Return columns of runs; ``replays``: run id -> address of its replay page."""
    scenarios, statuses = Names(), Names(*ATTEMPTED)
    reasons = Names("")
    labels = [a.axes for a in tried]
    runs = [a if isinstance(a, RunRow) else None for a in tried]
    columns = {
        "count": len(tried),
        "planner": [planners.index(a.planner) for a in tried],
        "scenario": [scenarios.place(a.scenario) for a in tried],
        "seed": [a.seed for a in tried],
        "status": [statuses.place(status_of(a)) for a in tried],
        "reason": [reasons.place(_reason(a)) for a in tried],
        "axes": [
            [_index(axis["labels"], one.get(axis["name"])) for one in labels] for axis in axes
        ],
        "time": [None if r is None else round(r.sim_time, 3) for r in runs],
        "density": [None if r is None else r.density for r in runs],
        "replay": [None if r is None else replays.get(r.run_id) for r in runs],
        "moment": [None if r is None else r.moment for r in runs],
        "traceback": {
            i: _excerpt(a.traceback) for i, a in enumerate(tried) if isinstance(a, Failure)
        },
    }
    names = {"scenarios": scenarios.texts, "statuses": statuses.texts, "reasons": reasons.texts}
    endings = {ending: {"past": ending.past, "failed": ending.failed} for ending in ATTEMPTED}
    return {"runs": columns, **names, "endings": endings}


def _excerpt(traceback: str) -> str:
    """Return the end of a traceback, which shows the error.

    A deep recursion would fill the page.
    """
    lines = traceback.splitlines()
    cut = [f"… {len(lines) - _LINES} lines …"] if len(lines) > _LINES else []
    return "\n".join(line[:_WIDTH] for line in [*cut, *lines[-_LINES:]])


def _index(labels: Sequence[str], label: str | None) -> int:
    return -1 if label is None else labels.index(label)


def _reason(attempt: Attempt) -> str:
    return attempt.reason if isinstance(attempt, RunRow) else attempt.error


def encode_scores(
    results: Results, tried: Sequence[Attempt], series: Sequence[Series]
) -> tuple[list[tuple[str, str]], dict[str, str]]:
    """Return states by code, and blobs of (series, run): values, bounds and codes.

    A run whose planner failed shows its existing values; the others are ``failed``.
    """
    scores = ScoreColumns.of(results.scores)
    place_of = {name: i for i, name in enumerate(scores.run_ids)}
    ids = ["" if isinstance(a, Failure) else a.run_id for a in tried]
    columns = np.array([place_of.get(name, -1) for name in ids], np.intp)
    shape = (len(series), len(tried))
    blobs = {name: PackedNumbers(len(series) * len(tried)) for name in ("values", "lower", "upper")}
    codes = np.full(shape, ABSENT, np.uint16)
    states: dict[tuple[str, str], int] = {OK: 0}
    failed = {
        r: states.setdefault(("failed", status_of(a)), len(states))
        for r, a in enumerate(tried)
        if isinstance(a, Failure) or has_failed(a.status)
    }
    known = [states.setdefault((s.status, s.reason), len(states)) for s in scores.states]
    is_ok = np.array([s.status == "ok" for s in scores.states], np.bool_)
    for s, one in enumerate(series):
        of_run = np.full(len(place_of) + 1, -1, np.intp)
        if (rows := scores.by_name.get(one.name)) is not None:
            of_run[scores.run[rows]] = rows
        place = of_run[columns]
        here = np.flatnonzero(place >= 0)
        state = scores.state[place[here]]
        codes[s, here] = np.asarray(known, np.uint16)[state]
        values, lower, upper = numbers = np.full((3, len(tried)), np.nan)
        for row, column in zip(numbers, (scores.value, scores.lower, scores.upper), strict=True):
            row[here] = column[place[here]]
        shown = np.zeros(len(tried), np.bool_)
        shown[here] = is_ok[state]
        for r, code in failed.items():
            value = WITHOUT_RUN.get(one.metric) if isinstance(tried[r], Failure) else None
            if not shown[r]:
                codes[s, r] = code if value is None else 0
                values[r], lower[r], upper[r] = _number(value), np.nan, np.nan
        for blob, row in zip(blobs.values(), numbers, strict=True):
            blob.put(s * len(tried), row)
    return list(states), {
        **{name: blob.text() for name, blob in blobs.items()},
        "codes": deflate(codes.astype("<u2").tobytes()),
    }


def _number(value: float | None) -> float:
    return math.nan if value is None else value
