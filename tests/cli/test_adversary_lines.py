"""Lines of ``crowdbot audit --adversaries``."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from crowdbot import cli
from crowdbot.cli.output.adversary_lines import adversary_lines, adversary_text
from crowdbot.core.results.results import Results
from crowdbot.errors import InputError
from tests.core.results.made_up_record import changed
from tests.core.statistics.made_up_results import pairs

VALUES = np.random.default_rng(5).uniform(0.4, 0.6, size=20)


def results(gain: float) -> Results:
    """Planner a is an adversary, b a baseline."""
    found = pairs((VALUES + gain).tolist(), VALUES.tolist(), metric="safe_efficiency")
    roles = {"a": "adversary", "b": "baseline"}
    return replace(found, runs=tuple(changed(r, role=roles[r.planner]) for r in found.runs))


@pytest.mark.parametrize(("gain", "standing"), [(0.1, "ahead"), (-0.1, "behind")])
def test_the_standing_of_an_adversary(gain: float, standing: str) -> None:
    lines = adversary_lines(results(gain), ())
    assert [(x["adversary"], x["careful"], x["standing"]) for x in lines] == [("a", "b", standing)]
    assert lines[0]["efficiency"]["difference"] == pytest.approx(gain)
    text = adversary_text(lines)
    assert ("ahead: a of b" in text) is (standing == "ahead")


def test_without_an_adversary_or_a_careful_planner() -> None:
    found = results(0.1)
    for role, missing in (("baseline", "adversary"), ("adversary", "careful planner")):
        runs = tuple(changed(r, role=role) for r in found.runs)
        with pytest.raises(InputError, match=f"no {missing} was run"):
            adversary_lines(replace(found, runs=runs), ())


def test_other_planners_are_careful_if_they_are_named() -> None:
    found = results(0.1)
    runs = tuple(changed(r, role="candidate") if r.planner == "b" else r for r in found.runs)
    lines = adversary_lines(replace(found, runs=runs), ("b",))
    assert [(x["careful"], x["standing"]) for x in lines] == [("b", "ahead")]


def test_the_audit_runs_people_mpc_beside_the_adversaries(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    argv = ["audit", "challenge-2026", "--adversaries", "--only", "counter-d040-never-n01"]
    assert cli.main([*argv, "--dry-run", "--json", "--out", str(tmp_path)]) == 0
    adversaries, careful = 15, ("dwa", "people_mpc", "stop_and_go")
    assert json.loads(capsys.readouterr().out)["runs"] == adversaries + len(careful)


def test_a_further_careful_planner_is_run_once_beside_the_others(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    argv = ["audit", "challenge-2026", "--adversaries", "--only", "counter-d040-never-n01"]
    named = ["--careful", "rds", "--careful", "people_mpc", "--careful", "dwa"]
    assert cli.main([*argv, *named, "--dry-run", "--json", "--out", str(tmp_path)]) == 0
    assert json.loads(capsys.readouterr().out)["runs"] == 15 + 4


@pytest.mark.parametrize(
    ("options", "expected"),
    [
        (["--careful", "rds"], "add --adversaries"),
        (["--adversaries", "--careful", "bully"], "--careful bully: this planner is an adversary"),
    ],
)
def test_a_careful_planner_that_cannot_be_one(
    options: list[str], expected: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    argv = ["audit", "challenge-2026", *options, "--dry-run", "--out", str(tmp_path)]
    assert cli.main(argv) == 1
    assert expected in capsys.readouterr().err
