"""Sweeps: axes, trials, resumption, and the verdict about other people."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from crowdbot.core.campaign.sweep import search as sweeping
from crowdbot.core.campaign.sweep.axes import ParameterAxis, Trial, parse_axes, run_trials
from crowdbot.core.campaign.sweep.page import as_json, render, sensitivities, verdict
from crowdbot.core.campaign.sweep.search import (
    Sweep,
    SweepRequest,
    TrialResult,
    known_metric,
    search,
)
from crowdbot.core.registry.registry import discover
from crowdbot.core.statistics.estimate import Estimate
from crowdbot.errors import InputError, UnknownNameError, UsageError


def request(out: Path, **more: Any) -> SweepRequest:
    given = {
        "suite": "challenge-2020", "planner": "dwa", "axes": parse_axes(["speed=0.2..1"]),
        "how": "random", "count": 4, "steps": 3, "seed": 1, "metric": "safe_efficiency",
        "variant": "corrected", "better": "higher", "only": (), "sample": 2, "check": 1,
    }  # fmt: skip
    return SweepRequest(**{**given, **more}, out=out)


def tried(speed: str, score: float, elsewhere: float | None = None) -> TrialResult:
    other = None if elsewhere is None else Estimate(value=elsewhere)
    trial = {"speed": speed} if speed else {}
    return TrialResult(trial=trial, label=f"dwa-{speed}", score=Estimate(value=score), runs=2,
                 elsewhere=other)  # fmt: skip


def trials(how: Any, texts: list[str], count: int = 5, seed: int = 1) -> list[Trial]:
    return list(run_trials(parse_axes(texts), how, count, seed, 3, lambda _: 0.0, "higher"))


def test_a_grid_has_every_combination() -> None:
    found = trials("grid", ["a=x,y", "b=0..1"])
    assert len(found) == 6
    assert [t["b"] for t in found[:3]] == ["0", "0.5", "1"]
    assert [t["n"] for t in trials("grid", ["n=1..3:int"])] == ["1", "2", "3"]
    assert [t["n"] for t in trials("grid", ["n=0.01..1:log"])] == ["0.01", "0.1", "1"]


def test_chance_is_of_the_seed_and_more_trials_go_on() -> None:
    found = trials("random", ["a=0..1", "b=x,y"])
    assert found == trials("random", ["a=0..1", "b=x,y"], count=9)[:5]
    assert found != trials("random", ["a=0..1", "b=x,y"], seed=2)
    assert all(0.0 <= float(t["a"]) <= 1.0 for t in found)


@pytest.mark.parametrize("text", ["a", "a=", "=1", "a=1..1", "a=0..1:log", "a=1,,2", "a=1..2:x"])
def test_malformed_axes_are_refused(text: str) -> None:
    with pytest.raises(UsageError, match="--vary"):
        ParameterAxis.parse(text)


def test_axes_are_given_once_and_grids_are_bounded() -> None:
    with pytest.raises(UsageError, match="given twice"):
        parse_axes(["a=1,2", "a=3"])
    wide = parse_axes([f"{c}=0..1" for c in "abcdefghi"])
    with pytest.raises(UsageError, match="19683 trials, more than"):
        list(run_trials(wide, "grid", 1, 1, 3, lambda _: 0.0, "higher"))


def test_optuna_learns_and_repeats_itself() -> None:
    pytest.importorskip("optuna")
    axes = parse_axes(["a=0..1"])

    def score(trial: Trial) -> float:
        return -abs(float(trial["a"]) - 0.3)

    found = [list(run_trials(axes, "optuna", 30, 1, 3, score, "higher")) for _ in range(2)]
    assert found[0] == found[1]
    assert abs(float(max(found[0], key=score)["a"]) - 0.3) < 0.1


@pytest.mark.parametrize(("left", "words"), [
    (0.80, "as large there"), (0.55, "50 % of its lead"), (0.4, "Nothing of its lead"),
])  # fmt: skip
def test_the_verdict_says_what_is_left_on_other_people(
    tmp_path: Path, left: float, words: str
) -> None:
    usual = tried("", 0.5, 0.5)
    best = tried("1", 0.6, left)
    found = Sweep(request=request(tmp_path), tried=(best, tried("0.5", 0.4)), usual=usual)
    text = " ".join(verdict(found))
    assert words in text
    assert "an end of its range" in text
    page = render(found)
    assert words in page
    assert "<script" not in page
    assert as_json(found)["defaults"]["score"]["value"] == 0.5
    assert as_json(found)["trials"][0]["parameters"] == {"speed": "1"}


def test_a_check_with_the_same_people_says_nothing(tmp_path: Path) -> None:
    usual, best = tried("", 0.5, 0.5), tried("1", 0.6, 0.6)
    placed = replace(best, motions=frozenset({"a", "b"}), motions_elsewhere=frozenset({"a", "b"}))
    drawn = replace(placed, motions_elsewhere=frozenset({"a", "c"}))
    for one, is_told in ((placed, True), (drawn, False)):
        text = " ".join(verdict(Sweep(request=request(tmp_path), tried=(one,), usual=usual)))
        assert ("the same people" in text) == is_told
        assert ("as large there" in text) != is_told


def test_rounds_are_trials_and_checks(tmp_path: Path) -> None:
    assert request(tmp_path).rounds == 4 + 1 + 1 + 1
    assert request(tmp_path, check=0).rounds == 4 + 1
    assert request(tmp_path, how="grid", check=9).rounds == 3 + 1 + 3 + 1


def test_sensitivity_is_the_share_between_values(tmp_path: Path) -> None:
    axes = parse_axes(["a=x,y", "b=p,q"])
    rows = [("x", "p", 1.0), ("x", "q", 1.1), ("y", "p", 0.0), ("y", "q", 0.1)]
    found = tuple(
        TrialResult(trial={"a": a, "b": b}, label="", score=Estimate(value=v), runs=1)
        for a, b, v in rows
    )
    by_name = {
        s.name: s.share
        for s in sensitivities(Sweep(request=request(tmp_path, axes=axes), tried=found, usual=None))
    }
    assert by_name["a"] == pytest.approx(1.0 / 1.01)
    assert by_name["b"] == pytest.approx(0.01 / 1.01)


def test_a_folder_holds_one_sweep(tmp_path: Path) -> None:
    sweeping._claim(request(tmp_path))
    sweeping._claim(request(tmp_path, count=9, check=0))
    with pytest.raises(InputError, match=r"holds another sweep \(seed differ\)"):
        sweeping._claim(request(tmp_path, seed=5))
    assert json.loads((tmp_path / "sweep.json").read_text())["trials"] == []


def test_people_are_not_the_editions(tmp_path: Path) -> None:
    registry = discover(allow=())
    file = sweeping._derived(request(tmp_path), registry, "search", 7)
    assert "builtin:challenge-2020.yaml" in file.read_text()
    assert "seed: 7" in file.read_text()
    with pytest.raises(UsageError, match="has the people of challenge-2020"):
        sweeping._derived(request(tmp_path), registry, "search", 20200430)


def test_scores_need_a_direction() -> None:
    registry = discover(allow=())
    assert known_metric(registry, "safe_efficiency") == ("corrected", "higher")
    assert known_metric(registry, "push_work") == ("rate", "lower")
    with pytest.raises(UnknownNameError):
        known_metric(registry, "safe_eficiency")


def test_a_wrong_parameter_ends_it_before_anything_runs(tmp_path: Path) -> None:
    unknown, negative = (parse_axes([f"{text}=-1..1"]) for text in ("marginn", "margin"))
    with pytest.raises(InputError, match="no parameter 'marginn'; did you mean 'margin'"):
        search(request(tmp_path / "new", axes=unknown), discover(allow=()), fail)
    with pytest.raises(InputError, match="margin: Input should be greater"):
        search(request(tmp_path / "new", axes=negative), discover(allow=()), fail)
    assert not (tmp_path / "new").exists()


def fail(plan: object, title: str) -> Any:
    pytest.fail(f"{title}: {plan}")
