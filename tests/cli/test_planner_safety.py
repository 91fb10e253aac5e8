"""Planners that do what no planner should: outcomes and messages, from files and from plugins."""

from __future__ import annotations

import csv
import json
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from crowdbot.core.recording.recording import Recording
from tests.cli.simulate_cases import FILES, Shell, finished, planner_file, process

pytestmark = pytest.mark.slow

PLUGIN = '''
import sys
from typing import ClassVar, Literal
from crowdbot.plugin import Component
from crowdbot.plugin import PlannerSpec
from crowdbot.plugin import hookimpl
CROWDBOT_API = 1

class Spec(PlannerSpec):
    """A planner."""
    needs: ClassVar[tuple[str, ...]] = ()
    privileged: ClassVar[bool] = {privileged}
    kind: Literal["unsafe.go"] = "unsafe.go"

class Go:
    def __init__(self, spec):
        {init}
    def reset(self, task, limits, sensors, seed):
        {reset}
    def step(self, obs):
        {step}

@hookimpl
def crowdbot_components():
    return {{"planner": [Component(spec=Spec, build="unsafe:{build}", summary="unsafe")]}}
'''
QUIET = ("--no-references",)


@pytest.fixture(autouse=True)
def _forget() -> Iterator[None]:
    yield
    sys.modules.pop("unsafe", None)


def plugin_file(folder: Path, **code: str) -> list[str]:
    """Options that run a planner of a plugin."""
    given = {"init": "pass", "reset": "pass", "step": "return (0.1, 0.0)", "build": "Go"}
    path = folder / "unsafe.py"
    text = PLUGIN.format(**{"privileged": "False", **given, **code})
    path.write_text(text, encoding="utf-8")
    return ["--plugin", str(path), "--planner", "unsafe.go"]


def file_options(folder: Path, **code: str) -> list[str]:
    return ["--planner", planner_file(folder, **code)]


FAILING = {
    "interrupts": ({"step": "raise KeyboardInterrupt"}, "step: KeyboardInterrupt"),
    "its own way out": ({"step": "raise type('Out', (BaseException,), {})('bye')"}, "Out: bye"),
    "generator exit": ({"step": "raise GeneratorExit"}, "step: GeneratorExit"),
    "interrupts init": ({"init": "raise KeyboardInterrupt"}, "cannot be built: KeyboardInterrupt"),
    "exits in init": ({"init": "sys.exit(3)"}, "cannot be built: SystemExit: 3"),
    "raises in init": ({"init": "raise ValueError('no')"}, "cannot be built: ValueError: no"),
    "raises in reset": ({"reset": "raise ValueError('no')"}, "reset: ValueError: no"),
    "changes time": ({"step": "obs.t = 3.0"}, "FrozenInstanceError"),
    "changes the zone": ({"step": "obs.goal_zone[0] = 1.0"}, "read-only"),
    "adds a reading": ({"step": "obs.readings['x'] = 1"}, "TypeError"),
    "logs no number": ({"step": "obs.log('x', 'fast')"}, "could not convert string to float"),
    "logs no name": ({"step": "obs.log(3, 1.0)"}, "name of a signal is text, not 3"),
    "asks for the truth": ({"step": "return obs.truth.pose"}, "'NoneType' object has no attribute"),
    "returns an array": ({"step": "import numpy; return numpy.zeros(2)"}, "(ndarray)"),
}  # fmt: skip


CASES = [(plugin_file, case) for case in FAILING] + [
    (file_options, case) for case in ("interrupts", "interrupts init", "changes the zone")
]


@pytest.mark.parametrize(("source", "case"), CASES)
def test_a_planner_that_fails(source: Any, case: str, shell: Shell, tmp_path: Path) -> None:
    code, text = FAILING[case]
    answer = shell(*source(tmp_path, **code), *QUIET, "--json")
    assert answer.code == 3
    assert answer.json["status"] == "planner_failed"
    assert text in answer.json["reason"]
    name = "planner 'Mine'" if source is file_options else "planner 'unsafe.go' ("
    assert answer.json["reason"].startswith(name)
    assert ".py:" in answer.json["reason"] or "returned" in answer.json["reason"]
    assert {p.name for p in Path(answer.json["directory"]).iterdir()} == FILES
    assert shell.leftovers() == []


def test_what_is_built_must_be_a_planner(shell: Shell, tmp_path: Path) -> None:
    answer = shell(*plugin_file(tmp_path, build="Spec"), *QUIET)
    assert answer.code == 3
    assert "cannot be built" in answer.err
    (tmp_path / "unsafe.py").write_text(
        (tmp_path / "unsafe.py").read_text().replace("unsafe:Spec", "unsafe:dict")
        + "\ndef dict(spec): return {}\n"
    )
    sys.modules.pop("unsafe")
    answer = shell("--plugin", str(tmp_path / "unsafe.py"), "--planner", "unsafe.go", *QUIET)
    assert "what was built, a dict, has no reset and no step" in answer.err.replace("\n", " ")


def test_it_fails_in_the_calibration_run_as_well(shell: Shell, tmp_path: Path) -> None:
    step = "return 1 / 0 if obs.t > 0.4 else (0.1, 0.0)"
    answer = shell("--planner", planner_file(tmp_path, step), "--json")
    assert answer.code == 3
    run = Path(answer.json["directory"])
    alone = json.loads(
        (run / answer.json["references"]["robot_alone"]).with_name("run.json").read_text()
    )
    assert alone["status"] == "planner_failed"
    assert "): step: ZeroDivisionError" in alone["reason"]
    assert shell.leftovers() == []


def test_commands_beyond_the_limits_are_clamped_and_counted(shell: Shell, tmp_path: Path) -> None:
    answer = shell(*plugin_file(tmp_path, step="return (9.0, -99.0, 3.0)"), *QUIET, "--json")
    assert answer.code == 0
    assert answer.json["clamped_commands"] >= 8


CHATTER = {
    "print": "print('chatter')",
    "stdout": "sys.__stdout__.write('chatter\\n')",
    "descriptor": "import os; os.write(1, b'chatter\\n')",
    "child": "import subprocess; subprocess.run(['echo', 'chatter'])",
    "compiled": "import ctypes; ctypes.CDLL(None).puts(b'chatter')",
}


def test_nothing_that_a_planner_says_reaches_stdout(tmp_path: Path) -> None:
    code = "; ".join(CHATTER.values())
    options = plugin_file(tmp_path, step=f"{code}; return (0.1, 0.0)", init=code, reset=code)
    (tmp_path / "unsafe.py").write_text(f"{(tmp_path / 'unsafe.py').read_text()}\n{code}\n")
    answer = finished(process(tmp_path / "runs", *options, *QUIET, "--json", seconds=0.3))
    assert answer.code == 0, answer.err
    assert answer.json["status"] == "timeout"
    assert answer.err.count("chatter") >= 5 * 4


def test_the_budget_of_a_step(shell: Shell, tmp_path: Path) -> None:
    slow = {"step": "time.sleep(0.6 if 0.4 < obs.t < 0.5 else 0.0); return (0.1, 0.0)"}
    options = [*file_options(tmp_path, **slow), *QUIET, "--json"]
    assert shell(*options).code == 0
    answer = shell(*options, "--step-budget", "0.5")
    assert answer.code == 3
    assert answer.json["step_budget"] == 0.5
    assert "the budget is 0.5 s" in answer.json["reason"]
    assert 0.4 < answer.json["sim_time"] < 0.6
    again = shell(*options)
    assert again.json["reused"] is False  # another run than the one with a budget


@pytest.mark.parametrize("seconds", ["0", "-1", "nan", "11"])
def test_a_budget_that_means_nothing(seconds: str, shell: Shell) -> None:
    answer = shell("--planner", "goal_seek", "--step-budget", seconds)
    why = "must be a number, not nan" if seconds == "nan" else "must be above 0 and below 10 s"
    assert answer.code == 1
    assert why in answer.err


def test_the_time_of_steps_is_a_metric(shell: Shell, tmp_path: Path) -> None:
    step = "time.sleep(0.01); return (0.1, 0.0)"
    answer = shell(*file_options(tmp_path, step=step), *QUIET, "--json")
    found = {s["metric"]: s["value"] for s in answer.json["scores"]}
    assert 0.01 <= found["mean_planner_time"] <= found["max_planner_time"]


# ----------------------------------------------------------------------- the truth
TRUTH = (
    "x = obs.truth; obs.log('n', len(x.people)); obs.log('x', x.pose.x); "
    "obs.log('near', float(abs(x.people - x.pose[:2]).min())); "
    "assert x.people.shape == x.people_velocity.shape == (len(x.people_id), 2); "
    "assert not x.people.flags.writeable; assert len(set(x.people_id)) == len(x.people_id); "
    "return (0.3, 0.0)"
)


def test_privileged_planners_see_the_truth_and_are_marked(shell: Shell, tmp_path: Path) -> None:
    options = plugin_file(tmp_path, privileged="True", step=TRUTH)
    answer = shell(*options, *QUIET, "--json")
    assert answer.code == 0, answer.json["reason"]
    assert answer.json["privileged"] is True
    run = Path(answer.json["directory"])
    rows = list(csv.DictReader((run / "scores.csv").read_text().splitlines()))
    assert {r["planner"] for r in rows} == {"unsafe.go+privileged"}

    recorded = Recording(run / "run.mcap").trajectories()
    assert recorded.robot is not None
    assert recorded.agents is not None
    seen = {n: v[:, 1] for n, v in recorded.signals.items()}
    assert seen["n"][0] == (recorded.agents.x[0] == recorded.agents.x[0]).sum()
    assert seen["x"][0] == recorded.robot.x[0]
    done = shell(*options, *QUIET)
    assert "privileged" in done.out
    assert "the planner sees the truth" in (run / "replay.html").read_text()


def test_the_truth_without_people(shell: Shell, tmp_path: Path) -> None:
    step = "assert obs.truth.people.shape == (0, 2); return (0.1, 0.0)"
    options = plugin_file(tmp_path, privileged="True", step=step)
    for crowd in ("crowd=null", "robots.robot.task.time_limit=0.5 s"):
        answer = shell(*options, "--set", crowd, "--json")
        assert (answer.code == 0) == (crowd == "crowd=null"), answer.err


def test_the_truth_changes_nothing_for_who_does_not_look(shell: Shell, tmp_path: Path) -> None:
    plain = shell(*plugin_file(tmp_path), *QUIET, "--json").json["hashes"]["trajectory"]
    sys.modules.pop("unsafe")
    seer = shell(*plugin_file(tmp_path, privileged="True"), *QUIET, "--json").json
    assert seer["hashes"]["trajectory"] == plain


# ------------------------------------------------------------------------- pinned
def test_what_is_not_installed_is_told(shell: Shell, tmp_path: Path) -> None:
    options = plugin_file(tmp_path)
    record = shell(*options, *QUIET, "--json").json
    assert record["pinned"] is False
    assert record["allowed_plugins"] is None
    (mine,) = [p for p in record["plugins"] if p["name"] == "unsafe"]
    assert mine["distribution"] == "unsafe.py"
    assert len(mine["sha256"]) == 64
    done = shell(*options, *QUIET)
    assert "not pinned" in done.out.replace("\n", " ")
    page = (Path(record["directory"]) / "replay.html").read_text()
    assert "Not pinned" in page
    assert shell("--planner", "goal_seek", *QUIET, "--json").json["pinned"] is True


def test_an_edited_plugin_is_another_run(shell: Shell, tmp_path: Path) -> None:
    options = plugin_file(tmp_path)
    first = shell(*options, "--json").json
    assert shell(*options, "--json").json["reused"] is True
    sys.modules.pop("unsafe")
    second = shell(*plugin_file(tmp_path, step="return (0.2, 0.0)"), "--json").json
    assert second["reused"] is False
    assert second["references"]["robot_alone"] != first["references"]["robot_alone"]
