"""The named policies: each loads by its packaged path, and people walk by it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from crowdbot.core.crowd import Agents, CrowdEngine, CrowdWorld
from crowdbot.core.crowd import state as s
from crowdbot.core.crowd.build import build_cost, build_policy
from crowdbot.core.environments.build import build_environment
from crowdbot.core.population.realise import realise
from crowdbot.core.registry.registry import Registry, discover
from crowdbot.core.scenarios.library import open_spec, pick
from crowdbot.core.sim.build_crowd import build_crowd
from crowdbot.dsl.scenario.scenario import Scenario
from tests.core.crowd.crowd_reference import Array
from tests.core.crowd.crowd_worlds import TICKS, rows
from tests.paths import ROOT

PARTS = ROOT / "scenario_specs" / "parts" / "crowds"
NAMES = sorted(p.stem for p in PARTS.glob("*.yaml"))
SUITE = """
crowdbot: 1
suite: {{id: small, title: A small corridor}}
base:
  extends: [builtin:parts/crowds/{name}.yaml]
  environment:
    kind: corridor
    length: 12 m
    width: 4 m
    zones:
      crowd: {{x: [1 m, 11 m], y: [-2 m, 2 m]}}
    portals:
      a: {{x: [-1 m, 0 m], y: [-2 m, 2 m]}}
      b: {{x: [12 m, 13 m], y: [-2 m, 2 m]}}
  robots: {{}}
  crowd:
    flow: {{direction: in, density: 0.25 1/m^2, area: crowd}}
    speed: {{mean: 1.3 m/s, std: 0.1 m/s}}
    body: {{radius: 0.25 m}}
"""


def load(name: str, folder: Path, registry: Registry) -> Scenario:
    file = folder / "small.yaml"
    file.write_text(SUITE.format(name=name))
    return pick(open_spec(str(file), registry), None)


def test_the_catalogue_is_complete() -> None:
    assert set(NAMES) == {
        "dutra", "rvo", "orca", "social_forces", "karamouzas", "moussaid", "pledestrians", "paris",
        "power_law", "van_toll", "foe_avoidance", "demo_0", "demo_1", "demo_2",
        "challenge_2020", "calibrated", "social_forces_corrected", "orca_corrected",
    }  # fmt: skip


@pytest.mark.parametrize("name", NAMES)
def test_people_walk_through_a_corridor(name: str, tmp_path: Path) -> None:
    registry = discover()
    scenario = load(name, tmp_path, registry)
    engine = build_crowd(
        scenario, realise(scenario), build_environment(registry, scenario.environment), registry
    )  # fmt: skip
    assert engine is not None
    flat = engine.initial_state()
    for _ in range(15 * TICKS):
        engine.advance(flat)
        assert np.isfinite(flat).all()
        present = rows(flat)[rows(flat)[:, s.WAITING] == 0.0]
        assert np.all(np.abs(present[:, s.Y]) < 2.0), "through a wall"
    print(f"{name}: {len(rows(flat))} people, {flat[s.TRIPS]:g} trips in 15 s")
    assert flat[s.TRIPS] >= len(rows(flat)) / 2


@pytest.mark.parametrize("name", NAMES)
def test_people_pass_pillars_walls_and_each_other(name: str, tmp_path: Path) -> None:
    """Four against four, a pillar and the end of a wall in the way."""
    registry = discover()
    crowd = load(name, tmp_path, registry).crowd
    assert crowd is not None
    costs = [build_cost(registry, c) for c in crowd.costs.values()]
    y = np.array([-1.55, -0.55, 0.45, 1.45])
    x, starts = np.repeat([-6.0, 6.0], 4), np.concatenate([y, y + 0.1])
    agents = Agents.of(
        x=x, y=starts, radius=0.25, max_speed=1.8, preferred_speed=np.linspace(1.1, 1.4, 8),
        routes=[[(-a, b)] for a, b in zip(x, starts, strict=True)],
    )  # fmt: skip
    walls = np.array([[-9.0, -3.0, 9.0, -3.0], [9.0, 3.0, -9.0, 3.0], [2.5, 3.0, 2.5, 1.9]])
    pillar = np.array([[-1.0, -0.3, 0.3]])
    engine = CrowdEngine(
        agents, CrowdWorld(walls=walls, pillars=pillar),
        lambda a: build_policy(registry, crowd.policy, costs, a),
    )  # fmt: skip
    _, place = engine.run(40.0)
    assert np.isfinite(place).all()
    assert np.abs(place[:, :, 1]).max() < 3.0, "through a wall"
    assert not _crosses(place, 2.5, 1.9), "through the wall in between"
    assert np.hypot(place[..., 0] + 1.0, place[..., 1] + 0.3).min() > 0.3, "through the pillar"
    left = np.hypot(place[-1, :, 0] + x, place[-1, :, 1] - starts)
    print(f"{name}: {np.sum(left < 0.5)} of 8 arrived; left {np.round(left, 1)}")
    assert np.sum(left < 0.5) >= 5


def _crosses(place: Array, x: float, y: float) -> bool:
    """Whether a path crosses the wall from (x, y) upwards."""
    before, after = place[:-1], place[1:]
    over = (before[..., 0] - x) * (after[..., 0] - x) < 0.0
    return bool(np.any(over & (0.5 * (before[..., 1] + after[..., 1]) > y)))
