"""The index: equal people score 1, people who ignore the robot 0; files and shipped statistics."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from crowdbot.core.crowd.response.from_spec import response_of
from crowdbot.core.crowd.response.parameters import Human
from crowdbot.core.realism.model import CrowdModel, ghosts
from crowdbot.core.realism.near_robots.compare import similarity
from crowdbot.core.realism.near_robots.encounters import encounters_of
from crowdbot.core.realism.near_robots.features import features_of
from crowdbot.core.realism.near_robots.measure import measure, measure_encounters
from crowdbot.core.realism.near_robots.page import render
from crowdbot.core.realism.near_robots.recordings import read_clips
from crowdbot.core.realism.near_robots.reference import (
    RobotReference,
    read_reference,
    reference_of,
    shipped,
)
from crowdbot.core.realism.near_robots.replay import Response, walk_all
from crowdbot.core.realism.near_robots.scenes import scenes_of
from crowdbot.core.realism.near_robots.statistics import cell_of
from crowdbot.core.realism.near_robots.tables import cell_rows, feature_rows
from crowdbot.dsl.scenario.robot_response import GivingWay
from crowdbot.errors import InputError
from tests.core.realism.near_robots.walks import as_table, clip, various

WALKERS = CrowdModel(policy=ghosts)
OLD, NEW = Response(crowd=WALKERS, human=Human()), Response(
    crowd=WALKERS, human=response_of(GivingWay())
)  # fmt: skip


@pytest.fixture(scope="module")
def evading() -> RobotReference:
    return reference_of(encounters_of(various(12)), ["made up"])


def test_recorded_people_have_index_1_and_straight_walkers_0(evading: RobotReference) -> None:
    same = measure_encounters("same", encounters_of(various(12)), evading)
    assert same.score == 1.0
    assert same.index >= 1.0
    ignoring = Response(crowd=WALKERS, human=Human(), ignoring=1.0)
    assert measure("ignore", ignoring, evading, (1,)).index == pytest.approx(0.0, abs=0.1)
    assert set(same.cells) == {("front", "walking")}


def test_a_cell_that_a_response_never_reaches_scores_nothing(evading: RobotReference) -> None:
    assert similarity({}, evading.whole, evading.weights).score == 0.0


def test_a_response_that_steps_aside_is_nearer_to_people_who_do(evading: RobotReference) -> None:
    assert measure("human", OLD, evading, (1,)).index > 0.2


def test_simulated_people_begin_as_the_recorded_did_and_repeat(evading: RobotReference) -> None:
    first, again = (walk_all(NEW, evading.encounters, 3) for _ in range(2))
    for e, a, b in zip(evading.encounters, first, again, strict=True):
        assert a.tobytes() == b.tobytes()
        assert a.shape == e.person.shape
        assert a[0] == pytest.approx(e.person[0], abs=0.05)


def test_the_shipped_statistics_tell_the_responses_apart_at_vehicles() -> None:
    known = shipped()
    vehicles = {c: t for c, t in known.tables.items() if c[1] == "vehicle"}
    assert {c[0] for c in vehicles} == {"front", "cross", "behind"}
    scenes = [e for t in vehicles.values() for e in scenes_of(t, 1, 12)]
    assert {cell_of(e) for e in scenes} == set(vehicles)
    gaps = [features_of(scenes, walk_all(r, scenes))[:, 0] for r in (OLD, NEW)]
    assert np.median(gaps[0]) < 0.5
    assert np.median(gaps[1]) > 0.8


def test_a_reference_survives_its_file(evading: RobotReference) -> None:
    kept = reference_of(encounters_of(various(12)), ["made up"], scenes=True)
    read = RobotReference.from_json(kept.as_json())
    assert read.as_json() == kept.as_json()
    assert read.drawn(1)
    assert not read.encounters
    assert kept.whole.keys() == evading.whole.keys()


def test_tables_with_a_robot_are_read_and_compared(tmp_path: Path) -> None:
    files = as_table(tmp_path, various(8))
    (one,) = read_clips(files[0])
    assert one.footprint.radius == 0.25
    assert one.pose[16, :2] == pytest.approx(various(8)[0].pose[16, :2], abs=0.02)
    assert read_reference([tmp_path]).weights == {("front", "walking"): 8}


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("t,id,x,y\n0,1,0,0\n1,1,1,0\n", "there is no row of id 'robot'"),
        ("t,id,x,y,radius\n0,robot,0,0,0.2\n1,robot,1,0,\n", "there is no row of a person"),
        ("t,id,x,y\n0,robot,0,0\n0,1,3,0\n1,robot,1,0\n", r"bad.csv:2: .*needs its radius"),
        ("t,id,x,y,radius\n0,robot,0,0,0.2\n0,1,3,0,\n0.5,robot,1,0,\n0.5,1,3,1,\n", "too short"),
        ("t,id,x,y,radius\n0,robot,0,0,0.2\n0,1,3,0,\n1,robot,1,0,\n1,1,3,1,\n", "max_gap"),
        ("t,name,x,y\n0,1,0,0\n", "column id is"),
    ],
)
def test_tables_that_cannot_be_compared(tmp_path: Path, text: str, message: str) -> None:
    path = tmp_path / "bad.csv"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(InputError, match=message):
        read_clips(path)


def test_files_of_other_kinds_and_too_few_meetings(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="no such file"):
        read_clips(tmp_path / "missing.csv")
    (tmp_path / "notes.txt").write_text("hello", encoding="utf-8")
    with pytest.raises(InputError, match="not a recording"):
        read_clips(tmp_path / "notes.txt")
    with pytest.raises(InputError, match="there is no recording in it"):
        read_clips(tmp_path)
    (tmp_path / "bad.npz").write_bytes(b"PK nonsense")
    with pytest.raises(InputError, match="not an archive of clips"):
        read_clips(tmp_path / "bad.npz")
    with pytest.raises(InputError, match="2 meetings of people and robot; 6 of one kind"):
        read_reference(as_table(tmp_path, various(2)))


def test_an_archive_of_clips_is_read(tmp_path: Path) -> None:
    one = clip(aside=0.4)
    vehicle = np.column_stack([one.pose, np.zeros((len(one.t), 3))])
    arrays = {
        "0_t": one.t, "0_vehicle": vehicle, "0_people": one.people, "0_outline": np.zeros((0, 2)),
    }  # fmt: skip
    np.savez(
        tmp_path / "a.npz",
        index=np.array('[{"key": 0, "name": "n", "group": "g", "radius": 0.25}]'),
        **arrays,  # type: ignore[arg-type]
    )
    (read,) = read_clips(tmp_path / "a.npz")
    assert (read.name, read.site, read.footprint.radius) == ("n", "g", 0.25)
    assert read.people[40, 0] == pytest.approx(one.people[40, 0], abs=0.05)


def test_the_page_and_the_table_say_what_was_compared(evading: RobotReference) -> None:
    found = measure_encounters("same", encounters_of(various(12)), evading)
    page = render("same", [found])
    assert "http" not in page.replace("http-equiv", "")
    assert f"Index <b>{found.index:.2f}</b>" in page
    assert cell_rows(found)[1][:2] == ["front walking", "12"]
    assert ["front walking", "share who evade", "1.00", "1.00"] in feature_rows(found)
