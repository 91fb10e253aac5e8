"""`crowdbot results`: the metrics that a suite names come first, in its order."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pytest

from crowdbot import cli
from crowdbot.core.results.results import Results
from crowdbot.core.results.rows import named_metrics
from tests.core.report.report_cases import campaign
from tests.core.results.made_up_record import changed

NAMED = ["min_clearance", "collision_count"]


def test_named_metrics_come_first(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    axes = {"density": ("d0125", "d0250")}
    made = campaign(axes=axes, metrics=(*NAMED, "safe_efficiency"), failures=0)
    runs = tuple(changed(r, suite_metrics=NAMED) for r in made.runs)
    found = replace(made, runs=runs)
    assert named_metrics(found.runs) == NAMED
    shown: dict[str, list[str]] = {}
    for how, results in (("named", found), ("open", made)):
        monkeypatch.setattr(Results, "open", lambda _, results=results: results)
        assert cli.main(["results", "--runs", str(tmp_path), "--json"]) == 0
        rows = json.loads(capsys.readouterr().out)
        shown[how] = list(dict.fromkeys(row["metric"] for row in rows))
    assert shown["named"][:2] == NAMED
    assert shown["open"][0] == "safe_efficiency"
    assert sorted(shown["named"]) == sorted(shown["open"])


@pytest.mark.parametrize("words", [["results"], ["results", "power"], ["results", "tracking"]])
def test_a_folder_is_told_where_it_belongs(
    words: list[str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert cli.main([*words, str(tmp_path)]) == 2
    output = "".join(c for c in capsys.readouterr().err if c not in " │\n")
    assert "afolderofrunsisgivenwith--runs" in output
