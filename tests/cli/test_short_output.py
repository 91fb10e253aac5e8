"""Short output: runs, results, suites, help and components in a few lines of plain words."""

from __future__ import annotations

import json
import re
from pathlib import Path
from types import SimpleNamespace
from typing import Annotated, Any, Literal

import pytest
from annotated_types import Ge, Gt, Le

from crowdbot import cli
from crowdbot.cli.commands.start import suites
from crowdbot.cli.output import run_summary
from crowdbot.cli.output.results_by_planner import print_by_planner
from crowdbot.cli.output.type_words import default_words, type_words
from crowdbot.core.results.results import Results
from tests.core.report.report_cases import campaign


@pytest.fixture
def two_planners(monkeypatch: pytest.MonkeyPatch) -> Results:
    found = campaign(axes={"density": ("d0125", "d0250")}, failures=0)
    monkeypatch.setattr(Results, "open", lambda _: found)
    return found


def test_planners_are_columns(
    two_planners: Results, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    assert cli.main(["results", "--runs", str(tmp_path)]) == 0
    heads = [line for line in capsys.readouterr().out.splitlines() if line.startswith(" metric")]
    planners = sorted({run.planner for run in two_planners.runs})
    assert [word for head in heads for word in head.split() if word != "metric"] == planners
    assert cli.main(["results", "--runs", str(tmp_path), "--by", "planner,density"]) == 0
    out = capsys.readouterr().out
    assert out.count("d0125") == out.count("d0250") > 0
    assert cli.main(["results", "--runs", str(tmp_path), "--details"]) == 0
    out = capsys.readouterr().out
    assert "median" in out
    assert "planner" in out


def test_planners_that_do_not_fit_get_a_table_of_their_own(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    line = {"metric": "m", "variant": "corrected", "unit": "1", "mean": 0.5, "low": 0.25,
            "high": 0.75, "least": 0.5, "most": 0.5, "median": 0.5, "n": 3, "undefined": 0,
            "not_kept": 0, "censored": 0, "failed": 0}  # fmt: skip
    monkeypatch.setenv("COLUMNS", "60")
    print_by_planner([{"planner": f"planner_{i}", **line} for i in range(6)])
    out = capsys.readouterr().out
    assert all(f"planner_{i}" in out for i in range(6))
    assert max(map(len, out.splitlines())) <= 60
    assert out.count("0.500 [0.250, 0.750]") == 6
    assert "+" not in out
    gone = {"mean": None, "low": None, "high": None, "n": 0, "not_kept": 3}
    print_by_planner([{"planner": "a", **line}, {"planner": "old", **line, **gone}])
    assert "not kept" in capsys.readouterr().out
    print_by_planner([{"planner": "a", **line, "undefined": 1, "censored": 1}])
    assert "0.500 [0.250, 0.750] +2" in capsys.readouterr().out


def test_a_run_without_the_four_scores_shows_its_first(capsys: pytest.CaptureFixture[str]) -> None:
    from crowdbot.core.registry.registry import discover
    from crowdbot.core.scoring.score_factory import ScoreFactory

    known = discover(allow=()).components("metric")
    scores = [ScoreFactory(known[m]).ok("corrected", 0.5) for m in ("risk", "spl")]  # type: ignore[arg-type]
    run: Any = SimpleNamespace(record=SimpleNamespace(people_alone=False))
    run_summary._print_scores(run, scores, everything=False)
    out = capsys.readouterr().out
    assert "risk" in out
    assert "higher is better" in out


def test_reasons_of_the_four_scores_are_words(capsys: pytest.CaptureFixture[str]) -> None:
    from crowdbot.core.registry.registry import discover
    from crowdbot.core.scoring.score_factory import ScoreFactory

    factory = ScoreFactory(discover(allow=()).components("metric")["contacts_per_km"])  # type: ignore[arg-type]
    scores = factory.all_undefined("zero_denominator")
    run: Any = SimpleNamespace(record=SimpleNamespace(people_alone=False))
    run_summary._print_scores(run, scores, everything=False)
    assert "undefined: the robot made no progress" in capsys.readouterr().out
    run_summary._print_scores(run, scores, everything=True)
    assert "zero_denominator" in capsys.readouterr().out


def test_suites_are_listed_with_a_sentence(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    from crowdbot.core.scenarios import library

    monkeypatch.setattr(library, "suite_names", lambda _: ["challenge-2026", "social-guidelines"])
    monkeypatch.setattr(
        suites, "_picture", lambda name: "" if name == "challenge-2026" else "a.svg"
    )
    assert cli.main(["suites", "--json"]) == 0
    found = {one["suite"]: one for one in json.loads(capsys.readouterr().out)}
    assert found["challenge-2026"]["scenarios"] == 162
    assert found["challenge-2026"]["title"]
    assert cli.main(["suites"]) == 0
    out = capsys.readouterr().out
    assert "picture: crowdbot view challenge-2026 in-d020-attentive-n01 --out" in out
    assert "picture: a.svg" in out


@pytest.mark.parametrize("suite", ["challenge-2020", "challenge-2021", "challenge-2026"])
def test_suites_have_pictures_in_the_gallery(suite: str) -> None:
    assert Path(suites._picture(suite)).is_file()


def test_common_options_are_one_line_of_help(capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["suites", "--help"]) == 0
    table, _, line = capsys.readouterr().out.partition("Common options:")
    assert "--json" in table
    assert all(name not in table for name in ("--plugin", "--quiet", "--help"))
    assert all(name in line for name in ("--plugin PATH", "--no-plugins", "-v", "-q", "-h"))


@pytest.mark.parametrize(("annotation", "words"), [
    (float, "number"),
    (Annotated[float, Gt(0)], "number > 0"),
    (Annotated[int, Ge(2), Le(32)], "integer from 2 to 32"),
    (Annotated[float, Gt(0), Ge(0.5), Le(1)], "number from 0.5 to 1"),
    (Annotated[float, Gt(0)] | None, "number > 0 or unset"),
    (Literal["centre", "surface"], "centre or surface"),
    (dict[str, float], "map of names to numbers"),
    (list[str], "list of texts"),
    (tuple[float, float], "2 numbers"),
    (bool, "true or false"),
])  # fmt: skip
def test_types_are_words(annotation: Any, words: str) -> None:
    assert type_words(annotation) == words


def test_no_component_shows_a_python_type(capsys: pytest.CaptureFixture[str]) -> None:
    from crowdbot.core.registry.registry import discover

    for plugin in discover(allow=()).plugins:
        for component in plugin.components:
            for info in component.spec.model_fields.values():
                words = type_words(info.annotation, tuple(info.metadata))
                assert not re.search(r"\[|<\S|Optional|Annotated|Literal", words), component.kind
    assert cli.main(["plugins", "show", "ttca_dca"]) == 0
    out = capsys.readouterr().out
    assert "Literal" not in out
    assert "centre or surface" in out


def test_defaults_are_words() -> None:
    values: tuple[Any, ...] = (None, True, 0.5, [1, 2.0], {}, {"south": 1})
    assert [default_words(v) for v in values] == ["unset", "true", "0.5", "[1, 2]", "none", "south"]


def test_the_doctor_is_quick_unless_asked(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    from crowdbot.cli.output import doctor

    asked: list[int] = []

    def self_test() -> doctor.DoctorFinding:
        asked.append(1)
        return doctor.DoctorFinding("self-test", "ok", "")

    monkeypatch.setattr(doctor, "self_test", self_test)
    assert cli.main(["doctor"]) == 0
    assert "--self-test" in capsys.readouterr().out
    assert not asked
    assert cli.main(["doctor", "--self-test"]) == 0
    assert asked == [1]
