"""Scenes of others as people publish them: wrapped, with pockets, with times of other kinds."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from shapely import Point, from_wkt  # type: ignore[import-untyped,unused-ignore]

from crowdbot.errors import SpecError
from tests.core.exchange.importing import FILES, document_of, imported, notes

_ROOM = "POLYGON ((0 0, 20 0, 20 10, 0 10, 0 0))"


def _square(x: float, y: float, side: float) -> list[list[float]]:
    return [[x, y], [x + side, y], [x + side, y + side], [x, y + side], [x, y]]


def test_jupedsim_scenarios_in_a_message_have_their_geometry_beside_them(tmp_path: Path) -> None:
    pillar = {"type": "polygon", "coordinates": _square(9, 4, 2)}
    deck = {"config": {"exits": {"door": {"coordinates": _square(18, 4, 2)}},
                       "distributions": {"hall": {"coordinates": _square(1, 2, 4),
                                                  "parameters": {"number": 4}}},
                       "obstacles": {"pillar": pillar},
                       "journeys_v2": [{"id": "a", "sequence": ["door", "nowhere"]}]},
            "geometry_wkt": _ROOM}  # fmt: skip
    file = tmp_path / "a.json"
    file.write_text(json.dumps(deck, indent=1))
    found = imported(file)
    scenario = document_of(found)["scenario"]
    floor = from_wkt(scenario["environment"]["wkt"])
    assert (floor.area, floor.contains(Point(10, 5))) == (196.0, False)
    assert scenario["crowd"]["streams"]["hall"]["count"] == 4
    assert "no exit or checkpoint 'nowhere'" in notes(found, "left out").values()


def test_hunav_files_for_isaac_sim_name_behaviours_and_share_goals(tmp_path: Path) -> None:
    agent = (
        "    {name}:\n      id: {id}\n      group_id: -1\n      behavior: {{type: {kind}}}\n"
        "      init_pose: {{x: {id}.0, y: 1.0, z: 0.0, h: 0.5}}\n      goals: [2, 1]\n"
    )
    head = (
        "hunav_loader:\n  ros__parameters:\n    simulator: Isaac Sim\n    map: warehouse\n"
        "    global_goals:\n      1: {x: -5.0, y: 9.0}\n      2: {x: 1.0, y: 7.0}\n"
        "    agents: [ann, ben]\n"
    )
    file = tmp_path / "warehouse.yaml"
    ben = agent.format(name="ben", id=2, kind="Regular")
    file.write_text(head + agent.format(name="ann", id=1, kind="Impassive") + ben)
    first, second = document_of(imported(file))["scenario"]["crowd"]["agents"]
    assert [row["attention"] for row in (first, second)] == [0.0, 0.5]
    assert first["goals"] == [[1.0, 7.0], [-5.0, 9.0]]
    file.write_text(head + agent.format(name="ann", id=1, kind="Curius") + ben)
    with pytest.raises(SpecError, match=r"'Curius' is not a behaviour.* did you mean 'curious'"):
        imported(file)


def test_recorded_people_have_usual_names_of_columns_units_and_names(tmp_path: Path) -> None:
    file = tmp_path / "people.csv"
    rows = [(t, who, t + k, 2 * k) for t in (0, 1, 2) for k, who in enumerate(("ann", "ben"))]
    lines = [f"{1000 * t};{who};{100 * x};{100 * y};1.5" for t, who, x, y in rows]
    file.write_text("\n".join(["timestamp_ms;person_id;pos_x [cm];pos_y [cm];theta_rad", *lines]))
    (table,) = imported(file).scenes[0].tables.values()
    found = [tuple(map(float, line.split(","))) for line in table.splitlines()[1:]]
    assert found == [(t, ("ann", "ben").index(who), x, y) for t, who, x, y in rows]
    blanks = [f"{who} {t} {x} {y}" for t, who, x, y in rows]
    file.write_text("\n".join(["pedestrianId simTime startX-PID1 startY-PID1", *blanks]))
    (same,) = imported(file).scenes[0].tables.values()
    assert same == table
    commas = [f"{who};{t},0;{x},0;{y},0" for t, who, x, y in rows]
    file.write_text("\n".join(["sep=;", "# a comment", "person;time;x;y", *commas]))
    (same,) = imported(file).scenes[0].tables.values()
    assert same == table
    file.write_text("0,7,1,2\n1,7,1.5,2\n")  # a frame, a person and a place, as in other files
    with pytest.raises(SpecError, match=r"E403.*no known format"):
        imported(file)


@pytest.mark.parametrize(
    ("distribution", "arrivals"),
    [
        ({"type": "poisson", "numberPedsPerSecond": 0.5}, {"rate": 0.5}),
        ({"type": "constant", "updateFrequency": 4.0}, {"every": 4.0}),
        ({"type": "negativeExponential", "mean": 2.0}, {"rate": 0.5}),
        ({"type": "binomial", "trials": 10, "p": 0.2}, {"rate": 0.5}),
        ({"type": "empirical", "values": [1.0, 3.0]}, {"every": 2.0}),
        (
            {"type": "timeSeries", "intervalLength": 8.0, "spawnsPerInterval": [1, 3]},
            {"every": 4.0},
        ),
        ({"type": "singleSpawn", "spawnTime": 3.0}, {"times": [3.0]}),
    ],
)
def test_vadere_sources_spawn_at_the_mean_rate_of_their_distribution(
    tmp_path: Path, distribution: dict[str, Any], arrivals: dict[str, Any]
) -> None:
    deck = json.loads((FILES / "vadere.scenario").read_text())
    source = deck["scenario"]["topography"]["sources"][1]
    for name in ("interSpawnTimeDistribution", "distributionParameters"):
        del source[name]
    source["distribution"] = distribution
    file = tmp_path / "a.scenario"
    file.write_text(json.dumps(deck))
    streams = document_of(imported(file))["scenario"]["crowd"]["streams"]
    assert arrivals.items() <= list(streams.values())[1]["arrivals"].items()


def test_vadere_people_wait_until_their_source_has_room(tmp_path: Path) -> None:
    deck = json.loads((FILES / "vadere.scenario").read_text())
    deck["scenario"]["topography"]["sources"][0]["spawnNumber"] = 400  # in 24 m²
    file = tmp_path / "a.scenario"
    file.write_text(json.dumps(deck))
    found = imported(file)
    stream = next(iter(document_of(found)["scenario"]["crowd"]["streams"].values()))
    assert stream["arrivals"] == {"times": [0.0] * 400}
    assert "count" not in stream
    assert any("the others enter as soon as there is more" in e.note for e in found.report.entries)


@pytest.mark.parametrize("newer", [False, True])
def test_vadere_sources_of_cars_let_no_people_in(tmp_path: Path, newer: bool) -> None:
    deck = json.loads((FILES / "vadere.scenario").read_text())
    sources = deck["scenario"]["topography"]["sources"]
    for source in sources[1:]:
        (source.setdefault("spawner", {}) if newer else source)["dynamicElementType"] = "CAR"
    file = tmp_path / "a.scenario"
    file.write_text(json.dumps(deck))
    found = imported(file)
    assert len(document_of(found)["scenario"]["crowd"]["streams"]) == 1
    assert any(entry.note == "there are no cars" for entry in found.report.entries)


_WALLS = "".join(
    f'<obstacle x1="{a}" y1="{b}" x2="{c}" y2="{d}"/>'
    for a, b, c, d in [(0, 0, 30, 0), (30, 0, 30, 20), (30, 20, 0, 20), (0, 20, 0, 0),
                       (8, 8, 12, 8), (12, 8, 12, 12), (12, 12, 8, 12), (8, 12, 8, 8)]
)  # fmt: skip


def test_pedsim_clusters_leave_pockets_and_what_is_outside(tmp_path: Path) -> None:
    """A cluster over a hollow pillar that sticks out of the house: each person has a way."""
    file = tmp_path / "a.xml"
    file.write_text(f"""<scenario>{_WALLS}<waypoint id="in" x="25" y="10" r="2"/>
<agent x="5" y="10" n="9" dx="18" dy="12" type="0"><addwaypoint id="in"/></agent></scenario>""")
    found = imported(file)
    scenario = document_of(found)["scenario"]
    area = scenario["crowd"]["spawns"]["people"]["area"]
    assert area["centre"][0] - 0.5 * area["size"][0] > 0.3
    assert scenario["environment"]["blocks"]["pocket"]["corners"]
    assert scenario["crowd"]["routing"] == {"kind": "mesh"}


def test_pedsim_clusters_are_as_wide_as_they_say(tmp_path: Path) -> None:
    file = tmp_path / "a.xml"
    file.write_text("""<scenario><waypoint id="in" x="60" y="0" r="2"/>
<agent x="5" y="1" n="2" dx="18" dy="12" type="0"><addwaypoint id="in"/></agent></scenario>""")
    scenario = document_of(imported(file))["scenario"]
    assert scenario["crowd"]["spawns"]["people"]["area"] == {"centre": [5, 1], "size": [18, 12]}
    floor = scenario["environment"]["area"]
    assert floor["x"][1] > 62.0  # the goal is on it


def test_pedsim_robots_that_start_in_their_way_point_drive_a_few_metres(tmp_path: Path) -> None:
    file = tmp_path / "a.xml"
    file.write_text(f"""<scenario>{_WALLS}<waypoint id="in" x="26" y="10" r="2"/>
<agent x="26" y="10" n="1" dx="0" dy="0" type="2"><addwaypoint id="in"/></agent></scenario>""")
    zone = document_of(imported(file))["scenario"]["environment"]["zones"]["robot_goal"]
    assert zone == {"x": [20.5, 21.5], "y": [9.5, 10.5]}  # behind it, since a wall is ahead


@pytest.mark.parametrize(
    ("name", "text", "way"),
    [
        ("a.urdf", '<robot name="r"><link name="l"/></robot>', "{kind: urdf, file: a.urdf}"),
        ("a.world", '<sdf version="1.6"><world name="w"/></sdf>', "worlds of Gazebo are not read"),
        ("map.yaml", "image: m.pgm\nresolution: 0.05\noccupied_thresh: 0.65\n",
         "{kind: floor_plan, file: map.yaml}"),
        ("a.geojson", '{"type": "FeatureCollection", "features": []}', "{kind: floor_plan,"),
        ("a.json", '{"robots": [], "obstacles": {}}', "known are the original's trials"),
    ],
)  # fmt: skip
def test_files_that_are_no_scenes_are_told_where_they_are_read(
    tmp_path: Path, name: str, text: str, way: str
) -> None:
    file = tmp_path / name
    file.write_text(text)
    with pytest.raises(SpecError, match="E403") as caught:
        imported(file)
    assert way in str(caught.value)
