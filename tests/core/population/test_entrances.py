"""Who arrives or comes back is never put into a wall, a block or a pillar."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from crowdbot.core.crowd import state as s
from crowdbot.core.environments.build import build_environment
from crowdbot.core.population.realise import realise
from crowdbot.core.registry.registry import discover
from crowdbot.core.scenarios.library import open_spec, pick
from crowdbot.core.sim.build_crowd import build_crowd
from crowdbot.dsl.scenario.scenario import Scenario
from crowdbot.errors import InputError, SpecError

REGISTRY = discover(allow=())
TEXT = """
crowdbot: 1
scenario:
  id: x
  environment:
    kind: floor
    area: {{x: [0 m, 20 m], y: [0 m, 10 m]}}
    walls: {{across: {{start: [0 m, 7 m], end: [5 m, 7 m], thickness: 0.2 m}}}}
    blocks: {{kiosk: {{corners: [[1, 1], [4, 1], [4, 5], [1, 5]]}}}}
    pillars: {{p: {{x: 4.5, y: 8.5, radius: 0.4}}}}
    zones:
      west: {{x: [0 m, 6 m], y: [0 m, 10 m]}}
      east: {{x: [16 m, 20 m], y: [0 m, 10 m]}}
      within: {{x: [1.2 m, 3.8 m], y: [1.2 m, 4.8 m]}}
  crowd:
    speed: {{mean: 3 m/s, std: 0.1 m/s}}
    body: {{radius: 0.25 m, max_speed: 4 m/s}}
    policy: {{kind: velocity_space}}
    costs: {{goal: {{kind: goal_reaching_force}}}}
    goal_areas: {{east: {{area: east}}}}
    streams:
      {stream}
"""
ARRIVE = (
    "some: {kind: through, origin: %s, destination: east, arrivals: {every: 0.25 s, until: 8 s}}"
)
RETURN = (
    "some: {kind: through, origin: west, start: {centre: [13 m, 5 m], size: [4 m, 8 m]}, "
    "destination: east, count: 12}"
)
STROLL = (
    "some: {kind: wandering, area: %s, areas: [east], visits: 1, "
    "pause: {value: 1 s, spread: 0.5 s}, arrivals: {every: 0.5 s, until: 6 s}}"
)


def _scenario(tmp_path: Path, stream: str) -> Scenario:
    path = tmp_path / "x.yaml"
    path.write_text(TEXT.format(stream=stream))
    return pick(open_spec(str(path), REGISTRY), None)


@pytest.mark.parametrize("stream", [ARRIVE % "west", RETURN, STROLL % "west"])
def test_nobody_comes_in_inside_of_something(tmp_path: Path, stream: str) -> None:
    scenario = _scenario(tmp_path, stream)
    parts = build_environment(REGISTRY, scenario.environment)
    place = scenario.environment.place()
    assert place is not None
    people = realise(scenario, parts)
    for x, y in zip(people.x.tolist(), people.y.tolist(), strict=True):
        assert place.clearance(x, y) > 0.25 - 1e-5
    engine = build_crowd(scenario, people, parts, REGISTRY)
    assert engine is not None
    flat = engine.initial_state()
    _, rows = s.view(flat)
    came = 0
    for _ in range(10 * 128):
        outside, jumps = rows[:, s.WAITING] != s.PRESENT, rows[:, s.JUMPS].copy()
        engine.advance(flat)
        here = rows[:, s.WAITING] == s.PRESENT
        for i in np.flatnonzero(here & (outside | (rows[:, s.JUMPS] > jumps))):
            came += 1
            assert place.clearance(rows[i, s.X], rows[i, s.Y]) > 0.25 - 1e-5
    assert came >= 8


@pytest.mark.parametrize("stream", [ARRIVE % "within", STROLL % "within"])
def test_an_entrance_in_a_wall_is_refused(tmp_path: Path, stream: str) -> None:
    with pytest.raises(SpecError) as caught:
        _scenario(tmp_path, stream)
    (found,) = caught.value.diagnostics
    assert found.code == "E143"
    assert found.message == "people of stream 'some' cannot come in around (2.5, 3)"
    assert (found.mark.line, found.mark.column) == (21, 36)


def test_an_entrance_in_a_wall_is_refused_when_people_are_placed(tmp_path: Path) -> None:
    scenario = _scenario(tmp_path, ARRIVE % "west")
    parts = build_environment(REGISTRY, scenario.environment)
    assert scenario.crowd is not None
    streams = {"some": scenario.crowd.streams["some"].model_copy(update={"origin": "within"})}
    crowd = scenario.crowd.model_copy(update={"streams": streams})
    with pytest.raises(InputError, match="people cannot come in at the origin of stream 'some'"):
        realise(scenario.model_copy(update={"crowd": crowd}), parts)
