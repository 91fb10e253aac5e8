"""The scenario files that come with the package drive a robot among their people."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from crowdbot import cli
from crowdbot.core.crowd import CrowdEngine
from crowdbot.core.crowd import state as s
from crowdbot.core.environments.build import build_environment
from crowdbot.core.population.realise import realise
from crowdbot.core.recording.recording import Recording
from crowdbot.core.registry.registry import discover
from crowdbot.core.scenarios.library import open_spec, pick
from crowdbot.core.sim.build_crowd import build_crowd
from crowdbot.plugin import EnvironmentParts
from tests.built_in import built_in
from tests.core.crowd.routing.floor_plans import crossings
from tests.paths import ROOT

EXAMPLES = ROOT / "scenario_specs" / "examples"


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "which", "people"),
    [
        ("explicit_agents", [], 7),
        ("cafe_crossing", [], 36),
        ("bidirectional_corridor", ["half"], 100),
    ],
)
def test_an_example_runs(name: str, which: list[str], people: int, tmp_path: Path) -> None:
    argv = [
        "simulate", str(EXAMPLES / f"{name}.yaml"), *which, "--planner", "goal_seek",
        "--no-references", "--set", "robots.robot.task.time_limit=3", "--out", str(tmp_path),
    ]  # fmt: skip
    assert cli.main(argv) == 0
    (file,) = tmp_path.glob("**/run.json")
    record = json.loads(file.read_text())
    assert (record["status"], record["sim_time"]) == ("timeout", 3.0)
    tracks = Recording(file.parent / "run.mcap").trajectories()
    assert tracks.agents is not None
    at = np.stack([tracks.agents.x, tracks.agents.y], axis=-1)
    here = np.isfinite(at[..., 0])
    assert at.shape[1] == people
    assert np.count_nonzero(here[0]) >= 6  # others come later
    assert np.all(np.isfinite(at[here]))
    moved = np.hypot(*(at[-1] - at[0])[here[0] & here[-1]].T)
    assert np.max(moved) > 2.0  # in 3 s at 1 m/s or more
    assert np.max(moved) < 9.0


WORLDS = sorted(path.stem for path in EXAMPLES.glob("world_*.yaml"))


def _engine(name: str) -> tuple[CrowdEngine, EnvironmentParts]:
    registry = discover(allow=())
    scenario = pick(open_spec(str(EXAMPLES / f"{name}.yaml"), registry), None)
    parts = build_environment(registry, scenario.environment)
    engine = build_crowd(scenario, realise(scenario, parts), parts, registry)
    assert engine is not None
    return engine, parts


def test_every_world_has_an_example() -> None:
    kinds = {f"world_{c.kind}" for c in built_in("environment")}
    assert set(WORLDS) == kinds | {"world_floor_plan_grid", "world_floor_plan_wkt"}
    pictures = ROOT / "docs" / "images" / "worlds"
    assert {file.stem for file in pictures.glob("*.svg")} == set(WORLDS)


@pytest.mark.slow
@pytest.mark.parametrize("name", WORLDS)
def test_people_walk_in_every_world(name: str) -> None:
    """For some seconds: nobody goes through a wall, all are somewhere, and most get on."""
    engine, _ = _engine(name)
    walls = engine.world.walls
    flat = engine.initial_state()
    _, rows = s.view(flat)
    before = rows[:, [s.X, s.Y]].copy()
    start = before.copy()
    for tick in range(3 * 128):
        engine.advance(flat)
        if tick % 8 == 0:
            after = rows[:, [s.X, s.Y]].copy()
            here = (rows[:, s.WAITING] == s.PRESENT) & (rows[:, s.JUMPS] == 0.0)
            assert crossings(walls, before[here], after[here]) == 0
            before = after
    assert np.all(np.isfinite(rows[:, [s.X, s.Y]]))
    moved = np.hypot(*(rows[:, [s.X, s.Y]] - start).T)
    assert np.median(moved) > 1.5  # in 3 s at about 1.3 m/s
