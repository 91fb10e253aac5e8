"""A recording is built once: environment, robot and each sensor."""

from __future__ import annotations

from collections import Counter
from pathlib import Path
from typing import Any

import pytest

from crowdbot.api import registry
from crowdbot.core.planning.resolve import resolve_planner
from crowdbot.core.sim.built_run import build_run
from crowdbot.core.sim.simulate import simulate
from crowdbot.dsl.component_specs import EnvironmentSpec, RobotSpec, SensorSpec
from crowdbot.dsl.scenario import Scenario
from crowdbot.errors import InputError
from tests.core.sim.sim_worlds import scenario

SHORT = "robots.robot.task.time_limit=0.25"


class Counting:
    """The registry, counting what is built of it."""

    def __init__(self) -> None:
        self.built: Counter[str] = Counter()

    def build(self, spec: Any, *more: Any, **options: Any) -> Any:
        if isinstance(spec, EnvironmentSpec | RobotSpec | SensorSpec):
            self.built[f"{spec.category} {spec.kind}"] += 1
        return registry().build(spec, *more, **options)

    def __getattr__(self, name: str) -> Any:
        return getattr(registry(), name)


def counted(
    world: Scenario, out: Path, record: str, *, references: bool
) -> tuple[Counter[str], Counter[str]]:
    """How often each kind was built by a run, and how often the scenario names it."""
    counting = Counting()
    simulate(
        world, counting, planner="goal_seek", out=out, record=record,  # type: ignore[arg-type]
        references=references, replay=False,
    )  # fmt: skip
    robot = world.robots["robot"]
    named = [world.environment, robot.model, *robot.sensors.values()]
    return counting.built, Counter(f"{spec.category} {spec.kind}" for spec in named)


@pytest.mark.slow
@pytest.mark.parametrize("record", ["all", "used", "none"])
def test_one_recording_is_built_once(tmp_path: Path, record: str) -> None:
    built, named = counted(scenario(SHORT), tmp_path, record, references=False)
    assert built == named


@pytest.mark.slow
def test_calibration_runs_are_recordings_of_their_own(tmp_path: Path) -> None:
    world = scenario(SHORT)
    built, named = counted(world, tmp_path, "used", references=True)
    place = f"environment {world.environment.kind}"
    assert built.pop(place) == 3  # the run, the robot alone, the people alone
    assert built == Counter({kind: 2 * n for kind, n in named.items() if kind != place})


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
