"""People are put on free ground, and sent where a way leads."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from crowdbot.core.environments.build import build_environment
from crowdbot.core.population.ground import Ground
from crowdbot.core.population.realise import realise
from crowdbot.core.registry.registry import discover
from crowdbot.core.scenarios.library import open_spec, pick
from crowdbot.dsl.scenario.scenario import Scenario
from crowdbot.errors import InputError

REGISTRY = discover(allow=())
TEXT = """
crowdbot: 1
scenario:
  id: x
  environment:
    kind: floor
    area: {{x: [0 m, 20 m], y: [0 m, 10 m]}}
    walls: {{across: {{start: [10 m, 0 m], end: [10 m, {end} m], thickness: 0.3 m}}}}
    blocks: {{kiosk: {{corners: [[3, 3], [7, 3], [7, 7], [3, 7]]}}}}
    pillars: {{p: {{x: 2, y: 2, radius: 0.5}}}}
    zones: {{left: {{x: [0 m, 10 m], y: [0 m, 10 m]}}, right: {{x: [10 m, 20 m], y: [0 m, 10 m]}}}}
  crowd:
    speed: {{mean: 1 m/s, std: 0.1 m/s}}
    body.radius: 0.25 m
    policy: {{kind: velocity_space}}
    costs: {{avoid: {{kind: ttca_dca}}}}
    routing: {{kind: {routing}}}
    goal_areas: {{all: {{area: {goals}}}}}
    spawns: {{some: {{area: left, count: 60, goals: {{areas: [all]}}}}}}
"""


def _scenario(tmp_path: Path, end: float, routing: str = "mesh", goals: str = "left") -> Scenario:
    path = tmp_path / "x.yaml"
    path.write_text(TEXT.format(end=end, routing=routing, goals=goals))
    return pick(open_spec(str(path), REGISTRY), None)


def test_nobody_stands_or_is_sent_into_something_solid(tmp_path: Path) -> None:
    scenario = _scenario(tmp_path, 8.0)
    parts = build_environment(REGISTRY, scenario.environment)
    place = scenario.environment.place()
    assert place is not None
    people = realise(scenario, parts)
    goals = [route[0] for route in people.goals]
    for x, y in [*zip(people.x.tolist(), people.y.tolist(), strict=True), *goals]:
        assert place.clearance(x, y) > 0.25 - 1e-5
    anywhere = realise(scenario)  # who does not know the place
    assert min(place.clearance(*at) for at in zip(anywhere.x, anywhere.y, strict=True)) < 0.0


def test_goals_are_drawn_until_a_way_leads_there(tmp_path: Path) -> None:
    area = "{centre: [10 m, 5 m], size: [16 m, 8 m]}"
    scenario = _scenario(tmp_path, 10.0, goals=area)
    people = realise(scenario, build_environment(REGISTRY, scenario.environment))
    assert max(route[0][0] for route in people.goals) < 10.0
    straight = _scenario(tmp_path, 10.0, routing="straight", goals=area)
    people = realise(straight, build_environment(REGISTRY, straight.environment))
    assert max(route[0][0] for route in people.goals) > 11.0


def test_a_gap_that_validate_takes_for_a_way_is_found_when_people_are_drawn(tmp_path: Path) -> None:
    scenario = _scenario(tmp_path, 9.52, goals="right")  # 0.48 m wide, for bodies of 0.5 m
    with pytest.raises(InputError, match=r"goal area 'all' around \(15, 5\) has no free place"):
        realise(scenario, build_environment(REGISTRY, scenario.environment))


def test_who_stands_close_to_a_corner_has_a_way(tmp_path: Path) -> None:
    """The margin of a corner is cut straight, a little wider than a body is round."""
    scenario = _scenario(tmp_path, 10.0)
    assert scenario.crowd is not None
    ground = Ground(build_environment(REGISTRY, scenario.environment), scenario.crowd)
    start = (2.815, 2.815)
    assert ground.is_free(*start, 0.25)
    assert ground.reaches(start, (9.0, 1.0), 0.25)
    assert not ground.reaches(start, (11.0, 1.0), 0.25)
    assert not ground.reaches((2.9, 2.9), (9.0, 1.0), 0.25)  # within the block's reach


def test_an_empty_ground_is_free_everywhere() -> None:
    ground = Ground()
    assert ground.is_free(0.0, 0.0, 1.0)
    assert ground.reaches((0.0, 0.0), (9.0, 9.0), 1.0)
    ground.check_route("who", (0.0, 0.0), [(1.0, 1.0)], 0.3)


def test_where_zones_end_at_walls_nothing_changes() -> None:
    scenario = pick(open_spec("challenge-2020", REGISTRY), "in-d0500-slow-c20-r05")
    parts = build_environment(REGISTRY, scenario.environment)
    one, two = realise(scenario), realise(scenario, parts)
    assert np.array_equal(one.x, two.x)
    assert one.hash == two.hash
