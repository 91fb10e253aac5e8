"""The report's CSV is joined from parts; it says what a plain writer says, row by row."""

from __future__ import annotations

import csv
import io
from dataclasses import replace

from crowdbot.core.report.contents import Contents
from crowdbot.core.report.tables import csv_parts
from crowdbot.core.results.results import Results
from crowdbot.core.results.rows import RunRow
from tests.core.report.report_cases import campaign, contents

METRICS = ("success", "relative_time_to_goal", "effect_on_time")


def _varied() -> Results:
    """Bounds, a run without scores, runs that lack some, and texts that need quotes."""
    found = campaign({"dwa": 0.0, "stop": -2.0}, {"flow": ("in", "out")}, 12, METRICS, failures=1)
    ids = [run.run_id for run in found.runs]
    kept = [s for i, s in enumerate(found.scores) if s.run_id != ids[3] and i % 7]
    kept[5] = replace(kept[5], value=None, status="undefined", reason='two\nlines, "é"')
    return replace(found, scores=tuple(kept))


def _plain_rows(report: Contents) -> list[list[str]]:
    rows = []
    for attempt in report.attempts:
        own = [s for s in report.results.scores
               if isinstance(attempt, RunRow) and s.run_id == attempt.run_id]  # fmt: skip
        for s in own:
            numbers = ["" if x is None else repr(x) for x in (s.value, s.lower, s.upper)]
            rows.append(
                [s.category, s.metric, s.symbol, s.variant, numbers[0], s.unit, s.better,
                 s.status, s.reason, *numbers[1:]]
            )  # fmt: skip
        if not own:
            reason = "not_scored" if isinstance(attempt, RunRow) else attempt.error
            status = attempt.status if isinstance(attempt, RunRow) else "failed"
            rows.append([*[""] * 7, status, reason, "", ""])
    return rows


def test_lines_are_those_of_a_plain_writer() -> None:
    report = contents(_varied())
    text = b"".join(csv_parts(report)).decode()
    names, *rows = csv.reader(io.StringIO(text, newline=""))
    assert [row[names.index("category") :] for row in rows] == _plain_rows(report)
    assert sum(bool(row[-1] or row[-2]) for row in rows) > 10
    tried = {(a.scenario, a.planner, str(a.seed)) for a in report.attempts}
    assert {(row[1], row[2], row[3]) for row in rows} == tried
    assert all(row[names.index("axis.flow")] == row[1] for row in rows)
    again = io.StringIO(newline="")
    csv.writer(again).writerows([names, *rows])
    assert again.getvalue() == text


def test_runs_without_any_score_have_a_line_each() -> None:
    report = contents(_varied())
    bare = replace(report, results=replace(report.results, scores=()))
    _, *rows = csv.reader(io.StringIO(b"".join(csv_parts(bare)).decode(), newline=""))
    assert [row[-3] for row in rows[:-1]] == ["not_scored"] * len(report.results.runs)
