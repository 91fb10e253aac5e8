"""Numbers of the view in three dimensions: heights, bodies, cameras."""

from __future__ import annotations

import json

import numpy as np
import pytest
from pydantic import ValidationError

from crowdbot.core.environments.build import build_environment
from crowdbot.core.registry.registry import discover
from crowdbot.core.robots.build import build_robot
from crowdbot.core.runs.solids import SolidPeople, solid_people, solids_of
from crowdbot.core.scenarios.library import open_spec, pick
from crowdbot.core.scenarios.lock import population
from crowdbot.core.types.sensor import Pinhole, SensorInfo
from crowdbot.dsl.spec.component_specs import SceneLight
from tests.paths import DATA


def test_what_stands_and_who_walks_has_its_height() -> None:
    registry = discover()
    scenario = pick(open_spec(str(DATA / "short_way.yaml"), registry), None)
    parts = build_environment(registry, scenario.environment)
    model = build_robot(registry, scenario.robots["robot"])
    camera = SensorInfo(
        category="camera", frame="eye", mount=(0.1, 0.0, 1.0, 0.0), rate=8.0, shape=(240, 320),
        ros_type="sensor_msgs/msg/Image", camera=Pinhole(width=320, height=240, focal=120.0),
        tilt=(0.0, 0.2),
    )  # fmt: skip
    agents = population(scenario, registry).agents
    found = solids_of(parts, {"robot": (model, {"eye": camera})}, solid_people(scenario, agents))
    json.dumps(found, allow_nan=False)
    assert found["people"] == {"height": [1.7], "look": []}
    (robot,) = found["robots"]
    assert robot["height"] == model.height
    assert robot["cameras"][0]["opening"] == round(2.0 * np.arctan(1.0), 4)
    assert robot["cameras"][0]["tilt"] == [0.0, 0.2]
    assert all(len(corners) >= 8 for _, corners in robot["parts"])
    walls = np.array(found["walls"])
    assert (walls[:, 5] > walls[:, 4]).all()
    assert set(walls[:, 6]) == {1.0, 3.0}  # the ends of the corridor stop robots only


def test_people_who_differ_are_told_one_by_one() -> None:
    registry = discover()
    scenario = pick(open_spec(str(DATA / "short_way.yaml"), registry), None)
    parts = build_environment(registry, scenario.environment)
    people = SolidPeople(height=np.array([1.7, 1.2]), look=("", "child"))
    found = solids_of(parts, {}, people)
    assert found["people"] == {"height": [1.7, 1.2], "look": ["", "child"]}
    assert solids_of(parts, {}, None)["people"] is None


def test_light_is_told_where_a_scenario_has_it_and_changes_no_hash_where_not() -> None:
    registry = discover()
    scenario = pick(open_spec(str(DATA / "short_way.yaml"), registry), None)
    assert "light" not in scenario.environment.model_dump(mode="json")
    assert "light" not in solids_of(build_environment(registry, scenario.environment), {}, None)
    dusk = SceneLight(elevation=0.0, azimuth=np.pi / 2, sun=0.5, colour="#ff8800")
    lit = scenario.environment.model_copy(update={"light": dusk})
    assert lit.model_dump(mode="json")["light"]["sun"] == 0.5
    light = solids_of(build_environment(registry, lit), {}, None)["light"]
    assert light["towards"] == [0.0, 1.0, 0.0]
    assert (light["sun"], light["ambient"], light["colour"]) == (0.5, 1.0, "#ff8800")
    with pytest.raises(ValidationError, match="pattern"):
        SceneLight(sky="blue")
