"""Lists of people as packages of others send them."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from rosbags.rosbag2 import StoragePlugin

import crowdbot
from crowdbot.errors import InputError, RecordingWarning
from tests.core.trajectories.bag.bag_kit import (
    TIMES,
    Row,
    array,
    check_walkers,
    header,
    make,
    marker,
    marker_rows,
    point,
    pose,
    read,
    robot_rows,
    twist,
    vector,
    walkers,
    write,
)


def _hunav(t: float) -> Any:
    def agent(number: int, kind: int, name: str, at: tuple[float, float]) -> Any:
        return make(
            "hunav_msgs/Agent", number, kind, 0, 1, name, 0, -1, pose(*at), 0.0, twist(), 0.5, 0.3,
            0.0, 0.0, [], False, 0.3, [],
        )  # fmt: skip

    people = [agent(i, 1, f"agent{i}", (x, y)) for i, x, y in walkers(t)]
    robot = agent(0, 2, "turtle", (0.5 * t, 0.0))
    return make("hunav_msgs/Agents", header(t), [robot, *people])


def _pedsim(t: float) -> Any:
    forces = make("pedsim_msgs/AgentForce", *[vector() for _ in range(7)])

    def state(number: int, kind: int, at: tuple[float, float]) -> Any:
        return make(
            "pedsim_msgs/AgentState", header(t), number, kind, "", pose(*at), twist(), forces
        )

    people = [state(i, 0, (x, y)) for i, x, y in walkers(t)]
    return make("pedsim_msgs/AgentStates", header(t), [*people, state(9, 2, (0.5 * t, 0.0))])


def _tracks(t: float, package: str) -> Any:
    covariance, age = np.zeros(36), make("builtin_interfaces/Duration", 1, 0)

    def track(number: int, at: tuple[float, float]) -> Any:
        return make(
            f"{package}/TrackedPerson", number, False, True, number, age,
            make("geometry_msgs/PoseWithCovariance", pose(*at), covariance),
            make("geometry_msgs/TwistWithCovariance", twist(), covariance),
        )  # fmt: skip

    return make(
        f"{package}/TrackedPersons", header(t), [track(i, (x, y)) for i, x, y in walkers(t)]
    )


def _people(t: float) -> Any:
    people = [
        make("people_msgs/Person", f"p{i}", point(x, y), point(0, 0), 1.0, [], [])
        for i, x, y in walkers(t)
    ]
    return make("people_msgs/People", header(t), people)


def _measurements(t: float) -> Any:
    people = [
        make(
            "people_msgs/PositionMeasurement", header(t), "legs", f"p{i}", point(x, y), 1.0,
            np.zeros(9), 0,
        )
        for i, x, y in walkers(t)
    ]  # fmt: skip
    return make("people_msgs/PositionMeasurementArray", header(t), people, np.zeros(0, np.float32))


def _objects(t: float, person: int = 4) -> Any:
    shape = make("shape_msgs/SolidPrimitive", 1, np.zeros(3), make("geometry_msgs/Polygon", []))

    def thing(number: int, kind: int, at: tuple[float, float]) -> Any:
        still = make("geometry_msgs/Accel", vector(), vector())
        return make(
            "derived_object_msgs/Object", header(t), number, 1, True, pose(*at), twist(), still,
            make("geometry_msgs/Polygon", []), shape, kind, 255, 10,
        )  # fmt: skip

    people = [thing(i, person, (x, y)) for i, x, y in walkers(t)]
    car = [thing(3, 6, (0.5 * t, 0.5))] if person == 4 else []
    return make("derived_object_msgs/ObjectArray", header(t), [*car, *people])


_MAKERS: dict[str, Callable[[float], Any]] = {
    "hunav_msgs": _hunav,
    "pedsim_msgs": _pedsim,
    "pedsim_msgs, tracks": lambda t: _tracks(t, "pedsim_msgs"),
    "spencer_tracking_msgs": lambda t: _tracks(t, "spencer_tracking_msgs"),
    "people_msgs": _people,
    "people_msgs, measurements": _measurements,
    "derived_object_msgs": _objects,
    "derived_object_msgs, unclassified": lambda t: _objects(t, 0),
}


@pytest.mark.parametrize("package", _MAKERS)
@pytest.mark.filterwarnings("ignore::crowdbot.RecordingWarning")
def test_packages_of_others(tmp_path: Path, package: str) -> None:
    rows: list[Row] = [("/people", t, _MAKERS[package](t)) for t in TIMES]
    run = read(write(tmp_path / "bag", robot_rows() + rows))
    check_walkers(run)
    if package == "hunav_msgs":
        assert run.agents is not None
        np.testing.assert_allclose(run.agents.radius, 0.3)


def test_what_is_left_out_is_told(tmp_path: Path) -> None:
    rows: list[Row] = [("/people", t, _objects(t)) for t in TIMES]
    with pytest.warns(RecordingWarning, match=f"left out: {len(TIMES)} of kind 'car'"):
        read(write(tmp_path / "car", robot_rows() + rows))
    rows = [("/people", t, _pedsim(t)) for t in TIMES]
    with pytest.warns(RecordingWarning, match=f"{len(TIMES)} of kind 'robot'"):
        read(write(tmp_path / "robot", robot_rows() + rows))


def _without_definitions(folder: Path) -> None:
    """Make a sqlite3 bag what ROS 2 Humble writes: version 5, no definitions."""
    import re
    import sqlite3

    data = sqlite3.connect(next(folder.glob("*.db3")))
    data.executescript(
        "drop table message_definitions; update schema set schema_version = 3; create table plain "
        "as select id, name, type, serialization_format, offered_qos_profiles from topics;"
        "drop table topics; alter table plain rename to topics;"
    )
    data.commit()
    data.close()
    meta = folder / "metadata.yaml"
    text = re.sub(r"^  version: \d+", "  version: 5", meta.read_text(), flags=re.MULTILINE)
    text = re.sub(r"      type_description_hash:.*\n.*\n", "", text)
    meta.write_text(re.sub(r"  custom_data:.*\n|  ros_distro.*\n", "", text))


@pytest.mark.filterwarnings("ignore::crowdbot.RecordingWarning")
@pytest.mark.parametrize("package", ["hunav_msgs", "pedsim_msgs", "people_msgs"])
def test_bags_without_definitions(tmp_path: Path, package: str) -> None:
    rows: list[Row] = [("/people", t, _MAKERS[package](t)) for t in TIMES]
    bag = write(tmp_path / "bag", robot_rows() + rows, StoragePlugin.SQLITE3)
    _without_definitions(bag)
    check_walkers(read(bag))


def test_types_that_nothing_describes(tmp_path: Path) -> None:
    import sqlite3

    bag = write(tmp_path / "bag", robot_rows() + marker_rows(), StoragePlugin.SQLITE3)
    _without_definitions(bag)
    data = sqlite3.connect(next(bag.glob("*.db3")))
    data.execute("update topics set type = 'acme_msgs/msg/Crowd' where name = '/people'")
    data.commit()
    data.close()
    meta = bag / "metadata.yaml"
    text = meta.read_text().replace("visualization_msgs/msg/MarkerArray", "acme_msgs/msg/Crowd")
    meta.write_text(text)
    with pytest.raises(InputError, match=r"holds acme_msgs/msg/Crowd, a type .*ros2 bag convert"):
        read(bag)
    assert read(bag, people=None).robot is not None  # fmt: skip


# ------------------------------------------------------------------------------ markers
def test_deleted_markers_are_no_people(tmp_path: Path) -> None:
    rows: list[Row] = []
    for t in TIMES:
        shown = [marker(t, i, (x, y)) for i, x, y in walkers(t)]
        gone = [marker(t, 0, (0, 0), action=3), marker(t, 7, (0, 0), action=2)]
        rows.append(("/people", t, array(gone + shown)))
    check_walkers(read(write(tmp_path / "bag", robot_rows() + rows)), [1, 2])


@pytest.mark.parametrize("ended", ["by nothing", "alone", "with all", "before each message"])
def test_markers_that_end_early(tmp_path: Path, ended: str) -> None:
    """Viewers show a marker until it is deleted; some send each one once."""
    rows: list[Row] = []
    for t in TIMES:
        all_gone = ended == "before each message" or (ended == "with all" and t == TIMES[20])
        shown = [marker(t, 0, (0, 0), action=3)] * all_gone
        shown += [marker(t, 2, (4, -2), action=2)] * (ended == "alone" and t == TIMES[20])
        shown += [marker(t, i, (x, y)) for i, x, y in walkers(t) if i == 1 or t < TIMES[20]]
        rows.append(("/people", t, array(shown)))
    bag = write(tmp_path / "bag", robot_rows() + rows)
    if ended == "by nothing":
        with pytest.warns(RecordingWarning, match=r"1 marker\(s\), 'people/2', are not sent to"):
            run = read(bag)
    else:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            run = read(bag)
    assert run.agents is not None
    assert np.isfinite(run.agents.x).sum(axis=0).tolist() == [49, 20]


@pytest.mark.parametrize("kind", [6, 7, 8], ids=["cubes", "spheres", "points"])
@pytest.mark.parametrize("alone", [True, False], ids=["a marker", "an array"])
def test_lists_of_points_are_people(tmp_path: Path, kind: int, alone: bool) -> None:
    rows: list[Row] = []
    for t in TIMES:
        # relative to the marker's own pose
        points = [(x - 1.0, y + 2.0) for _, x, y in walkers(t)]
        shown = marker(t, 0, (1.0, -2.0), kind=kind, points=points)
        rows.append(("/people", t, shown if alone else array([shown])))
    check_walkers(read(write(tmp_path / "bag", robot_rows() + rows)))


def test_texts_heads_and_arrows_are_no_people(tmp_path: Path) -> None:
    rows: list[Row] = []
    for t in TIMES:
        shown = []
        for i, x, y in walkers(t):
            shown += [
                marker(t, 10 * i, (x, y), group="bodies"),
                marker(t, 10 * i + 1, (x, y), kind=2, group="heads"),
                marker(t, 10 * i + 2, (x, y + 0.2), kind=9, group="labels"),
                marker(t, 10 * i + 3, (x, y + 0.3), kind=0, group="velocities"),
                marker(t, 10 * i + 4, (0, 0), kind=4, group="trails", points=[(x, y), (x, y)]),
            ]
        rows.append(("/people", t, array(shown)))
    check_walkers(read(write(tmp_path / "bag", robot_rows() + rows)), [10, 20])


def test_markers_of_one_number_in_two_namespaces(tmp_path: Path) -> None:
    rows: list[Row] = [
        ("/people", t, array(marker(t, 0, (x, y), group=f"p{i}") for i, x, y in walkers(t)))
        for t in TIMES
    ]
    check_walkers(read(write(tmp_path / "bag", robot_rows() + rows)))


def test_markers_of_texts_alone_are_refused(tmp_path: Path) -> None:
    rows: list[Row] = [
        ("/people", t, array(marker(t, i, (x, y), kind=9) for i, x, y in walkers(t))) for t in TIMES
    ]
    with pytest.raises(InputError, match="/people contains no people"):
        read(write(tmp_path / "bag", robot_rows() + rows))


# --------------------------------------------------------------------------- identities
def test_a_robot_among_the_agents(tmp_path: Path) -> None:
    rows: list[Row] = [
        (
            "/people", t,
            make("geometry_msgs/PoseArray", header(t), [
                pose(0.5 * t + 0.02, 0.01), *(pose(x, y) for _, x, y in walkers(t)),
            ]),
        )
        for t in TIMES
    ]  # fmt: skip
    with pytest.warns(RecordingWarning, match="it is the robot itself"):
        check_walkers(read(write(tmp_path / "bag", robot_rows() + rows)))


def test_placeholders_at_the_origin_are_no_people(tmp_path: Path) -> None:
    rows: list[Row] = []
    for t in TIMES:
        people = [pose(x, y) for _, x, y in walkers(t)]
        rows.append(
            ("/people", t, make("geometry_msgs/PoseArray", header(t), [*people, pose(0, 0)]))
        )
    with pytest.warns(RecordingWarning, match=r"exactly \(0, 0\) are left out"):
        check_walkers(read(write(tmp_path / "bag", robot_rows() + rows)))


def test_who_walks_through_the_origin_stays(tmp_path: Path) -> None:
    rows: list[Row] = [
        ("/people", t, array([marker(t, 5, (round(t - 2.0, 3), 0.0))])) for t in TIMES
    ]
    bag = write(tmp_path / "bag", rows)
    run = crowdbot.Trajectories.from_rosbag(bag, people="/people")
    assert run.agents is not None
    assert len(run.agents.x) == len(TIMES)
    assert np.any(run.agents.x == 0.0)


def test_nearness_tells_people_apart_whose_places_in_the_list_change(tmp_path: Path) -> None:
    rows: list[Row] = []
    for k, t in enumerate(TIMES):
        people = [pose(x, y) for _, x, y in walkers(t)]
        people = people[::-1] if k % 3 == 1 else people
        rows.append(("/people", t, make("geometry_msgs/PoseArray", header(t), people)))
    with pytest.warns(RecordingWarning, match="2 people are told apart by nearness"):
        check_walkers(read(write(tmp_path / "bag", robot_rows() + rows)), [0, 1])
