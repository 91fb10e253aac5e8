"""A report for a paper: LaTeX tables, a figure, and captions that state what numbers rest on."""

from __future__ import annotations

import re

from crowdbot.core.report.contents import Contents
from crowdbot.core.report.paper import escaped, pictures, tex
from crowdbot.core.scoring.four_scores import MAIN_SCORES
from tests.core.report.report_cases import AXES, DRAWN, campaign, contents
from tests.core.report.test_page import METRICS

PLANNERS = {"dwa": 0.0, "my_50%_{plan}": -3.0}


def two_planners() -> Contents:
    axes = {name: AXES[name] for name in DRAWN}
    return contents(campaign(PLANNERS, axes=axes, metrics=METRICS, failures=0))


def test_tables_have_a_row_for_each_planner_and_columns_that_fit() -> None:
    text = tex(two_planners(), "report.pdf")
    for table in re.findall(r"\\begin\{tabular\}.*?\\end\{tabular\}", text, re.DOTALL):
        columns = re.match(r"\\begin\{tabular\}\{(\w+)\}", table)
        assert columns is not None
        rows = [line for line in table.splitlines() if line.endswith("\\tabularnewline")]
        assert len(rows) >= 2
        for row in rows:
            assert len(re.findall(r"(?<!\\)&", row)) == len(columns[1]) - 1
    scores = text.partition("\\end{table}")[0]
    assert "dwa & 18 & " in scores
    assert r"my\_50\%\_\{plan\} & 18 & " in scores
    assert "\\includegraphics[width=\\linewidth]{report.pdf}" in text


def test_pairs_of_references_are_left_out_and_few_rows_remain() -> None:
    few = {
        "axes": {"density": ("d1", "d2")},
        "metrics": [s.metric for s in MAIN_SCORES],
        "failures": 0,
    }
    skill = {f"p{i}": i / 10.0 for i in range(8)}
    results = campaign(skill, **few)  # type: ignore[arg-type]
    known = tuple(skill)[1:]
    pairs = []
    for references in ((), known):
        text = tex(contents(results, references=references), "x.pdf")
        table = text.partition("tab:comparisons")[2].partition("\\bottomrule")[0]
        rows = [row.split(" & ")[:3] for row in table.splitlines() if row.endswith("line")]
        pairs.append([row for row in rows if row[0] != "score"])
        assert ("Only safe efficiency is shown." in text) == (not references)
    assert len(pairs[0]) == 28
    assert {score for score, _, _ in pairs[0]} == {"safe efficiency"}
    assert {name for _, *both in pairs[1] for name in both} == set(skill)
    assert all("p0" in both for _, *both in pairs[1])


def test_wide_tables_shrink_to_the_text() -> None:
    text = tex(two_planners(), "report.pdf")
    boxes = re.findall(r"\\resizebox\{\\ifdim\\width>\\linewidth.*?\\end\{tabular\}\}", text, re.S)
    assert len(boxes) == text.count("\\begin{tabular}") == 2
    assert all(box.count("{") == box.count("}") for box in boxes)


def test_captions_state_runs_draws_and_intervals() -> None:
    captions = re.findall(r"\\caption\{(.*)\}", tex(two_planners(), "report.pdf"))
    assert len(captions) == 3
    assert "Runs: dwa 18, " in captions[0]
    assert "over 18 crowd draws" in captions[0]
    assert "95 \\% intervals" in captions[0]
    assert "corrected for " in captions[1]


def test_what_latex_reads_as_commands_is_printed() -> None:
    assert escaped(r"a_b & 50 % \x {#$}") == (r"a\_b \& 50 \% \textbackslash{}x \{\#\$\}")


def test_figures_are_equal_for_equal_results_and_hold_no_time() -> None:
    report = two_planners()
    first, again = pictures(report), pictures(report)
    assert first == again
    assert first["pdf"].startswith(b"%PDF")
    assert b"<svg" in first["svg"]
    assert b"CreationDate" not in first["pdf"]
