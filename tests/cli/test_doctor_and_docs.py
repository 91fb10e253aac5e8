"""`crowdbot doctor`, `crowdbot docs`, completion, silence, and tables in narrow terminals."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from rich.console import Console

from crowdbot import cli
from crowdbot.cli.app import complete as _complete
from crowdbot.cli.commands.start.docs import _excerpt
from crowdbot.cli.output import doctor as _doctor
from crowdbot.core.registry.registry import discover
from crowdbot.core.scoring.scores_csv import scores_table
from crowdbot.core.types.score import Score
from tests.paths import ROOT

FILE = str(ROOT / "docs" / "tutorial" / "files" / "my_scenario.yaml")


def test_the_doctor_looks_at_everything(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["doctor", "--no-self-test", "--out", str(tmp_path), "--json"]) == 0
    found = {f["what"]: f for f in json.loads(capsys.readouterr().out)}
    assert {"system", "drake", "EGL", "kernels", "cores", "disk"} <= set(found)
    assert str(tmp_path) in found["disk"]["found"]
    assert cli.main(["doctor", "--no-self-test", "-q"]) == 0
    assert "numpy" not in capsys.readouterr().out


def test_what_is_missing_is_told(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(_doctor, "_version", lambda name: "" if name == "drake" else "1")
    assert cli.main(["doctor", "--no-self-test"]) == 1
    assert "missing  drake        not installed" in capsys.readouterr().out


@pytest.mark.slow
def test_the_self_test_simulates() -> None:
    found = _doctor.self_test()
    assert found.verdict == "ok", found
    assert "simulated, recorded and scored" in found.found


def test_documents_are_listed_printed_and_searched(capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["docs"]) == 0
    assert "howto/score_own_data" in capsys.readouterr().out
    assert cli.main(["docs", "score_own_data"]) == 0
    text = (ROOT / "docs" / "howto" / "score_own_data.md").read_text().rstrip()
    assert capsys.readouterr().out.rstrip() == text
    assert cli.main(["docs", "howto/score_own_data", "--path"]) == 0
    assert Path(capsys.readouterr().out.strip()).is_file()
    assert cli.main(["docs", "--search", "MILLIMETRES"]) == 0
    assert "howto/score_own_data:" in capsys.readouterr().out
    assert cli.main(["docs", "--search", "xyzzy"]) == 1
    assert cli.main(["docs", "score_own_dat"]) == 1
    assert "did you mean 'score_own_data'" in capsys.readouterr().err


def _completed(words: list[str], cache: Path) -> list[str]:
    environment = {
        **os.environ,
        "_CROWDBOT_COMPLETE": "complete_bash",
        "COMP_WORDS": " ".join(["crowdbot", *words]),
        "COMP_CWORD": str(len(words)),
        "XDG_CACHE_HOME": str(cache),
    }
    code = "from crowdbot.cli import main; raise SystemExit(main([]))"
    done = subprocess.run(
        [sys.executable, "-c", code], env=environment, capture_output=True, text=True
    )
    assert done.stderr == ""
    return done.stdout.split()


@pytest.mark.slow
def test_a_shell_completes(tmp_path: Path) -> None:
    ids = _completed(["simulate", "challenge-2020", "counter-d0250-dispersed-c20"], tmp_path)
    assert ids == [f"counter-d0250-dispersed-c20-r{r}" for r in ("02", "05", "10")]
    assert _completed(["simulate", "x", "--planner", "stop"], tmp_path) == ["stop_and_go"]
    assert "challenge-2026" in _completed(["expand", "challenge"], tmp_path)


def test_names_of_kinds_are_kept(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    registry = discover()
    for what, category in (("planner", "planner"), ("metrics", "metric")):
        complete = _complete.offer(what)
        assert complete is not None
        assert complete(None, None, "") == sorted(registry.components(category))
    asked: list[int] = []

    def discovered() -> dict[str, list[str]]:
        asked.append(1)
        return {"planners": ["x"]}

    monkeypatch.setattr(_complete, "_discovered", discovered)
    complete = _complete.offer("planner")
    assert complete is not None
    assert "dwa" in complete(None, None, "d"), "from the cache"
    monkeypatch.setattr(_complete, "_state", lambda: "something was installed")
    for _ in range(2):
        assert complete(None, None, "") == ["x"]
    assert len(asked) == 1, "the second time from the cache"


def test_ids_of_a_file_are_kept(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    assert _complete.suite_ids(FILE) == ["hall"]
    monkeypatch.setattr(_complete, "_expanded", lambda _: [])
    assert _complete.suite_ids(FILE) == ["hall"], "from the cache"
    complete = _complete.offer("scenario")
    assert complete is not None

    class Context:
        params: dict[str, Any] = {"spec": "nowhere.yaml"}  # noqa: RUF012

    assert complete(Context(), None, "") == []
    assert _complete.offer("out") is None


def test_silence(capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["validate", FILE, "-q"]) == 0
    assert capsys.readouterr().out == ""
    assert cli.main(["validate", "-q", "nowhere.yaml"]) == 1
    assert "nowhere.yaml" in capsys.readouterr().err
    assert cli.main(["validate", FILE, "-q", "--json"]) == 0
    assert capsys.readouterr().out
    assert cli.main(["expand", FILE, "--count", "-q"]) == 0
    assert capsys.readouterr().out.strip() == "1", "what was asked for"


def test_an_unknown_scenario_is_answered_with_the_nearest(
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert cli.main(["expand", "challenge-2020", "--one", "counter-d0300"]) == 1
    assert "did you mean 'counter-d0500' or 'counter-d0250'" in capsys.readouterr().err


@pytest.mark.parametrize("width", range(60, 201, 20))
def test_tables_fit_and_lose_nothing(width: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", str(width))
    score = Score(
        metric="neighbour_velocity_similarity", symbol="E_s", category="crowd", unit="1",
        variant="corrected_whole", better="higher", status="censored",
        reason="did_not_arrive_in_time", lower=0.125, upper=0.875,
    )  # fmt: skip
    console = Console(width=width)
    with console.capture() as captured:
        console.print(scores_table([score]))
    lines = captured.get().splitlines()
    assert max(len(line) for line in lines) <= width
    text = "".join("".join(lines).split())
    assert all(c in text for c in ("E_s", "corrected_whole", "0.125", "+"))
    if width < 80:  # broken between words
        assert {"neighbour_", "velocity_", "similarity"} <= set("\n".join(lines).split())
    else:
        assert "neighbour_velocity_similarity" in text


@given(st.text("ab c", max_size=400), st.text("ab", min_size=1, max_size=9))
def test_excerpts_hold_the_text(line: str, text: str) -> None:
    shown = _excerpt(f"{line}{text}{line}", text)
    assert text in shown
    assert len(shown) <= 120 + 4


def test_pages_for_developers_are_searched_only_when_asked(
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert cli.main(["docs", "--search", "atomically"]) == 0
    assert "developers/" not in capsys.readouterr().out
    assert cli.main(["docs", "--search", "hash", "--developers"]) == 0
    output = capsys.readouterr().out
    assert "decisions/" in output
    assert "developers/glossary:" in output
