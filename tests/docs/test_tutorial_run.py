"""The planner of the tutorial in one short run, and what the documents say about its files."""

from __future__ import annotations

import inspect
import json
import re
import runpy
import shutil
import subprocess
import sys
from typing import Any

import pytest

import crowdbot
from tests.docs.doc_pages import commands, read, section
from tests.paths import ROOT

pytestmark = pytest.mark.slow

FILES = ROOT / "docs" / "tutorial" / "files"


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> crowdbot.Run:
    """The short command of the tutorial, in a folder with the planner's file."""
    folder = tmp_path_factory.mktemp("tutorial")
    shutil.copy(FILES / "my_planner.py", folder)
    (words,) = [
        w
        for page, w in commands()
        if page == "docs/tutorial/first_planner.md" and "--no-references" in w
    ]
    argv = [sys.executable, "-m", "crowdbot", *words, "--quiet", "--json"]
    done = subprocess.run(argv, cwd=folder, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    record = json.loads(done.stdout)
    return crowdbot.Run.open(folder / record["directory"])


def test_the_planner_ran_to_the_limit(run: crowdbot.Run) -> None:
    assert run.status == "timeout"
    assert run.record.planner.name == "MyPlanner"
    assert run.record.pinned is False
    signal = run.trajectories.signals["my_planner/nearest"]
    assert len(signal) >= 32
    assert run.trajectories.robot is not None
    assert run.trajectories.robot.v.max() > 0.3


def test_every_file_is_described(run: crowdbot.Run) -> None:
    text = read("reference/run_directory.md").partition("## run.json")[0]
    described = set(re.findall(r"^\| `([\w.]+)` \|", text, re.M))
    assert described == {f.name for f in run.directory.iterdir()}
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    assert described <= set(re.findall(r"^\| `([\w.]+)` \|", readme, re.M))


def test_every_key_is_described(run: crowdbot.Run) -> None:
    text = section(read("reference/run_directory.md"), "## run.json")
    cells = re.findall(r"^\| ((?:`\w+`(?:, )?)+) \|", text, re.M)
    assert {k for c in cells for k in re.findall(r"`(\w+)`", c)} == {
        *run.record.document(),
        "excused",
        "live",
        "replace_draws",
        "robots",
        "toppled_time",
    }
    named = ("axes", "axis_words", "metrics")  # their keys are names that a suite or a plugin chose
    chosen = {k: v for k, v in run.record.document().items() if k not in named}
    inner = {k for v in chosen.values() if isinstance(v, dict) for k in v}
    inner |= {k for plugin in run.record.plugins for k in plugin.document()}
    assert {k for k in inner if f"`{k}`" not in text} == set()


def test_every_column_of_the_scores_is_described(run: crowdbot.Run) -> None:
    text = section(read("reference/run_directory.md"), "## scores.csv")
    cells = re.findall(r"^\| ((?:`\w+`(?:, )?)+) \|", text, re.M)
    header = (run.directory / "scores.csv").read_text(encoding="utf-8").splitlines()[0]
    assert {k for c in cells for k in re.findall(r"`(\w+)`", c)} == set(header.split(","))


def test_the_python_example_works(
    run: crowdbot.Run, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    real = inspect.signature(crowdbot.simulate)

    def simulate(*args: Any, **kwargs: Any) -> crowdbot.Run:
        real.bind(*args, **kwargs)
        return run

    monkeypatch.setattr(crowdbot, "simulate", simulate)
    runpy.run_path(str(FILES / "python_api.py"))
    first, *rest = capsys.readouterr().out.splitlines()
    assert first.endswith("timeout 2.00 s")
    assert [line.split()[:2] for line in rest] == [
        [s.metric, s.variant] for s in crowdbot.evaluate(run)
    ]
