"""Results: all rows of a campaign, read from its folder, and pandas and Arrow tables."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

from crowdbot.core.results.failure import Failure
from crowdbot.core.results.rows import DamagedRun, RunRow, ScoreRow
from crowdbot.core.results.score_columns import of_runs
from crowdbot.core.results.tables import run_lines, score_lines
from crowdbot.core.scoring.score_scale import Scales
from crowdbot.core.support.arguments import path_of
from crowdbot.core.support.data_frame import to_arrow, to_pandas
from crowdbot.dsl.suite.suite_entry import altered_digest
from crowdbot.errors import InputError

if TYPE_CHECKING:
    import pandas as pd  # type: ignore[import-untyped]
    import pyarrow as pa  # type: ignore[import-untyped]

Table = Literal["scores", "runs"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Results:
    """All runs, scores and failures, as they were when the folder was read.

    Runs are sorted by suite, scenario in the suite's order, planner and seed; scores by run, metric
    and variant. ``scales`` are those of the installed metrics, from
    `crowdbot.core.scoring.score_scale.score_scales`; they bound the intervals. ``damaged`` runs are
    listed separately.
    """

    runs: tuple[RunRow, ...] = ()
    damaged: tuple[DamagedRun, ...] = ()
    scores: Sequence[ScoreRow] = ()
    failures: tuple[Failure, ...] = ()
    scales: Scales = field(default_factory=dict, repr=False)

    @classmethod
    def open(cls, root: str | Path = "runs") -> Results:
        """Read all runs, scores and failures below a folder.

        Nothing is written but the index, if many runs are new to it. A damaged run is left out,
        with a warning.

        Args:
            root: root of the run directories.

        Raises:
            InputError: there is no such folder.
        """
        from crowdbot.core.results.store import read_rows  # statistics need no database

        return cls(**read_rows(path_of("root", root))._asdict())

    @property
    def marks(self) -> frozenset[str]:
        """Labels of the planners that are floors or ceilings."""
        return frozenset(run.planner for run in self.runs if run.role in ("floor", "ceiling"))

    @property
    def suites(self) -> tuple[str, ...]:
        """Names of all suites, in order; each change to a scenario makes a suite of its own."""
        runs, failures = (one.suite for one in self.runs), (one.suite for one in self.failures)
        return tuple(dict.fromkeys([*runs, *failures]))

    def without_altered(self) -> Results:
        """Return the results without runs and failures of scenarios that ``--set`` changed."""
        runs = tuple(run for run in self.runs if not run.changes)
        ids = {run.run_id for run in runs}
        return replace(
            self,
            runs=runs,
            scores=of_runs(self.scores, ids),
            failures=tuple(f for f in self.failures if not altered_digest(f.scenario)),
        )

    def to_pandas(self, table: Table = "scores") -> pd.DataFrame:
        """Return one row per score, with suite, scenario, planner, seed and axes of its run.

        Args:
            table: ``scores``, or ``runs`` for one row per run.

        Raises:
            InputError: pandas is not installed, or there is no such table.
        """
        return to_pandas(*self._lines(table))

    def to_arrow(self, table: Table = "scores") -> pa.Table:
        """Return scores or runs as an Arrow table.

        Args:
            table: ``scores`` or ``runs``.

        Raises:
            InputError: pyarrow is not installed, or there is no such table.
        """
        return to_arrow(*self._lines(table))

    def _lines(self, table: str) -> tuple[list[dict[str, Any]], list[str]]:
        """Return rows and column names of a table."""
        if table not in ("scores", "runs"):
            raise InputError(f"there is no table {table!r}; there are 'scores' and 'runs'")
        lines = score_lines(self.runs, self.scores) if table == "scores" else run_lines(self.runs)
        return lines, list(lines[0]) if lines else ["scenario", "planner", "seed"]
