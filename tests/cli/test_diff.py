from __future__ import annotations

import json
import math
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from crowdbot.cli import main
from crowdbot.core.support.json_diff import ABSENT, differences
from tests.core.results.made_up_record import made_up_record
from tests.paths import ROOT

Captured = pytest.CaptureFixture[str]
A, B = "challenge-2020/in-d0125-slow-c01-r02", "challenge-2020/in-d0125-slow-c20-r02"
ROOT = ROOT
JSON = st.recursive(
    st.none() | st.booleans() | st.integers(-3, 3) | st.text("abc", max_size=2),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text("abc"), inner, max_size=3),
    max_leaves=8,
)


def test_two_scenarios(capsys: Captured) -> None:
    assert main(["diff", A, B]) == 1
    head_a, head_b, count, row = capsys.readouterr().out.splitlines()
    assert head_a.split()[:2] == ["a", A]
    assert head_b.split()[:2] == ["b", B]
    assert count == "scenario: 1 difference"
    assert row.split() == ["crowd.costs.mid_term.weight", "1.0", "20.0"]


@pytest.mark.slow
def test_equal_ones(capsys: Captured) -> None:
    file = ROOT / "scenario_specs" / "challenge-2020.yaml"
    assert main(["diff", A, f"{file}#in-d0125-slow-c01-r02"]) == 0
    first, second, output = capsys.readouterr().out.splitlines()
    assert output == "scenario: equal"
    assert first.split()[2] == second.split()[2]


def test_set_changes_the_second(capsys: Captured) -> None:
    assert main(["diff", A, A, "--set", "crowd=null", "--json"]) == 1
    document = json.loads(capsys.readouterr().out)
    assert document["equal"] is False
    assert document["a"]["hash"] != document["b"]["hash"]
    fields = {d["field"]: d for d in document["scenario"]}
    assert fields["crowd"]["b"] is None
    assert {"kinds.rvo", "kinds.ttca_dca", "kinds.velocity_space"} < set(fields)
    assert "b" not in fields["kinds.rvo"]


@pytest.mark.parametrize(
    ("side", "words"),
    [
        ("challenge-2020", "no id was given"),
        ("challenge-2020/sideways", "unknown scenario"),
        ("challenge-2030/in", "challenge-2030/in"),
        ("nothing.yaml", "error[E001]"),
        (".", "no run directory"),
    ],
)
def test_a_side_that_is_nothing(
    side: str, words: str, capsys: Captured, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["diff", A, side]) == 1
    assert words in capsys.readouterr().err


def run(folder: Path, capsys: Captured, value: str, trajectory: str) -> str:
    """A run directory, as far as ``diff`` reads it."""
    folder.mkdir()
    main(["expand", "challenge-2020", "--one", "in-d0125-slow-c01-r02"])
    (folder / "scenario.yaml").write_text(capsys.readouterr().out, encoding="utf-8")
    made_up_record(trajectory_hash=trajectory, wall_time=float(len(value))).write(folder)
    (folder / "scores.csv").write_text(
        "metric,variant,value,unit,status,reason\n"
        f"risk,literal,{value},s,ok,\nrisk,corrected,,s,undefined,no people\n",
        encoding="utf-8",
    )
    return str(folder)


@pytest.mark.slow
def test_two_runs(tmp_path: Path, capsys: Captured) -> None:
    first = run(tmp_path / "a", capsys, "1.5", "x")
    again = run(tmp_path / "b", capsys, "1.50000", "x")
    other = run(tmp_path / "c", capsys, "2.5", "y")
    assert main(["diff", first, again]) == 0  # neither spelling nor wall time counts
    capsys.readouterr()
    assert main(["diff", first, other, "--json"]) == 1
    document = json.loads(capsys.readouterr().out)
    assert document["scenario"] == []
    assert document["run"] == [{"field": "hashes.trajectory", "a": "x", "b": "y"}]
    assert document["scores"] == [{"field": "risk.literal.value", "a": 1.5, "b": 2.5}]
    assert main(["diff", first, A]) == 0  # a run against a scenario: its scenario
    assert main(["diff", A, first, "--set", "crowd=null"]) == 1
    assert "not a run" in capsys.readouterr().err


def test_a_run_with_a_broken_table(tmp_path: Path, capsys: Captured) -> None:
    folder = run(tmp_path / "a", capsys, "1.5", "x")
    (tmp_path / "a" / "scores.csv").write_text("metric,variant\nrisk,literal\n")
    assert main(["diff", folder, folder]) == 1
    assert "no table of scores" in capsys.readouterr().err


@given(JSON, JSON)
def test_differences_are_symmetric_and_none_for_equals(a: object, b: object) -> None:
    assert list(differences(a, a)) == []
    there, back = list(differences(a, b)), list(differences(b, a))
    assert [(d.path, d.a, d.b) for d in there] == [(d.path, d.b, d.a) for d in back]
    assert bool(there) is (json.dumps(a, sort_keys=True) != json.dumps(b, sort_keys=True))


def test_kinds_are_not_mixed_and_types_count() -> None:
    (one,) = differences({"m": {"kind": "a", "x": 1}}, {"m": {"kind": "b", "y": 1}})
    assert (one.path, one.a["kind"], one.b["kind"]) == ("m", "a", "b")
    assert [d.path for d in differences({"x": 1}, {"x": True})] == ["x"]
    (gone,) = differences({"x": {"y": math.pi}}, {})
    assert (gone.path, gone.b) == ("x", ABSENT)
