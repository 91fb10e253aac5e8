"""Where a robot may start, and that its outline gets into the recording."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from crowdbot.core.environments.build import build_environment
from crowdbot.core.geometry.footprint import footprint_of_model
from crowdbot.core.planning.resolve import resolve_planner
from crowdbot.core.recording.recording import Recording
from crowdbot.core.robots.build import build_model
from crowdbot.core.robots.check import check_model
from crowdbot.core.runs.run_options import RunOptions
from crowdbot.core.scenarios.lock import population
from crowdbot.core.sim.built_run import BuiltRun, build_runs
from crowdbot.core.sim.contacts.start_pose_check import check_start
from crowdbot.core.sim.record import record_robots
from crowdbot.core.sim.run_setup import RunSetup
from crowdbot.dsl.scenario.scenario import Scenario
from crowdbot.errors import InputError, PluginError
from crowdbot.plugin import EnvironmentParts, Pose, RobotModel
from tests.core.sim.sim_worlds import alone, person, registry, scenario

BOX = np.array([[0.3, -0.2], [0.3, 0.2], [-0.3, 0.2], [-0.3, -0.2]])
AXIS = np.array([[-0.3, 0.0], [0.3, 0.0]])


def _parts(world: Scenario | None = None) -> EnvironmentParts:
    parts: EnvironmentParts = build_environment(registry(), (world or alone()).environment)
    return parts


def _model(**changes: Any) -> RobotModel:
    (robot,) = alone().robots.values()
    model: RobotModel = replace(build_model(registry(), robot.model), **changes)
    return model


@pytest.mark.parametrize(
    ("body", "side"), [({}, 0.178), ({"footprint": AXIS}, 0.178), ({"footprint": BOX}, 0.2)]
)
def test_a_robot_beside_a_wall(body: dict[str, Any], side: float) -> None:
    """The corridor's wall is at y = 5 m; a micrometre decides."""
    model = _model(**body)
    check_start(_parts(), model, Pose(25.0, 5.0 - side - 1e-5, 0.0), None, "r")
    for y in (5.0 - side + 1e-4, 4.99):
        with pytest.raises(InputError, match=r"robot 'r' at x 25 m.* in a wall or an obstacle"):
            check_start(_parts(), model, Pose(25.0, y, 0.0), None, "r")


@pytest.mark.parametrize(("yaw", "fits"), [(0.0, True), (0.5 * math.pi, False)])
def test_the_heading_of_an_outline_decides(yaw: float, fits: bool) -> None:
    start = Pose(25.0, 4.75, yaw)
    if fits:
        check_start(_parts(), _model(footprint=BOX), start, None, "r")
    else:
        with pytest.raises(InputError, match="in a wall"):
            check_start(_parts(), _model(footprint=BOX), start, None, "r")


def test_inside_a_solid_and_on_a_pillar() -> None:
    """Far from the sides of a block, but in it."""
    outline = np.array([[20.0, -2.0], [30.0, -2.0], [30.0, 2.0], [20.0, 2.0]])
    block = replace(_parts(), solids=(outline,), solid_heights=np.array([[0.0, 1.0]]))
    pillar = replace(
        _parts(), pillars=np.array([[25.0, 0.0, 2.0]]), pillar_heights=np.array([[0.0, 1.0]])
    )
    for parts in (block, pillar):
        with pytest.raises(InputError, match="in a wall or an obstacle"):
            check_start(parts, _model(), Pose(25.0, 0.0, 0.0), None, "r")
    shelf = replace(block, solid_heights=np.array([[0.6, 1.0]]))
    check_start(shelf, _model(), Pose(25.0, 0.0, 0.0), None, "r")  # 0.42 m high, drives under


def test_a_robot_on_a_person() -> None:
    start = Pose(10.0, 0.0, 0.0)
    near = person(10.0 + 0.3 + 0.33 - 1e-3)
    check_start(_parts(), _model(), start, near, "r")
    with pytest.raises(InputError, match=r"in agent 0, who stands at x 10\.629 m"):
        check_start(_parts(), _model(footprint=BOX), start, near, "r")
    check_start(_parts(), _model(footprint=BOX), start, person(10.0 + 0.3 + 0.33), "r")


@pytest.mark.slow
@pytest.mark.parametrize(
    "outline",
    [
        np.zeros(2),
        np.zeros((1, 2)),
        [[0, 0], [1, 0], [0.1, 0.1], [0, 1]],
        [[0, 0], [1, 0], [2, 0]],
        [[0, 0], [2, 0], [1, 0]],
        [[0, 0], [0, 0], [0, 0]],
        [[0, 0], [1, 1], [1, 0], [0, 1]],
        [[math.cos(2.0 * a), math.sin(2.0 * a)] for a in np.arange(5) * math.tau / 5],
        [[0, 0], [1, 0], [math.nan, 1]],
        [[0, 0], [math.inf, 0]],
    ],
)
def test_outlines_that_are_none(outline: Any) -> None:
    with pytest.raises(ValueError, match="footprint"):
        footprint_of_model(_model(footprint=np.array(outline, np.float64)))
    with pytest.raises(PluginError, match="footprint"):
        check_model(_model(footprint=np.array(outline, np.float64)))


def test_outlines_are_put_in_order() -> None:
    body = footprint_of_model(_model(footprint=BOX[::-1]))
    x, y = body.corners.T
    assert np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y) > 0.0
    assert body.radius == 0.0
    assert body.reach == pytest.approx(math.hypot(0.3, 0.2))
    capsule = footprint_of_model(_model(footprint=AXIS))
    assert capsule.reach == pytest.approx(0.478)
    around = capsule.outline(1.0, 2.0, 0.5 * math.pi)
    gap = capsule.gap(around[:, 1] - 2.0, -(around[:, 0] - 1.0))
    assert gap == pytest.approx(np.zeros(len(around)), abs=1e-9)
    assert footprint_of_model(_model()).outline(0.0, 0.0, 0.0).shape == (0, 2)


class _Outlined:
    """The registry, with another body for robots."""

    def __init__(self, outline: np.ndarray[Any, Any]) -> None:
        self._outline = outline

    def build(self, spec: Any, *more: Any, **options: Any) -> Any:
        built = registry().build(spec, *more, **options)
        return replace(built, footprint=self._outline) if isinstance(built, RobotModel) else built

    def __getattr__(self, name: str) -> Any:
        return getattr(registry(), name)


def _built(setup: RunSetup) -> dict[str, BuiltRun]:
    return build_runs(setup.scenario, setup.registry, setup.choice, setup.options.record)


@pytest.mark.slow
def test_the_outline_is_recorded(tmp_path: Path) -> None:
    world = scenario("robots.robot.task.time_limit=0.25")
    setup = RunSetup(
        scenario=world, agents=population(world, registry()).agents,
        registry=_Outlined(BOX), choice=resolve_planner("goal_seek", registry(), ()),  # type: ignore[arg-type]
        seed=0, recording=tmp_path / "run.mcap", options=RunOptions(record="none"),
        stage="run", progress=None,
        stop=lambda: False, on_hang=None,
    )  # fmt: skip
    record_robots(setup, _built(setup))
    run = Recording(tmp_path / "run.mcap").trajectories()
    assert run.robot_footprint is not None
    assert run.robot_footprint.tolist() == BOX.tolist()
    blocked = world.model_copy(deep=True)
    blocked.robots["robot"].task.__dict__["start"] = (2.5, 4.9, 0.0)
    again = replace(setup, scenario=blocked, recording=tmp_path / "b.mcap")
    with pytest.raises(InputError, match="in a wall"):
        record_robots(again, _built(again))
    assert not (tmp_path / "b.mcap").exists()
