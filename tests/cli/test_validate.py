from __future__ import annotations

import json

import pytest

from crowdbot.cli import main
from tests.paths import DATA

DATA = DATA / "diagnostics"
BAD = str(DATA / "E102_unknown_field.yaml")

Captured = pytest.CaptureFixture[str]


def test_good_suite(capsys: Captured) -> None:
    assert main(["validate", "challenge-2020"]) == 0
    assert capsys.readouterr().out == "challenge-2020: ok, 162 scenarios\n"


def test_quiet(capsys: Captured) -> None:
    assert main(["validate", "-q", "challenge-2020"]) == 0
    assert main(["-q", "validate", "challenge-2020"]) == 0
    assert capsys.readouterr() == ("", "")


def test_values_that_are_set(capsys: Captured) -> None:
    start = ["validate", "challenge-2020", "--set"]
    assert main([*start, "robots.robot.task.time_limit=5"]) == 0
    assert capsys.readouterr().out == "challenge-2020: ok, 162 scenarios\n"
    assert main([*start, "robots.robot.task.start=[99,0,0]"]) == 1
    assert "--set:1:25: error[E132] the start (99, 0)" in capsys.readouterr().err


def test_errors_of_all_files(capsys: Captured) -> None:
    other = str(DATA / "E131_count.yaml")
    assert main(["validate", BAD, "challenge-2020", other]) == 1
    shown = capsys.readouterr()
    assert f"{BAD}:6:12: error[E102] unknown field 'denisty' in crowd.flow" in shown.err
    assert "            ^^^^^^^ did you mean 'density'?" in shown.err
    assert f"{other}:5:23: error[E131]" in shown.err
    assert shown.err.endswith("2 errors; see docs/reference/errors.md\n")
    assert shown.out == "challenge-2020: ok, 162 scenarios\n"


@pytest.mark.parametrize("flags", [["--json"], ["--format", "json"]])
def test_json(flags: list[str], capsys: Captured) -> None:
    assert main(["validate", *flags, BAD, "challenge-2020"]) == 1
    bad, good = json.loads(capsys.readouterr().out)
    assert (good["spec"], good["ok"], good["scenarios"]) == ("challenge-2020", True, 162)
    (error,) = bad["errors"]
    assert (error["code"], error["line"], error["column"], error["width"]) == ("E102", 6, 12, 7)
    assert (error["file"], error["hint"]) == (BAD, "did you mean 'density'?")


def test_json_names_the_includer(capsys: Captured) -> None:
    main(["validate", "--json", str(DATA / "E120_included.yaml")])
    (error,) = json.loads(capsys.readouterr().out)[0]["errors"]
    assert error["file"].endswith("parts/bad_kind.yaml")
    assert [p.rsplit("/")[-1] for p in error["included_from"]] == ["E120_included.yaml:6"]


def test_github(capsys: Captured) -> None:
    assert main(["validate", "--format", "github", BAD]) == 1
    assert capsys.readouterr().out == (
        f"::error file={BAD},line=6,col=12,title=E102::"
        "unknown field 'denisty' in crowd.flow (did you mean 'density'?)\n"
    )


@pytest.mark.parametrize(
    ("spec", "text"),
    [
        ("chalenge-2020", "did you mean 'challenge-2020'"),
        ("none.yaml", "o such file"),
        (str(DATA), "is a folder"),
    ],
)
def test_specs_that_are_no_documents(spec: str, text: str, capsys: Captured) -> None:
    assert main(["validate", spec]) == 1
    shown = capsys.readouterr().err
    assert shown.startswith(f"{spec}:1:1: error[E001]")
    assert text in shown
