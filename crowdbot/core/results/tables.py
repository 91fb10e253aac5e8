"""Results as tables: one line per score or run, for CSV, Parquet and queries."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

from crowdbot.core.results.rows import RUN_COLUMNS, RunRow, ScoreRow
from crowdbot.core.scoring.scores_csv import write_table
from crowdbot.errors import InputError, MissingLibraryError

Line = dict[str, Any]
_SCORE = (
    "category", "metric", "symbol", "variant", "value", "unit", "better", "status", "reason",
    "lower", "upper",
)  # fmt: skip

_NUMBERS = {"value", "lower", "upper"} | {n for n, kind in RUN_COLUMNS.items() if kind == "REAL"}
_NULL = "\\N"


def axes_of(runs: Iterable[RunRow]) -> list[str]:
    """Return the names of all axes, in the order of the suites."""
    return list(dict.fromkeys(name for run in runs for name in run.axes))


def run_lines(runs: Sequence[RunRow]) -> list[Line]:
    """Return one line per run; its label on axis ``x`` is in ``axis_x``."""
    axes = axes_of(runs)
    return [
        {
            **{n: getattr(run, n) for n in RUN_COLUMNS},
            **{f"axis_{a}": run.axes.get(a) for a in axes},
        }
        for run in runs
    ]


def score_lines(runs: Sequence[RunRow], scores: Iterable[ScoreRow]) -> list[Line]:
    """Return one line per score, with the columns that identify its run."""
    axes, by_id = axes_of(runs), {run.run_id: run for run in runs}
    lines = []
    for score in scores:
        run = by_id[score.run_id]
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
    """Write scores or runs as CSV (RFC 4180, UTF-8); missing values are empty cells.

    Raises:
        InputError: there is nothing to write, or it cannot be written there.
    """
    names = _names(lines)
    cells = ([_cell(line[name]) for name in names] for line in lines)
    write_table(path, [names, *cells])


def write_parquet(path: Path, lines: Sequence[Line]) -> None:
    """Write scores or runs with types as Parquet, through DuckDB.

    Raises:
        MissingLibraryError: ``duckdb`` is not installed.
        InputError: there is nothing to write, or it cannot be written there.
    """
    try:
        import duckdb
    except ImportError as error:
        text = "Parquet needs DuckDB; install it with pip install 'crowdbot[analysis]'"
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
