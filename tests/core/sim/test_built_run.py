"""A recording is built once: environment, robot and each sensor."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from crowdbot.api import registry
from crowdbot.core.live.serve import LiveServe, serve_runs
from crowdbot.core.live.session import LiveSession
from crowdbot.core.live.step_policy import StepPolicy
from crowdbot.core.planning.planner import Observation
from crowdbot.core.planning.resolve import PlannerChoice, resolve_planner
from crowdbot.core.recording.container.records import Record, Records
from crowdbot.core.registry.registry import Registry
from crowdbot.core.runs.run import Request
from crowdbot.core.runs.run_options import Recorded, RunOptions
from crowdbot.core.sim.built_run import build_run
from crowdbot.core.sim.session import Session
from crowdbot.core.sim.simulate import simulate
from crowdbot.core.types.motion import Command
from crowdbot.dsl.scenario.scenario import Scenario
from crowdbot.dsl.spec.component_specs import EnvironmentSpec, RobotSpec, SensorSpec
from crowdbot.errors import InputError
from tests.core.sim.fleets import robot
from tests.core.sim.fleets import scenario as fleet_scenario
from tests.core.sim.sim_worlds import scenario

SHORT = "robots.robot.task.time_limit=0.25"


class Counting(Registry):
    """The registry, counting what is built of it."""

    def __init__(self) -> None:
        vars(self).update(vars(registry()))
        self.built: Counter[str] = Counter()

    def build(self, spec: Any, *more: Any, **options: Any) -> Any:
        if isinstance(spec, EnvironmentSpec | RobotSpec | SensorSpec):
            self.built[f"{spec.category} {spec.kind}"] += 1
        return super().build(spec, *more, **options)


def counted(
    world: Scenario, out: Path, record: Recorded, *, references: bool
) -> tuple[Counter[str], Counter[str]]:
    """How often each kind was built by a run, and how often the scenario names it."""
    counting = Counting()
    simulate(
        world, counting, planner="goal_seek", out=out,
        options=RunOptions(record=record, references=references, replay=False),
    )  # fmt: skip
    one = world.robots["robot"]
    named = [world.environment, one.model, *one.sensors.values()]
    return counting.built, Counter(f"{spec.category} {spec.kind}" for spec in named)


@pytest.mark.slow
@pytest.mark.parametrize("record", ["all", "used", "none"])
def test_one_recording_is_built_once(tmp_path: Path, record: Recorded) -> None:
    built, named = counted(scenario(SHORT), tmp_path, record, references=False)
    assert built == named


class Looker:
    """Stands still and sees."""

    needs = ("camera",)

    def reset(self, *_: Any) -> None:
        """Nothing to do."""

    def step(self, obs: Observation) -> Command:
        assert [reading.values.shape for reading in obs.readings.values()] == [(240, 320)]
        return Command(0.0, 0.0)


@pytest.mark.slow
@pytest.mark.parametrize(("planner", "record"), [("goal_seek", "all"), (Looker(), "used")])
def test_a_recording_with_images_is_read_in_one_pass(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, planner: Any, record: Any
) -> None:
    """For the hash, the scores and the page with its images together."""
    passes: Counter[str] = Counter()

    def counted(records: Records) -> Iterator[Record]:
        passes[records._path.name] += 1
        return once(records)

    once = Records.__iter__
    monkeypatch.setattr(Records, "__iter__", counted)
    world = scenario(SHORT)
    assert any(sensor.kind == "rgbd_camera" for sensor in world.robots["robot"].sensors.values())
    run = simulate(
        world,
        registry(),
        planner=planner,
        out=tmp_path,
        options=RunOptions(references=False, record=record),
    )
    assert passes == {"run.mcap": 1}
    assert "-images0" in (run.directory / "replay.html").read_text(encoding="utf-8")


@pytest.mark.slow
def test_calibration_runs_are_recordings_of_their_own(tmp_path: Path) -> None:
    world = scenario(SHORT)
    built, named = counted(world, tmp_path, "used", references=True)
    place = f"environment {world.environment.kind}"
    assert built.pop(place) == 3  # the run, the robot alone, the people alone
    assert built == Counter({kind: 2 * n for kind, n in named.items() if kind != place})


@pytest.mark.slow
def test_several_robots_share_one_environment(tmp_path: Path) -> None:
    robots = {name: robot(x, 0.0, 0.0, "east", 0.25) for name, x in (("a", -6.0), ("b", 6.0))}
    counting = Counting()
    world = fleet_scenario(tmp_path, registry(), robots)
    simulate(
        world, counting, planner="goal_seek", out=tmp_path, options=RunOptions(replay=False),
    )  # fmt: skip
    assert counting.built == {
        "environment floor": 1, "robot turtlebot2": 2, "sensor lidar2d": 2,
        "sensor wheel_odometry": 2,
    }  # fmt: skip


@pytest.mark.slow
def test_a_session_builds_what_each_of_its_runs_needs() -> None:
    """Its first run takes what the session looked at; another one does not get used sensors."""
    world, counting = scenario(SHORT), Counting()
    with Session(world, sensors=["lidar"], registry=counting) as session:
        session.reset()
        place = f"environment {world.environment.kind}"
        assert counting.built[place] == 1
        once = Counter(counting.built)
        session.reset()
    assert counting.built == {kind: 2 * n for kind, n in once.items()}


@pytest.mark.slow
def test_a_live_run_shows_clients_what_is_simulated(tmp_path: Path) -> None:
    world, counting = scenario(SHORT), Counting()

    def request(scenario: Scenario, choice: PlannerChoice, seed: int) -> Request:
        return Request(
            scenario=scenario, choice=choice, registry=counting,
            seed=seed, out=tmp_path,
            options=RunOptions(references=False, replay=False),
        )  # fmt: skip

    policy = StepPolicy(rate=None, budget=0.001, wait=0.0)
    live = LiveServe(
        session=LiveSession(), connections=(), policy=policy, scenarios=(world,), request=request
    )
    assert serve_runs(live).status == "timeout"
    one = world.robots["robot"]
    named = [world.environment, one.model, *one.sensors.values()]
    assert counting.built == Counter(f"{spec.category} {spec.kind}" for spec in named)


@pytest.mark.slow
@pytest.mark.parametrize("record", ["all", "used", "none"])
def test_sensors_are_those_that_are_simulated(record: Any) -> None:
    world = scenario(SHORT)
    choice = resolve_planner("goal_seek", registry())
    built = build_run(world, registry(), choice, record)
    assert list(built.infos) == list(built.sensors)
    assert set(built.visible) <= set(built.sensors)
    assert any(info.category == "odometry" for info in built.infos.values())
    everything = list(world.robots["robot"].sensors)
    assert (list(built.sensors) == everything) == (record == "all")
    assert all(
        info.frame == name for name, info in built.infos.items() if info.category != "odometry"
    )


@pytest.mark.slow
def test_frames_are_checked_before_anything_is_written(tmp_path: Path) -> None:
    world = scenario(SHORT)
    sensors = world.robots["robot"].sensors
    taken = world.model_copy(deep=True)
    lidar = next(s for n, s in sensors.items() if "lidar" in n)
    taken.robots["robot"].sensors["base_footprint"] = lidar
    with pytest.raises(InputError, match="base_footprint"):
        simulate(taken, registry(), planner="goal_seek", out=tmp_path)
    assert not list(tmp_path.iterdir())
