"""Bags of recordings that ended badly: what is whole is read, the rest is refused with a remedy."""

from __future__ import annotations

import math
import shutil
import sqlite3
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from rosbags.rosbag2 import StoragePlugin, Writer

from crowdbot.core.trajectories.bag import reader
from crowdbot.core.trajectories.bag.definitions import known_types
from crowdbot.errors import InputError, RecordingWarning
from tests.core.trajectories.bag.bag_kit import (
    TIMES,
    Row,
    array,
    check_walkers,
    make,
    marker_rows,
    odometry,
    point,
    read,
    robot_rows,
    turn,
    twist,
    write,
)


def _bag(folder: Path, plugin: StoragePlugin = StoragePlugin.SQLITE3) -> Path:
    bag = write(folder / "bag", [*robot_rows(), *marker_rows()], plugin)
    (bag / "metadata.yaml").unlink()  # written at the end, so lost with the power
    return bag


def _split(bag: Path) -> None:
    """Divide the messages among parts 2 and 10."""
    whole = (bag / "bag.db3").read_bytes()
    for name, first, last in (("bag_2.db3", 0, 30), ("bag_10.db3", 31, 10**6)):
        (bag / name).write_bytes(whole)
        with sqlite3.connect(bag / name) as part:
            part.execute("delete from messages where id not between ? and ?", (first, last))
        part.close()
    (bag / "bag.db3").unlink()


@pytest.mark.parametrize("plugin", [StoragePlugin.SQLITE3, StoragePlugin.MCAP])
def test_a_folder_without_metadata_is_read(tmp_path: Path, plugin: StoragePlugin) -> None:
    check_walkers(read(_bag(tmp_path, plugin)))


def test_parts_without_metadata_are_one_recording(tmp_path: Path) -> None:
    bag = _bag(tmp_path)
    _split(bag)
    check_walkers(read(bag))


def _cut(bag: Path) -> None:
    file = next(bag.iterdir())
    file.write_bytes(file.read_bytes()[:-400])


def _packed(bag: Path) -> None:
    (bag / "bag.db3").rename(bag / "bag.db3.zstd")


def _older(bag: Path) -> None:
    with sqlite3.connect(bag / "bag.db3") as made:
        made.execute("alter table topics drop column offered_qos_profiles")
    made.close()


def _other(bag: Path) -> None:
    (bag / "bag.db3").write_bytes(b"hello" * 100)


def _none(bag: Path) -> None:
    (bag / "bag.db3").unlink()


def _blank(bag: Path) -> None:
    (bag / "metadata.yaml").write_text("")


def _half(bag: Path) -> None:
    (bag / "metadata.yaml").write_text("rosbag2_bagfile_information:\n  version: 5\n  mess")


def _without_profile(bag: Path) -> None:
    file = next(bag.glob("*.mcap"))
    file.write_bytes(file.read_bytes().replace(b"\4\0\0\0ros2", b"\4\0\0\0ros9", 1))


@pytest.mark.parametrize(
    ("plugin", "damage", "expected"),
    [
        (StoragePlugin.SQLITE3, _blank, "'ros2 bag reindex FOLDER'"),
        (StoragePlugin.MCAP, _half, "'ros2 bag reindex FOLDER'"),
        (StoragePlugin.MCAP, _without_profile, "JSON and Protobuf of Foxglove are not read"),
        (StoragePlugin.MCAP, _cut, "mcap recover FILE"),
        (StoragePlugin.SQLITE3, _cut, r"cut off: .* 'sqlite3 FILE .recover"),
        (StoragePlugin.SQLITE3, _packed, "unpack it with 'zstd -d FILE'"),
        (StoragePlugin.SQLITE3, _older, "'ros2 bag convert' renews it"),
        (StoragePlugin.SQLITE3, _other, "file is not a database"),
        (
            StoragePlugin.SQLITE3,
            _none,
            "a folder without metadata.yaml, .mcap, .db3 and .bag files",
        ),
    ],
)
def test_what_cannot_be_read_is_refused_with_what_helps(
    tmp_path: Path, plugin: StoragePlugin, damage: Callable[[Path], None], expected: str
) -> None:
    bag = _bag(tmp_path, plugin)
    damage(bag)
    with pytest.raises(InputError, match=expected):
        read(bag)


def _our_fault(*_: object) -> None:
    raise KeyError("a fault of ours")


@pytest.mark.parametrize("ours", ["definitions.known_types", "reader._remedy", "reader._parts"])
def test_faults_of_ours_are_not_told_as_the_bags(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, ours: str
) -> None:
    bag = _bag(tmp_path)
    _other(bag)
    monkeypatch.setattr(f"crowdbot.core.trajectories.bag.{ours}", _our_fault)
    with pytest.raises(KeyError, match="a fault of ours"):
        read(bag)


def test_faults_while_a_bag_is_open_keep_their_type(tmp_path: Path) -> None:
    bag = _bag(tmp_path)
    with pytest.raises(ZeroDivisionError), reader._opened(bag):
        raise ZeroDivisionError


def test_what_the_library_finds_amid_a_bag_is_the_bags(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def broken(*_: object, **__: object) -> Iterator[tuple[object, int, bytes]]:
        raise IndexError("row 3")
        yield None, 0, b""

    bag = _bag(tmp_path)
    monkeypatch.setattr("rosbags.highlevel.AnyReader.messages", broken)
    with pytest.raises(InputError, match="not a bag that can be read: row 3"):
        read(bag)


def test_what_to_do_with_a_packed_bag_and_with_a_renamed_file(tmp_path: Path) -> None:
    bag = write(tmp_path / "bag", [*robot_rows(), *marker_rows()])
    for kind in ("zip", "gztar", "tar"):
        packed = Path(shutil.make_archive(str(tmp_path / "packed"), kind, bag))
        with pytest.raises(InputError, match=r"not a bag .*\(unpack it first\)"):
            read(packed)
    (file,) = bag.glob("*.mcap")
    file.rename(bag / "other.mcap")
    with pytest.raises(InputError, match=r"metadata\.yaml names its files: rename them back"):
        read(bag)
    (bag / "metadata.yaml").unlink()
    check_walkers(read(bag))


def _driven(turn: Any, x: Callable[[float], float] = lambda t: 0.5 * t) -> list[Row]:
    return [
        ("/odom", t, odometry(t, make("geometry_msgs/Pose", point(x(t), 0.0), turn), twist(0.5)))
        for t in TIMES
    ]


def test_lost_positions_of_the_robot_are_told(tmp_path: Path) -> None:
    rows = _driven(turn(0.0), lambda t: math.nan if 2.0 < t < 2.35 else 0.5 * t)
    with pytest.warns(RecordingWarning, match="3 positions of the robot that are not finite"):
        check_walkers(read(write(tmp_path / "bag", [*rows, *marker_rows()])))
    rows = _driven(turn(0.0), lambda _: math.nan)
    with pytest.raises(InputError, match="no position of the robot is finite"):
        read(write(tmp_path / "none", [*rows, *marker_rows()]))


@pytest.mark.parametrize("size", [0.8, 1.0, 2.0, 100.0])
def test_quaternions_of_any_length_turn_as_far(tmp_path: Path, size: float) -> None:
    unit = turn(1.0)
    scaled = make("geometry_msgs/Quaternion", 0.0, 0.0, size * unit.z, size * unit.w)
    rows = [
        ("/odom", t, odometry(t, make("geometry_msgs/Pose", point(0.27 * t, 0.42 * t), scaled),
                              twist(0.5)))
        for t in TIMES
    ]  # fmt: skip
    found = read(write(tmp_path / "bag", [*rows, *marker_rows()]))
    assert found.robot is not None
    np.testing.assert_allclose(found.robot.theta, 1.0, atol=1e-9)


def test_a_topic_without_messages_in_an_mcap_may_lack_its_index(tmp_path: Path) -> None:
    bag = write(tmp_path / "bag", robot_rows())
    with Writer(tmp_path / "other", version=8, storage_plugin=StoragePlugin.MCAP) as made:
        made.add_connection("/odom", "nav_msgs/msg/Odometry", typestore=known_types())
        kind = "visualization_msgs/msg/MarkerArray"
        people = made.add_connection("/people", kind, typestore=known_types())
        data = known_types().serialize_cdr(array([]), kind)
        made.write(people, 10**9, data)
    with pytest.raises(InputError, match=r"/odom has no messages; if it should, .*mcap recover"):
        read(tmp_path / "other")
    assert reader.index_hint(bag)
    assert not reader.index_hint(_bag(tmp_path / "sqlite"))
