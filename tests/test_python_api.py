"""What the functions of ``crowdbot`` take, and that what is wrong is our own error."""

from __future__ import annotations

import functools
import re
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import pytest

import crowdbot
from crowdbot.core.planning.given_planner import choose_planner
from crowdbot.core.planning.resolve import PlannerChoice
from crowdbot.core.registry.registry import discover
from crowdbot.plugin import Command, Observation
from crowdbot.plugins.planners.dwa.dwa import DwaSpec
from tests.core.results.made_up_record import made_up_record
from tests.paths import ROOT

FILE = ROOT / "docs" / "tutorial" / "files" / "my_scenario.yaml"
SUITE, ID = "challenge-2020", "counter-d0250-dispersed-c20-r05"


@functools.cache
def short() -> crowdbot.Scenario:
    """One simulated second of a scenario."""
    return crowdbot.load(SUITE, ID, set="robots.robot.task.time_limit=1")


@functools.cache
def driven() -> crowdbot.Trajectories:
    """Two samples of a robot that stands."""
    still = {"robot_x": [0, 0], "robot_y": [0, 0], "robot_theta": [0, 0]}
    body: dict[str, Any] = {"t": [0.0, 1.0], "robot_radius": 0.2, "robot_mass": 6.0, **still}
    return crowdbot.Trajectories.from_arrays(**body)


class Creep:
    """Goes slowly ahead and remembers what it saw."""

    needs = ()

    def __init__(self, v: float = 0.1) -> None:
        self.v = v
        self.seen: list[float] = []

    def reset(self, task: Any, limits: Any, sensors: Mapping[str, Any], seed: int) -> None:
        del task, limits, sensors, seed
        self.seen = []

    def step(self, obs: Observation) -> Command:
        self.seen.append(obs.t)
        return Command(self.v, 0.0)


def test_settings_are_texts_or_a_mapping() -> None:
    file, key = FILE, "crowd.flow.density"
    one = crowdbot.load(file, set=f"{key}=0.5")
    assert isinstance(one, crowdbot.Scenario)
    assert one == crowdbot.load(file, set=[f"{key}=0.5"]) == crowdbot.load(file, set={key: 0.5})
    assert one != crowdbot.load(file)
    assert crowdbot.expand(one) == [one]


def test_a_suite_is_expanded_by_name() -> None:
    assert len(crowdbot.expand(SUITE)) == 162


CALLS: list[tuple[Callable[[], object], str]] = [
    (lambda: crowdbot.load(FILE, set="density"), "density"),
    (lambda: crowdbot.load(FILE, set={"crowd.flow.denisty": 1}), "did you mean 'density'"),
    (lambda: crowdbot.load(FILE, set={"crowd": object()}), "number, text, list or mapping"),
    (lambda: crowdbot.load(SUITE, ID, set=3), "key=value texts or a mapping"),  # type: ignore[call-overload]
    (lambda: crowdbot.load(3), "path_or_name must be a str or Path, not an int"),  # type: ignore[call-overload]
    (lambda: crowdbot.load(SUITE, 3), "scenario must be a str, not an int"),  # type: ignore[call-overload]
    (lambda: crowdbot.load(SUITE, "counter-d250"), "unknown scenario"),
    (lambda: crowdbot.expand(3), "suite must be"),  # type: ignore[arg-type]
    (lambda: crowdbot.expand(short(), set="a=1"), "give it to load"),
    (lambda: crowdbot.simulate(SUITE), "crowdbot.load(SUITE, ID)"),  # type: ignore[arg-type]
    (lambda: crowdbot.evaluate("nowhere"), "no run directory"),
    (lambda: crowdbot.evaluate(3), "run must be a Run, not an int"),  # type: ignore[arg-type]
    (lambda: crowdbot.score("run.csv"), "crowded must be a Trajectories, not a str"),  # type: ignore[arg-type]
    (lambda: crowdbot.score(commands=[1]), "commands must be a Commands"),  # type: ignore[arg-type]
    (lambda: crowdbot.Results.open("nowhere"), "no folder of results"),
    (lambda: crowdbot.results(3), "root must be a path, not an int"),  # type: ignore[arg-type]
    (lambda: crowdbot.Run.open("nowhere"), "no run directory"),
    (lambda: crowdbot.Results().to_pandas("people"), "no table 'people'"),  # type: ignore[arg-type]
    (lambda: crowdbot.Session("x"), "a session needs a scenario"),  # type: ignore[arg-type]
    (lambda: crowdbot.Session(short(), seed=-1), "at least 0, not -1"),
    (lambda: crowdbot.Session(short(), sensors=["radar"]), "needs 'radar'"),
    (lambda: crowdbot.simulate(short(), planner=3), "an int is not a planner"),  # type: ignore[arg-type]
    (lambda: crowdbot.simulate(short(), planner=int), "class 'int' is not a planner"),
    (lambda: crowdbot.simulate(short(), planner=Creep, planner_settings={"w": 1}), "'w'"),
    (lambda: crowdbot.simulate(short(), planner=Creep(), planner_settings={"v": 1}), "its own"),
    (lambda: crowdbot.load(FILE, set=[3]), "key=value texts or a mapping, not an int"),  # type: ignore[list-item]
    (lambda: crowdbot.load(FILE, set=b"a=1"), "key=value texts or a mapping"),  # type: ignore[arg-type]
    (lambda: crowdbot.simulate(short(), seed=1.5), "seed must be a whole number"),  # type: ignore[arg-type]
    (lambda: crowdbot.simulate(short(), seed="a"), "not a str"),  # type: ignore[arg-type]
    (lambda: crowdbot.simulate(short(), out=3), "out must be a path, not an int"),  # type: ignore[arg-type]
    (lambda: crowdbot.simulate(short(), suite=3), "suite must be a str"),  # type: ignore[arg-type]
    (lambda: crowdbot.simulate(short(), metrics=[3]), "list of str; an int is in it"),  # type: ignore[list-item]
    (lambda: crowdbot.simulate(short(), step_budget="1"), "step_budget must be a number"),  # type: ignore[arg-type]
    (lambda: crowdbot.simulate(short(), planner_memory="4"), "a number in GiB, not a str"),  # type: ignore[arg-type]
    (lambda: crowdbot.simulate(short(), planner_memory=-1), "must be positive"),
    (lambda: crowdbot.simulate(short(), planner_memory=float("nan")), "not nan"),
    (lambda: crowdbot.simulate(short(), in_process="yes"), "in_process must be a bool"),  # type: ignore[arg-type]
    (lambda: crowdbot.simulate(short(), progress="yes"), "progress must be a function"),  # type: ignore[arg-type]
    (lambda: crowdbot.simulate(short(), stop=None), "stop must be a function, not None"),  # type: ignore[arg-type]
    (lambda: crowdbot.simulate(short(), planner_settings=3), "key=value texts"),  # type: ignore[arg-type]
    (lambda: crowdbot.score(driven(), metrics=3), "metrics must be a str or a list"),  # type: ignore[arg-type]
    (lambda: crowdbot.score(driven(), variants=[3]), "variants must be a list of str"),  # type: ignore[list-item]
    (lambda: crowdbot.score(driven(), parameters=3), "parameters must be a mapping"),  # type: ignore[arg-type]
    (lambda: crowdbot.score(driven(), parameters={"risk": 3}), "parameters of risk"),  # type: ignore[dict-item]
    (lambda: crowdbot.score(driven(), metrics="success").find(3), "metric must be a str"),  # type: ignore[arg-type]
    (lambda: crowdbot.Run.open(None), "directory must be a path, not None"),  # type: ignore[arg-type]
    (lambda: crowdbot.Results.open(b"runs"), "root must be a path, not a bytes"),  # type: ignore[arg-type]
    (lambda: crowdbot.Session(short(), sensors=3), "sensors must be a str or a list"),  # type: ignore[arg-type]
    (lambda: crowdbot.Session(short(), recording=3), "recording must be a path"),  # type: ignore[arg-type]
    (lambda: crowdbot.Session(short(), recording=ROOT), "this is a folder"),
    (lambda: crowdbot.Session(short(), registry=3), "registry must be a Registry"),  # type: ignore[arg-type]
]  # fmt: skip


@pytest.mark.parametrize(("call", "message"), CALLS, ids=[m for _, m in CALLS])
def test_what_is_wrong_is_our_error(call: Callable[[], object], message: str) -> None:
    with pytest.raises(crowdbot.CrowdbotError, match=re.escape(message)):
        call()


def test_a_planner_is_given_in_many_ways() -> None:
    registry = discover()

    def choose(given: Any) -> PlannerChoice:
        return choose_planner(given, registry)

    dwa = choose("dwa")
    assert choose(DwaSpec()).spec_dump == dwa.spec_dump
    assert choose_planner(DwaSpec(), registry, {"horizon": 2.25}).label.startswith("dwa+")
    file = ROOT / "docs" / "tutorial" / "files" / "my_planner.py"
    by_path = choose(Path(f"{file}:MyPlanner"))
    assert by_path.needs == ("lidar",)
    assert choose(Creep).label == "Creep"
    assert choose_planner(Creep, registry, {"v": 0.3}).label.startswith("Creep+")
    assert choose_planner(Creep, registry, ["v=0.3"]).spec_dump["parameters"] == {"v": 0.3}
    one = Creep()
    assert choose(one).build() is one
    assert not choose(one).repeatable
    assert choose(Creep(0.1)).spec_dump == choose(Creep(0.1)).spec_dump
    assert choose(Creep(0.1)).spec_dump != choose(Creep(0.2)).spec_dump
    assert choose(lambda obs: Command(0.1 * obs.t, 0.0)).name == "function"


@pytest.mark.slow
def test_class_object_and_function_drive_alike(tmp_path: Path) -> None:
    def ahead(obs: Observation) -> tuple[float, float]:
        assert obs.t >= 0.0
        return 0.1, 0.0

    creep, values = Creep(), list[Any]()
    options: dict[str, Any] = {"references": False, "replay": False, "metrics": "success"}
    by_class = crowdbot.simulate(short(), planner=Creep, out=tmp_path, **options)
    by_object = crowdbot.simulate(
        short(), planner=creep, out=tmp_path, progress=values.append, **options
    )
    by_function = crowdbot.simulate(short(), planner=ahead, out=tmp_path, **options)
    hashes = {r.record.hashes.trajectory for r in (by_class, by_object, by_function)}
    assert len(hashes) == 1
    assert creep.seen[:2] == [0.0, 0.0625]
    assert values[-1].t == 1.0
    again = crowdbot.simulate(short(), planner=creep, out=tmp_path, **options)
    assert not again.reused
    assert crowdbot.simulate(short(), planner=Creep, out=tmp_path, **options).directory
    assert by_function.planner == "ahead"

    scores = crowdbot.evaluate(by_function.directory, "success")
    frame = scores.to_pandas()
    assert set(frame["scenario"]) == {by_function.scenario}
    assert set(frame["planner"]) == {"ahead"}
    assert set(frame["seed"]) == {0}
    assert {"variant", "metric", "value", "status"} <= set(frame.columns)
    assert frame["value"].dtype == "float64"
    assert scores.to_arrow().to_pylist()[0]["value"] == 0.0
    assert scores.find("success") == by_function.scores.find("success")
    assert "<td>success</td>" in scores._repr_html_()
    assert "success" in scores[:1]._repr_html_()
    assert "timeout" in by_function._repr_html_()

    found = crowdbot.Results.open(tmp_path)
    table = found.to_pandas()
    assert set(table["planner"]) == {"Creep", "ahead"}
    assert {"suite", "scenario", "planner", "seed", "metric", "variant", "value"} <= set(table)
    assert len(found.to_pandas("runs")) == 2
    assert found.to_arrow("runs").num_rows == 2


def test_no_results_are_an_empty_frame(tmp_path: Path) -> None:
    frame = crowdbot.Results.open(tmp_path).to_pandas()
    assert len(frame) == 0
    assert "planner" in frame


def test_a_scenario_draws_itself() -> None:
    drawing = short()._repr_html_()
    assert drawing is not None
    assert drawing.startswith("<svg")
    assert short().id in drawing


def test_a_run_shows_its_replay(tmp_path: Path) -> None:
    made_up_record(scenario="a", planner="dwa", seed=1).write(tmp_path)
    run = crowdbot.Run.open(tmp_path)
    assert run._repr_html_() == "<p>a · dwa · seed 1: arrived</p>"
    (tmp_path / "replay.html").write_text('<p class="x">&amp;</p>')
    assert 'srcdoc="&lt;p class=&quot;x&quot;&gt;&amp;amp;&lt;/p&gt;"' in run._repr_html_()
