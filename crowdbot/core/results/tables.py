"""Results as tables: one line a score or a run, for CSV, Parquet and questions."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from fnmatch import fnmatchcase
from pathlib import Path
from statistics import fmean, median
from typing import Any, Literal

from crowdbot.core.results.rows import (
    PLANNER_FAILED,
    WITHOUT_RUN,
    FailureRow,
    Results,
    RunRow,
    ScoreRow,
)
from crowdbot.core.scoring.scores_csv import write_table
from crowdbot.errors import InputError, MissingLibraryError, UnknownNameError

Line = dict[str, Any]
_Place = tuple[str, str, str]
_RUN = (
    "suite", "scenario", "planner", "seed", "status", "reason", "goal_time", "sim_time",
    "wall_time", "density", "privileged", "pinned", "planner_process", "spec_hash",
    "realisation_hash", "trajectory_hash", "run_id", "directory",
)  # fmt: skip
_SCORE = (
    "category", "metric", "symbol", "variant", "value", "unit", "better", "status", "reason",
    "lower", "upper",
)  # fmt: skip

_NUMBERS = ("goal_time", "sim_time", "wall_time", "density", "value", "lower", "upper")
_NULL = "\\N"


def axes_of(results: Results) -> list[str]:
    """Names of all axes, in the order of the suites."""
    return list(dict.fromkeys(name for run in results.runs for name in run.axes))


def run_lines(results: Results) -> list[Line]:
    """One line a run; its label on axis ``x`` is in ``axis_x``."""
    axes = axes_of(results)
    return [
        {**{n: getattr(run, n) for n in _RUN}, **{f"axis_{a}": run.axes.get(a) for a in axes}}
        for run in results.runs
    ]


def score_lines(results: Results) -> list[Line]:
    """One line a score, with what tells its run."""
    axes, runs = axes_of(results), {run.run_id: run for run in results.runs}
    lines = []
    for score in results.scores:
        run = runs[score.run_id]
        lines.append(
            {
                **{n: getattr(run, n) for n in ("suite", "scenario", "planner", "seed")},
                **{f"axis_{a}": run.axes.get(a) for a in axes},
                "run_status": run.status,
                "planner_process": run.planner_process,
                **{n: getattr(score, n) for n in _SCORE},
                "run_id": run.run_id,
            }
        )
    return lines


def write_csv(path: Path, lines: Sequence[Line]) -> None:
    """RFC 4180, UTF-8; empty cells for what is not there.

    Raises:
        InputError: there is nothing to write, or it cannot be written there.
    """
    names = _names(lines)
    cells = ([_cell(line[name]) for name in names] for line in lines)
    write_table(path, [names, *cells])


def write_parquet(path: Path, lines: Sequence[Line]) -> None:
    """The same with types, through DuckDB.

    Raises:
        MissingLibraryError: ``duckdb`` is not installed.
        InputError: there is nothing to write, or it cannot be written there.
    """
    try:
        import duckdb
    except ImportError as error:
        text = "Parquet needs DuckDB; install it with 'pip install crowdbot[analysis]'"
        raise MissingLibraryError(text) from error
    names = _names(lines)
    columns = {name: _type(name, (line[name] for line in lines)) for name in names}
    part, plain = (path.with_name(f".{path.name}.{kind}") for kind in ("part", "csv"))
    try:
        cells = ([_NULL if line[n] is None else _cell(line[n]) for n in names] for line in lines)
        write_table(plain, [names, *cells])
        duckdb.from_csv_auto(
            str(plain), header=True, dtype=columns, na_values=_NULL, delimiter=","
        ).write_parquet(str(part), compression="zstd")
        part.replace(path)
    except (duckdb.IOException, OSError) as error:
        raise InputError(f"{path}: cannot be written: {error}") from error
    finally:
        for file in (part, plain):
            file.unlink(missing_ok=True)


@dataclass(frozen=True, slots=True, kw_only=True)
class GroupSummary:
    """Scores of one metric and variant in one group of runs.

    ``mean`` and ``median`` are those of the ``count`` scores that have a value, and ``mean`` of a
    rate that of all these runs together, where the results have scales; ``undefined`` and
    ``censored`` are how many have none. ``low`` and ``high`` bound the mean of all scores, if those
    without a value are anywhere within their bounds; None where there is no bound. ``failed``
    counts the runs whose planner failed, which are among the others, and the attempts that left no
    run, which are not successes.
    """

    group: Mapping[str, str]
    metric: str
    variant: str
    unit: str
    better: str
    count: int
    undefined: int
    censored: int
    failed: int
    mean: float | None
    low: float | None
    high: float | None
    median: float | None


def summarise(
    results: Results, metric: str, by: Sequence[str], variant: str | None = None
) -> list[GroupSummary]:
    """Scores by groups of runs.

    Args:
        results: what to look at.
        metric: pattern of names.
        by: axes, or ``planner``, ``suite``, ``scenario``, ``seed``, ``status``.
        variant: None takes ``rate`` where a metric has that, else ``corrected``, else its first.

    Raises:
        UnknownNameError: no such axis or metric.
    """
    _check_names(results, metric, by)
    runs = {run.run_id: tuple(_label(run, name) for name in by) for run in results.runs}
    lost = [tuple(_label(f, name) for name in by) for f in results.failures]
    failed = Counter([*lost, *(runs[r.run_id] for r in results.runs if r.status == PLANNER_FAILED)])
    found: dict[str, dict[tuple[str, ...], list[ScoreRow]]] = {}
    over = _exposures(results)
    usual = _usual_variants(results)
    for score in results.scores:
        if fnmatchcase(score.metric, metric) and score.variant == (variant or usual[score.metric]):
            groups = found.setdefault(score.metric, {})
            groups.setdefault(runs[score.run_id], []).append(score)
    for name, groups in found.items():
        first = next(iter(groups.values()))[0]
        nothing = replace(first, value=WITHOUT_RUN.get(name), status="", reason="")
        for group in lost:
            groups.setdefault(group, []).append(nothing)
    return [
        _summary(dict(zip(by, group, strict=True)), scores, failed[group], over)
        for groups in found.values()
        for group, scores in groups.items()
    ]


def _usual_variants(results: Results) -> dict[str, str]:
    found: dict[str, dict[str, None]] = {}
    for score in results.scores:
        found.setdefault(score.metric, {})[score.variant] = None
    liked = ("rate", "corrected")
    return {
        m: next((v for v in liked if v in names), next(iter(names))) for m, names in found.items()
    }


def _exposures(results: Results) -> dict[_Place, float]:
    """Run, metric and variant of each rate -> what it is over."""
    rates = {name: scale.rate_over for name, scale in results.scales.items() if scale.rate_over}
    values = {(s.run_id, s.metric, s.variant): s.value for s in results.scores}
    found = ((s, values.get((s.run_id, s.metric, rates.get((s.metric, s.variant), "")))) for s in
             results.scores)  # fmt: skip
    return {(s.run_id, s.metric, s.variant): value for s, value in found if value}


def _summary(
    group: Mapping[str, str],
    scores: Sequence[ScoreRow],
    failed: int,
    over: Mapping[_Place, float],
) -> GroupSummary:
    values = [s.value for s in scores if s.value is not None]
    first = scores[0]
    ways = [over.get((s.run_id, s.metric, s.variant)) for s in scores if s.value is not None]
    low, high = _bound(scores, "lower"), _bound(scores, "upper")
    mean = fmean(values) if values else None
    if values and None not in ways:  # a rate: all that was counted over all of the way
        mean = fmean(values, weights=[way or 0.0 for way in ways])
        low, high = (None if end is None else mean for end in (low, high))
    return GroupSummary(
        group=group,
        metric=first.metric,
        variant=first.variant,
        unit=first.unit,
        better=first.better,
        count=len(values),
        undefined=sum(s.status == "undefined" for s in scores),
        censored=sum(s.status == "censored" for s in scores),
        failed=failed,
        mean=mean,
        low=low,
        high=high,
        median=median(values) if values else None,
    )


def _bound(scores: Sequence[ScoreRow], side: Literal["lower", "upper"]) -> float | None:
    """Of the mean of all scores, those without a value at this end of what is possible."""
    ends = [getattr(s, side) if s.value is None else s.value for s in scores]
    return None if None in ends else fmean(ends)


def _label(run: RunRow | FailureRow, name: str) -> str:
    if name == "status" and isinstance(run, FailureRow):
        return "failed"
    return run.axes[name] if name in run.axes else str(getattr(run, name, ""))


def _check_names(results: Results, metric: str, by: Sequence[str]) -> None:
    known = [*axes_of(results), "planner", "suite", "scenario", "seed", "status"]
    for name in by:
        if name not in known:
            raise UnknownNameError("axis", name, known)
    metrics = {s.metric for s in results.scores}
    if results.scores and not any(fnmatchcase(m, metric) for m in metrics):
        raise UnknownNameError("metric", metric, metrics)


def _names(lines: Sequence[Line]) -> list[str]:
    if not lines:
        raise InputError("there are no complete runs yet")
    return list(lines[0])


def _cell(value: Any) -> str:
    if value is None:
        return ""
    return repr(value) if isinstance(value, float) else str(value)


def _type(name: str, values: Iterable[Any]) -> str:
    if name in _NUMBERS:
        return "DOUBLE"
    kinds = {type(v) for v in values if v is not None}
    if kinds == {bool}:
        return "BOOLEAN"
    if kinds and kinds <= {int}:
        return "BIGINT"
    return "VARCHAR"
