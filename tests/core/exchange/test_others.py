"""Scenes of HuNavSim, pedsim_ros, Vadere, JuPedSim, robot_sf and CommonRoad."""

from __future__ import annotations

from pathlib import Path

import pytest

from crowdbot.errors import InputError, RecordingWarning, SpecError
from tests.core.exchange.importing import FILES, document_of, imported, notes

_OTHERS = ("hunav.yaml", "pedsim.xml", "vadere.scenario", "jupedsim.json", "floor.wkt",
           "robot_sf.svg", "robot_sf.yaml", "commonroad.xml")  # fmt: skip


@pytest.mark.parametrize("name", _OTHERS)
def test_all_parts_of_a_scene_have_a_fate(name: str) -> None:
    found = imported(name)
    assert not [e for e in found.report.entries if e.note.startswith("no meaning")]


@pytest.mark.parametrize("name", _OTHERS)
def test_an_unknown_part_is_named(tmp_path: Path, name: str) -> None:
    """Add a part that no one knows: the import succeeds and the report has it."""
    if name == "floor.wkt":
        return
    text = (FILES / name).read_text()
    changes = {
        "hunav.yaml": ("    map: hall", "    map: hall\n    colour: red"),
        "pedsim.xml": ('<agent x="2"', '<agent colour="red" x="2"'),
        "vadere.scenario": ('"bounded": true', '"bounded": true, "colour": "red"'),
        "jupedsim.json": ('"seed": 11,', '"seed": 11, "colour": "red",'),
        "robot_sf.svg": ("<svg ", '<svg colour="red" '),
        "robot_sf.yaml": ("ped_crowded_zones: []", "ped_crowded_zones: []\ncolour: red"),
        "commonroad.xml": ("<location>", "<colour/><location>"),
    }
    before, after = changes[name]
    assert before in text
    file = tmp_path / name
    file.write_text(text.replace(before, after, 1))
    named = [e.theirs for e in imported(file).report.entries if "colour" in e.theirs]
    assert named


def test_hunav_agents_have_goals_groups_and_behaviours() -> None:
    crowd = document_of(imported("hunav.yaml"))["scenario"]["crowd"]
    anna, ben = crowd["agents"]
    assert (anna["id"], anna["goals"], anna["at_goal"]) == (3, [[4, 2], [1, 2]], "loop")
    assert (ben["group"], ben["speed"], ben["radius"]) == (2, 1.5, 0.35)
    assert crowd["robot_response"] == {"reaction": "mixed", "ignoring_fraction": 0.5}
    assert anna["attention"] < ben["attention"]


def test_pedsim_clusters_are_spawns_and_type_2_is_the_robot() -> None:
    scenario = document_of(imported("pedsim.xml"))["scenario"]
    spawns = scenario["crowd"]["spawns"]
    assert spawns["people"]["count"] == 6
    assert spawns["people"]["goals"]["areas"] == ["west", "desk", "east"]
    assert spawns["people_2"]["standing"] is True
    assert scenario["robots"]["robot"]["task"]["start"] == [2, 5, 0]
    with pytest.raises(SpecError, match=r"no waypoint 'nowhere'"):
        _changed("pedsim.xml", 'addwaypoint id="west"', 'addwaypoint id="nowhere"')


def test_vadere_sources_are_streams() -> None:
    crowd = document_of(imported("vadere.scenario"))["scenario"]["crowd"]
    there, later = crowd["streams"]["source"], crowd["streams"]["source_2"]
    assert (there["count"], there["at_destination"]) == (12, "leave")
    assert [g["size"] for g in there["groups"]] == [1, 2]
    assert later["arrivals"] == {"begin": 1, "until": 30, "every": 2}
    assert crowd["speed"] == {"mean": 1.34, "std": 0.26}
    assert crowd["agents"][0]["goals"] == [[18, 5]]
    with pytest.raises(SpecError, match=r"no target 8; there are: 7"):
        _changed(
            "vadere.scenario", '"targetIds": [7],\n         "group', '"targetIds": [8],\n "group'
        )


def test_jupedsim_journeys_share_the_people() -> None:
    scenario = document_of(imported("jupedsim.json"))["scenario"]
    first, second = scenario["crowd"]["streams"].values()
    assert (first["count"], second["count"]) == (7, 3)
    assert first["via"][0]["centre"] == [12, 4]
    assert first["destination"]["centre"] == [19, 4]
    assert scenario["crowd"]["seed"]["root"] == 11
    with pytest.raises(SpecError, match=r"not well-known text"):
        _changed("jupedsim.json", "POLYGON ((0 0", "POLYGON ((0 zero")


def test_jupedsim_takes_the_geometry_beside_it(tmp_path: Path) -> None:
    text = (FILES / "jupedsim.json").read_text()
    line = next(ln for ln in text.splitlines() if "walkable_area_wkt" in ln)
    (tmp_path / "config.json").write_text(text.replace(line + "\n", ""))
    with pytest.raises(SpecError, match="no walkable area"):
        imported(tmp_path / "config.json")
    (tmp_path / "geometry.wkt").write_text("POLYGON ((0 0, 20 0, 20 8, 0 8, 0 0))")
    assert (
        "20 8" in document_of(imported(tmp_path / "config.json"))["scenario"]["environment"]["wkt"]
    )


def test_robot_sf_maps_have_one_scenario_for_each_route() -> None:
    assert imported("robot_sf.yaml").ids == ["robot_sf_0_0", "robot_sf_0_1"]
    scenario = document_of(imported("robot_sf.svg"))["scenario"]
    assert scenario["environment"]["blocks"]["obstacle_2"]["corners"] == [
        [20, 2], [22, 2], [22, 5], [21, 6],
    ]  # fmt: skip
    assert scenario["crowd"]["agents"][0]["goals"] == [[28, 10]]
    with pytest.raises(SpecError, match="not a command"):
        _changed("robot_sf.svg", "M 20,2", "M 20,2 &amp;")


def test_commonroad_pedestrians_walk_as_recorded() -> None:
    found = imported("commonroad.xml")
    (table,) = found.scenes[0].tables.values()
    assert table.splitlines()[1:3] == ["0.0,21,0.0,0.0", "0.1,21,0.1,0.0"]
    assert "no vehicles" in notes(found, "left out")["commonRoad/dynamicObstacle"]


def test_recordings_are_replayed(tmp_path: Path) -> None:
    (tmp_path / "output_5.csv").write_text("0,1,2,0,1\n0.1,1.1,2,0,1\n")
    (tmp_path / "output_6.csv").write_text("0,3,2,0,1\n0.1,3.1,2,0,1\n")
    found = imported(tmp_path / "output_5.csv", tmp_path / "output_6.csv")
    (table,) = found.scenes[0].tables.values()
    assert table.splitlines()[1:3] == ["0.0,5,1.0,2.0", "0.0,6,3.0,2.0"]
    whole = tmp_path / "recording.csv"
    whole.write_text("time,entity,id,x,y,yaw\n0,agent,1,0,0,0\n0,robot,0,9,9,0\n1,agent,1,1,0,0\n")
    with pytest.warns(RecordingWarning, match=r"csv:3: rows of a robot are left out"):
        found = imported(whole)
    assert len(found.scenes[0].tables["imported.recorded.csv"].splitlines()) == 3
    whole.write_text("time,id,x,y\n0,1,0,0\n1,1,far,0\n")
    with pytest.raises(InputError, match=r"recording.csv:3: x: .*'far'"):
        imported(whole)


def _changed(name: str, before: str, after: str) -> None:
    import tempfile

    text = (FILES / name).read_text()
    assert before in text
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / name
        file.write_text(text.replace(before, after))
        imported(file)
