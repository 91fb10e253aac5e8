"""Scenes of others in the forms that their own projects have: parts that small examples lack."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from tests.core.exchange.importing import FILES, document_of, imported, notes


def _one(file: Path, text: str) -> tuple[dict[str, Any], dict[str, str], dict[str, str]]:
    """Write and import a file: its scenario, and what was left out and interpreted."""
    file.write_text(text)
    found = imported(file)
    return document_of(found)["scenario"], notes(found, "left out"), notes(found, "interpreted")


def _svg(inside: str, head: str = 'width="20" height="20"') -> str:
    names = 'xmlns="http://www.w3.org/2000/svg" xmlns:inkscape="http://www.inkscape.org/namespaces"'
    return f"<svg {names} {head}>{inside}</svg>"


_ZONES = """<rect inkscape:label="robot_spawn_zone" x="12" y="12" width="2" height="2"/>
<rect id="robot_goal_zone_0" x="16" y="16" width="2" height="2"/>"""


def test_robot_sf_zones_without_a_route_are_a_way_of_the_robot(tmp_path: Path) -> None:
    scenario, _, _ = _one(tmp_path / "a.svg", _svg(_ZONES))
    assert scenario["robots"]["robot"]["task"]["start"][:2] == [13, 13]
    assert scenario["environment"]["zones"]["robot_goal"]["x"] == [16, 18]


def test_robot_sf_coordinates_count_from_the_corner_of_the_view_box(tmp_path: Path) -> None:
    wall = '<rect x="11" y="11" width="1" height="1"/>'
    scenario, left, _ = _one(tmp_path / "a.svg", _svg(_ZONES + wall, 'viewBox="10 10 20 20"'))
    assert scenario["environment"]["area"] == {"x": [0, 20], "y": [0, 20]}
    assert scenario["robots"]["robot"]["task"]["start"][:2] == [3, 3]
    assert left["svg/rect"] == "robot_sf does not read them"


def test_robot_sf_maps_of_the_campus_have_outlines_of_other_kinds(tmp_path: Path) -> None:
    """Obstacles by name; a line there and back; zones that no route has."""
    place = {"x_margin": [0, 40], "y_margin": [0, 30], "robot_spawn_zones": [],
             "ped_spawn_zones": [[[1, 1], [2, 1], [2, 2]]],
             "obstacles": [[[5, 5], [6, 8], [9, 9], [6, 8]]],
             "Obstacles": {"obstacle_0": {"ID": "0", "Vertex": [[10, 10], [12, 10], [12, 12]]}},
             "ped_crowded_zones": [[[20, 10], [25, 10], [25, 15]]]}  # fmt: skip
    scenario, left, interpreted = _one(tmp_path / "a.json", json.dumps(place))
    assert len(scenario["environment"]["walls"]) == 4
    assert [10, 10] in next(iter(scenario["environment"]["blocks"].values()))["corners"]
    assert left["ped_spawn_zones"] == "no route of people has spawn_id 0"
    assert "encloses nothing" in interpreted["obstacles"]


_VADERE = json.loads((FILES / "vadere.scenario").read_text())


def test_vadere_circles_groups_and_walls_at_the_border(tmp_path: Path) -> None:
    deck = json.loads(json.dumps(_VADERE))
    topography = deck["scenario"]["topography"]
    circle = {"type": "CIRCLE", "center": {"x": 14, "y": 5}, "radius": 0.5}
    topography["obstacles"].append({"id": 3, "shape": circle})
    topography["targets"][0]["waiter"] = {"enabled": False, "distribution": None}
    topography["targets"][0]["absorber"] = {"enabled": True, "deletionDistance": 0.1}
    person = topography["dynamicElements"][0]
    person |= {"groupIds": [4], "attributes": {"id": 5, "radius": 0.2, "acceleration": 1.5}}
    scenario, left, _ = _one(tmp_path / "a.scenario", json.dumps(deck))
    assert scenario["environment"]["area"] == {"x": [0.5, 19.5], "y": [0.5, 9.5]}
    assert scenario["environment"]["pillars"]["obstacle"] == {"x": 14, "y": 5, "radius": 0.5}
    agent = scenario["crowd"]["agents"][0]
    assert (agent["id"], agent["group"], agent["max_acceleration"]) == (5, 4, 1.5)
    assert "scenario/topography/targets/waiter" not in left


def test_jupedsim_floors_that_cross_themselves_are_repaired(tmp_path: Path) -> None:
    deck = json.loads((FILES / "jupedsim.json").read_text())
    deck["walkable_area_wkt"] = "POLYGON ((0 0, 20 0, 20 8, 0 7, 0 8, 20 7.5, 20 9, 0 9, 0 0))"
    deck["distributions"]["west"]["coordinates"] = [[0, 0], [5, 0], [5, 8.5], [0, 9], [0, 0]]
    scenario, _, _ = _one(tmp_path / "crossing.json", json.dumps(deck))
    assert scenario["crowd"]["streams"]


def test_jupedsim_exits_thinner_than_a_body_are_moved_into_the_floor(tmp_path: Path) -> None:
    deck = json.loads((FILES / "jupedsim.json").read_text())
    deck["exits"]["east"]["coordinates"] = [[19.95, 3], [20, 3], [20, 5], [19.95, 5]]
    scenario, _, interpreted = _one(tmp_path / "a.json", json.dumps(deck))
    first = next(iter(scenario["crowd"]["streams"].values()))
    assert first["destination"]["centre"][0] < 19.8
    assert "no body has room in it" in interpreted["area"]


_WALLED = """<obstacle x1="0" y1="0" x2="9" y2="0"/><obstacle x1="9" y1="0" x2="9" y2="9"/>
<obstacle x1="9" y1="9" x2="0" y2="9"/><obstacle x1="0" y1="9" x2="0" y2="0"/>
<waypoint id="in" x="7" y="7" r="1"/><waypoint id="out" x="20" y="20" r="2"/>"""
_OUT = '<addwaypoint id="in"/><addwaypoint id="out"/></agent>'


@pytest.mark.parametrize("root", ["scenario", "welcome"])
def test_pedsim_people_and_robots_may_have_goals_behind_walls(tmp_path: Path, root: str) -> None:
    people = f'<agent x="3" y="3" n="2" dx="1" dy="1" type="0">{_OUT}'
    robot = f'<agent x="2" y="6" n="1" dx="0" dy="0" type="2">{_OUT}'
    text = f"<{root}>{_WALLED}{people}{robot}</{root}>"
    scenario, _, _ = _one(tmp_path / "a.xml", text)
    assert "routing" not in scenario["crowd"]
    assert scenario["environment"]["zones"]["robot_goal"]["x"] == [6.5, 7.5]


def test_commonroad_regions_radii_and_shapes_of_their_own(tmp_path: Path) -> None:
    at = "<center><x>{}</x><y>2</y></center>"
    text = f"""<commonRoad timeStepSize="0.5">
<dynamicObstacle id="7"><type>pedestrian</type><shape><circle><radius>0.25</radius></circle></shape>
<initialState><position><circle><radius>1</radius>{at.format(3)}</circle></position>
<time><exact>0</exact></time></initialState><occupancySet><occupancy><shape><circle>
<radius>1</radius>{at.format(4)}</circle></shape><time><exact>1</exact></time></occupancy>
</occupancySet></dynamicObstacle>
<environmentObstacle id="9"><type>building</type><shape><polygon><point><x>8</x><y>0</y></point>
<point><x>9</x><y>0</y></point><point><x>9</x><y>1</y></point></polygon></shape>
</environmentObstacle></commonRoad>"""
    file = tmp_path / "a.xml"
    file.write_text(text)
    found = imported(file)
    (table,) = found.scenes[0].tables.values()
    assert table.splitlines()[1:] == ["0.0,7,3.0,2.0", "0.5,7,4.0,2.0"]
    scenario = document_of(found)["scenario"]
    assert scenario["crowd"]["body"] == {"radius": 0.25}
    assert scenario["environment"]["blocks"]["static"]["corners"][0] == [8, 0]


def test_hunav_agents_that_the_list_does_not_name_are_named_in_the_report(tmp_path: Path) -> None:
    text = (FILES / "hunav.yaml").read_text().replace("      - ben\n", "")
    _, left, _ = _one(tmp_path / "a.yaml", f"viewer:\n  ros__parameters: {{on: 1}}\n{text}")
    assert "does not name it" in left["hunav_loader/ros__parameters/ben"]
    assert left["viewer"] == "parameters of another program"


def test_wkt_without_finite_coordinates_is_refused(tmp_path: Path) -> None:
    from crowdbot.errors import SpecError

    file = tmp_path / "a.wkt"
    file.write_text("POLYGON ((0 0, 1e400 0, 5 5, 0 0))")
    with pytest.raises(SpecError, match=r"a\.wkt:1:1: .*(finite|well-known)"):
        imported(file)
