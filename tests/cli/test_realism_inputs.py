"""``crowdbot realism --reference`` takes every format of ``Trajectories.from_*``, and runs."""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from rosbags.rosbag2 import StoragePlugin, Writer
from rosbags.typesys import Stores, get_typestore

from crowdbot.core.realism.recordings import read_runs, read_tracks
from crowdbot.core.types.arrays import Array
from crowdbot.errors import InputError, UnknownNameError
from tests.core.recording.recording_cases import random_run, write_run


@cache
def people() -> Array:
    """(T, N, 2) m at 4 Hz: twelve people who walk side by side, behind each other."""
    place = np.array([[2.0 * k, y] for k in range(4) for y in (-1.3, 0.0, 1.3)])
    speed = 1.2 + 0.02 * np.arange(12)
    t = 0.25 * np.arange(20)
    way = np.stack([t[:, np.newaxis] * speed, np.zeros((20, 12))], axis=-1)
    return np.asarray(place + way)


def rows() -> list[tuple[int, int, float, float]]:
    """Frame, id, x and y of each."""
    at = people()
    return [
        (k, n, float(at[k, n, 0]), float(at[k, n, 1]))
        for k in range(len(at))
        for n in range(at.shape[1])
    ]


def as_table(folder: Path) -> Path:
    path = folder / "people.csv"
    lines = [f"{0.25 * k},{n},{x:.4f},{y:.4f}" for k, n, x, y in rows()]
    path.write_text("\n".join(["t,id,x,y", *lines]) + "\n", encoding="utf-8")
    return path


def as_trajnet(folder: Path) -> Path:
    path = folder / "people.ndjson"
    scene = {"scene": {"id": 0, "p": 0, "s": 0, "e": len(people()) - 1, "fps": 4.0}}
    tracks = [{"track": {"f": k, "p": n, "x": x, "y": y}} for k, n, x, y in rows()]
    path.write_text("\n".join(map(json.dumps, [scene, *tracks])) + "\n", encoding="utf-8")
    return path


def as_rows_of_ucy(folder: Path) -> Path:
    path = folder / "people.txt"
    lines = [f"{10 * k}\t{n}\t{x:.4f}\t{y:.4f}" for k, n, x, y in rows()]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return path


def bag(folder: Path, storage: StoragePlugin, topics: tuple[str, ...] = ("/crowd",)) -> Path:
    store = get_typestore(Stores.ROS2_HUMBLE)
    kinds = store.types
    turn = kinds["geometry_msgs/msg/Quaternion"](x=0.0, y=0.0, z=0.0, w=1.0)
    point, pose = kinds["geometry_msgs/msg/Point"], kinds["geometry_msgs/msg/Pose"]
    with Writer(folder / "bag", version=8, storage_plugin=storage) as writer:
        name = "geometry_msgs/msg/PoseArray"
        known = [writer.add_connection(t, name, typestore=store) for t in topics]
        words = writer.add_connection("/said", "std_msgs/msg/String", typestore=store)
        for k, at in enumerate(people()):
            stamp = kinds["builtin_interfaces/msg/Time"](
                sec=10 + k // 4, nanosec=250_000_000 * (k % 4)
            )
            header = kinds["std_msgs/msg/Header"](stamp=stamp, frame_id="map")
            poses = [pose(point(x=float(x), y=float(y), z=0.0), turn) for x, y in at]
            data = store.serialize_cdr(kinds[name](header, poses), name)
            for connection in known:
                writer.write(connection, 250_000_000 * (40 + k), data)
            values = kinds["std_msgs/msg/String"](data="on we go")
            writer.write(words, 250_000_000 * (40 + k), store.serialize_cdr(values, words.msgtype))
    return folder / "bag"


def as_bag(folder: Path) -> Path:
    return bag(folder, StoragePlugin.SQLITE3)


def as_file_of_a_bag(folder: Path) -> Path:
    return next(bag(folder, StoragePlugin.MCAP).glob("*.mcap"))


def as_topic(folder: Path) -> Path:
    made = bag(folder, StoragePlugin.SQLITE3, ("/crowd", "/guess"))
    return Path(f"{made}:/crowd")


FORMATS = [as_table, as_trajnet, as_rows_of_ucy, as_bag, as_file_of_a_bag, as_topic]


@pytest.mark.parametrize("written", FORMATS)
def test_every_format_says_the_same(written: Callable[[Path], Path], tmp_path: Path) -> None:
    found = read_tracks(written(tmp_path))
    step = np.diff(found.way, axis=0)
    speed = np.hypot(step[..., 0], step[..., 1])
    own = np.diff(people(), axis=0)
    share = 0.25 / 0.4 if written is as_rows_of_ucy else 1.0  # their annotations are 0.4 s apart
    expected = share * np.nanmean(np.hypot(own[..., 0], own[..., 1]))
    assert np.nanmean(speed) == pytest.approx(expected, rel=0.02)
    assert found.way.shape[1] == people().shape[1]
    assert math.isclose(found.width, 3.0, abs_tol=0.1)


def test_runs_without_people_are_left_out(tmp_path: Path) -> None:
    at = np.moveaxis(people(), 1, 2)  # (T, 2, N)
    states = np.concatenate([at, np.zeros_like(at)], axis=1)
    t: Array = 0.25 * np.arange(len(at), dtype=np.float64)
    full, alone = tmp_path / "full.mcap", tmp_path / "alone.mcap"
    write_run(full, replace(random_run(), t=t, robot=None, agents=states, jump=None))
    write_run(alone, random_run(m=0))
    found, without = read_runs([full, alone])
    assert [t.way.shape[1] for t in found] == [at.shape[2]]
    assert len(without) == 1
    assert "alone.mcap: there are no people" in without[0]
    with pytest.raises(InputError, match=r"alone\.mcap: there are no people"):
        read_runs([alone])


def test_what_is_not_a_reference(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"people\.xls: no such file"):
        read_tracks(tmp_path / "people.xls")
    (tmp_path / "people.xls").write_text("?", encoding="utf-8")
    with pytest.raises(InputError, match=r"people\.xls: not a recording .*TrajNet"):
        read_tracks(tmp_path / "people.xls")
    with pytest.raises(InputError, match=r"not a bag of ROS: it has no metadata\.yaml"):
        read_tracks(tmp_path)
    (tmp_path / "torn.mcap").write_bytes(b"\x89MCAP0\r\n")
    with pytest.raises(InputError, match=r"torn\.mcap"):
        read_tracks(tmp_path / "torn.mcap")


def test_topics_of_a_bag_are_told(tmp_path: Path) -> None:
    made = bag(tmp_path, StoragePlugin.SQLITE3, ("/crowd", "/guess"))
    with pytest.raises(InputError, match=r"which topic.*people are in /crowd, /guess"):
        read_tracks(made)
    with pytest.raises(UnknownNameError, match="crowds"):
        read_tracks(Path(f"{made}:/crowds"))
    with pytest.raises(InputError, match="no such file"):
        read_tracks(Path(f"{tmp_path / 'none'}:/crowd"))
