"""Report, leaderboard and ``results`` say the same of the same runs, in every metric."""

from __future__ import annotations

import math
from dataclasses import replace
from html.parser import HTMLParser
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from playwright.sync_api import sync_playwright

from crowdbot.cli.output.results_lines import line_of, with_interval
from crowdbot.core.bundle.leaderboard import write_leaderboard
from crowdbot.core.bundle.standings import standings
from crowdbot.core.registry.registry import discover
from crowdbot.core.report.contents import Contents
from crowdbot.core.report.markdown import markdown
from crowdbot.core.report.page import write_report
from crowdbot.core.results.results import Results
from crowdbot.core.scoring.four_scores import SHOWN
from crowdbot.core.scoring.score_scale import score_scales
from crowdbot.core.statistics.estimate import Estimate
from crowdbot.core.statistics.estimate_text import (
    decimals_for,
    estimate_text,
    joined_text,
    number_text,
)
from crowdbot.core.statistics.groups import by_group
from crowdbot.core.statistics.summary import headline_names
from crowdbot.core.statistics.table import Table
from tests.browser import PROGRAM, Visit, needs_browser
from tests.core.report.report_cases import contents
from tests.core.report.same_numbers import entries, metrics, random_results
from tests.examples import THOROUGH

#: (metric, planner) -> what a page says of it.
_Told = dict[tuple[str, str], str]


class _Cells(HTMLParser):
    """Rows of tables, each cell as the texts in it."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.rows: list[list[list[str]]] = []
        self._open = False
        self.feed(text)

    def handle_starttag(self, tag: str, _: list[tuple[str, str | None]]) -> None:
        if tag == "tr":
            self.rows.append([])
        elif tag in ("td", "th") and self.rows:
            self.rows[-1].append([])
            self._open = True

    def handle_endtag(self, tag: str) -> None:
        self._open = self._open and tag not in ("td", "th")

    def handle_data(self, data: str) -> None:
        if self._open and data.strip():
            self.rows[-1][-1].append(data.strip())


def on_leaderboard(results: Results, folder: Path) -> _Told:
    """Value and interval in the cells of the page, without ranks and notes."""
    scales = score_scales(discover(allow=()))
    tables = standings(entries(results), "success", (), scales=scales)
    write_leaderboard(folder / "board.html", tables, {}, "board")
    rows = _Cells((folder / "board.html").read_text(encoding="utf-8")).rows
    heads = next(row for row in rows if row and row[0] == ["Metric"])
    roles = {score.role: score.metric for score in SHOWN}
    found = {}
    for row in rows[rows.index(heads) + 1 :]:
        for head, cell in zip(heads[1:], row[1:], strict=len(row) > 1):
            ends = [t for t in cell if t.startswith("[")]
            shown = cell[_rank(cell)].removeprefix("· ")
            found[roles.get(row[0][0], row[0][0]), head[0]] = " ".join([shown, *ends])
    return found


def _rank(cell: list[str]) -> int:
    """A rank stands before the value and a dot."""
    return 1 if len(cell) > 1 and cell[1].startswith("·") else 0


def in_report(report: Contents) -> _Told:
    """What the Markdown table says, without counts of what has no value."""
    lines = markdown(report).partition("## Scores")[2].partition("\n## ")[0].splitlines()
    rows = [[c.strip() for c in x.strip("| ").split(" | ")] for x in lines if x.startswith("| ")]
    names = {f"{m} {v}".removesuffix(" corrected"): m for m, v in headlines(report)}
    found = {}
    for row in rows[2:]:
        for planner, cell in zip(report.planners, row[4:], strict=True):
            metric = names[row[0].replace("\\", "")]
            found[metric, planner] = cell.partition(";")[0].replace("\\", "")
    return found


def headlines(report: Contents) -> tuple[tuple[str, str], ...]:
    return headline_names(Table(report.results))


def in_page_data(report: Contents) -> _Told:
    """What `data.js` unpacks, for all runs."""
    places = {s.name: i for i, s in enumerate(report.series)}
    found = {}
    for name in headlines(report):
        for p, planner in enumerate(report.planners):
            value, low, high = report.figures.intervals[0, places[name], p].tolist()
            ends = [None if np.isnan(x) else x for x in (value, low, high)]
            one = Estimate(value=ends[0], low=ends[1], high=ends[2])
            found[name[0], planner] = joined_text(one)
    return found


def in_terminal(results: Results) -> _Told:
    scaled = replace(results, scales=score_scales(discover(allow=())))
    return {
        (s.metric, s.group["planner"]): with_interval(line_of(s))["mean [95 %]"]
        for s in by_group(scaled, "*", ["planner"])
    }


@pytest.mark.slow
@settings(max_examples=40 if THOROUGH else 5)
@given(
    st.integers(0, 2**32), st.integers(1, 3), st.integers(1, 9), st.integers(1, 9),
    st.sampled_from([0.0, 0.2, 0.9]),
)  # fmt: skip
def test_every_page_says_the_same_of_every_metric(
    tmp_path_factory: pytest.TempPathFactory,
    seed: int, planners: int, scenarios: int, draws: int, missing: float,
) -> None:  # fmt: skip
    results = random_results(seed, planners, scenarios, draws, missing)
    report = contents(results)
    values = in_report(report)
    assert {metric for metric, _ in values} <= {m.kind for m in metrics()}
    assert len(values) >= 0.8 * planners * len(metrics())
    board = on_leaderboard(results, tmp_path_factory.mktemp("same"))
    terminal = in_terminal(results)
    assert board == values
    assert in_page_data(report) == values
    assert {k: terminal[k] for k in values} == values


@pytest.mark.slow
def test_intervals_do_not_leave_what_a_score_can_be() -> None:
    results = random_results(7, 2, 9, 9, 0.2)
    report = contents(results)
    scales = score_scales(discover(allow=()))
    for s, series in enumerate(report.series):
        scale = scales[series.name]
        found = report.figures.intervals[:, s]
        known = found[np.isfinite(found)]
        assert known.size == 0 or known.min() >= scale.minimum
        assert known.size == 0 or known.max() <= scale.maximum


@pytest.mark.parametrize(
    ("found", "text"),
    [
        (Estimate(value=0.76234, low=0.61249, high=0.8916), "0.762 [0.612, 0.892]"),
        (Estimate(value=1234.56, low=1100.0, high=1400.0), "1235 [1100, 1400]"),
        (Estimate(value=12.25, low=10.5, high=13.5), "12.3 [10.5, 13.5]"),  # halves away from 0
        (Estimate(value=-0.0001, low=-0.5, high=0.5), "−0.00010 [−0.50, 0.50]"),
        (Estimate(value=10.01234, low=10.0121, high=10.0125), "10.01234 [10.01210, 10.01250]"),
        (Estimate(value=2.5e-8, low=1e-8, high=4e-8), "2.50e−8 [1.00e−8, 4.00e−8]"),
        (Estimate(value=9.9999e7), "1.00e+8"),
        (Estimate(value=0.0, low=0.0, high=0.0), "0 [0, 0]"),
        (Estimate(value=5.0, low=5.0), "5.00"),
        (Estimate(reason="no run has a value"), "–"),
    ],
)  # fmt: skip
def test_an_estimate_as_text(found: Estimate, text: str) -> None:
    assert joined_text(found) == text


@pytest.mark.slow
@needs_browser
def test_the_script_says_it_with_the_same_letters(tmp_path: Path) -> None:
    """The page in a browser: its own rule for numbers, and every row of its table of scores."""
    results = random_results(3, 2, 6, 3, 0.2)
    report = contents(results)
    path = write_report(tmp_path / "report.html", report)["html"]
    rng = np.random.default_rng(1)
    sizes = rng.normal(size=(4000, 3)) * 10.0 ** rng.integers(-12, 9, (4000, 1))
    sizes[::2] = np.round(sizes[::2] * 8.0) / 8.0  # halves
    sizes = np.sort(sizes, axis=1)
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=PROGRAM, args=["--no-sandbox"])
        with Visit(browser, path) as page:
            rule = "([low, centre, high]) => estimateText({ low, centre, high })"
            scripted = page.evaluate(f"(rows) => rows.map({rule})", sizes.tolist())
            rows = page.evaluate(
                "[...document.querySelectorAll('#scores-table tr[data-score]')].map((row) =>"
                " [row.dataset.score, ...[...row.querySelectorAll('td.number')].map((c) =>"
                " `${c.querySelector('b').textContent} ${c.querySelector('small').textContent}`)])"
            )
            page.select_option("#axis-half", "low")
            page.select_option("#axis-part", "first")
            assert page.evaluate("selectionName()") is None
            chosen = page.evaluate(
                "report.series.map((_, s) => report.planners.map((__, p) =>"
                " describe(s, selectedRuns(p)).centre))"
            )
        browser.close()
    for (low, value, high), texts in zip(sizes.tolist(), scripted, strict=True):
        assert tuple(texts) == estimate_text(Estimate(value=value, low=low, high=high))
    values = in_report(report)
    variants = dict(headlines(report))
    seen = {name.partition(".")[0]: cells for name, *cells in rows}
    for p, planner in enumerate(report.planners):
        for metric, cells in seen.items():
            assert cells[p].strip() == values[metric, planner], (metric, variants[metric])
    scaled = replace(results, scales=report.results.scales)
    groups = by_group(scaled, "*", ["half", "part", "planner"])
    low = [s for s in groups if (s.group["half"], s.group["part"]) == ("low", "first")]
    places = {s.name: i for i, s in enumerate(report.series)}
    runs = {r.run_id: r for r in results.runs if r.axes == {"half": "low", "part": "first"}}
    largest: dict[tuple[str, str, str], float] = {}  # of the values that are averaged
    for s in (s for s in results.scores if s.run_id in runs):
        one_mean = s.metric, s.variant, runs[s.run_id].planner
        largest[one_mean] = max(largest.get(one_mean, 0.0), abs(s.value or 0.0))
    for one in low:
        place = places[one.metric, one.variant]
        planner = one.group["planner"]
        p = report.planners.index(planner)
        found, expected = chosen[place][p], math.nan if one.mean.value is None else one.mean.value
        # The page has five digits of each value: where values cancel, fewer of their mean.
        least = 1e-5 * largest.get((one.metric, one.variant, planner), 0.0)
        assert found == pytest.approx(expected, rel=1e-4, abs=least, nan_ok=True), one.metric


@pytest.mark.parametrize("value", [2.75, 0.0, -1.5e-8, 3e7])
def test_numbers_of_numpy_are_written_as_those_of_python(value: float) -> None:
    low, high = value - 0.25, value + 0.25
    from_numpy = Estimate(value=np.float64(value), low=np.float64(low), high=np.float64(high))
    assert estimate_text(from_numpy) == estimate_text(Estimate(value=value, low=low, high=high))


def test_digits_are_those_that_the_interval_is_worth() -> None:
    widths = [1000.0, 10.0, 0.1, 1e-3]
    decimals = [decimals_for([100.0, 100.0 + w]) for w in widths]
    assert all(a <= b for a, b in pairwise(decimals))
    assert number_text(float("nan"), 3) == "–"
    assert number_text(0.0, 9) == "0"
    assert number_text(-1.5, 0, minus="-") == "-2"
