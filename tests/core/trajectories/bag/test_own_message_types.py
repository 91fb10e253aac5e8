"""Message types of one's own, whose definitions are in the bag."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from rosbags.rosbag2 import StoragePlugin, Writer
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

from crowdbot.errors import InputError
from tests.core.trajectories.bag.bag_kit import (
    TIMES,
    check_walkers,
    header,
    make,
    odometry,
    point,
    pose,
    read,
    twist,
    walkers,
)

#: Types -> their fields, the last one that of the topic; and how to make the list of people.
OWN: dict[str, tuple[dict[str, str], Callable[[Any, float], list[Any]]]] = {
    "plain numbers": (
        {
            "my_lab/msg/Human": "uint8 A=1\nint32 human_id\nfloat64 x\nfloat64 y\nstring[] tags",
            "my_lab/msg/All": "std_msgs/Header header\nmy_lab/Human[] humans",
        },
        lambda own, t: [own["my_lab/msg/Human"](i, x, y, ["a"]) for i, x, y in walkers(t)],
    ),
    "a stamped pose": (
        {
            "my_lab/msg/Body": "geometry_msgs/PoseStamped body\nint32 person_id",
            "my_lab/msg/All": "std_msgs/Header header\nmy_lab/Body[] seen",
        },
        lambda own, t: [
            own["my_lab/msg/Body"](make("geometry_msgs/PoseStamped", header(t), pose(x, y)), i)
            for i, x, y in walkers(t)
        ],
    ),
    "an array of fixed length": (
        {
            "my_lab/msg/Body": "geometry_msgs/Point where\nstring label",
            "my_lab/msg/All": "std_msgs/Header header\nmy_lab/Body[2] both",
        },
        lambda own, t: [own["my_lab/msg/Body"](point(x, y), f"p{i}") for i, x, y in walkers(t)],
    ),
    "no places": (
        {"my_lab/msg/All": "std_msgs/Header header\nstring[] names"},
        lambda _own, _t: ["a", "b"],
    ),
    "two lists": (
        {"my_lab/msg/All": "geometry_msgs/Point[] left\ngeometry_msgs/Point[] right"},
        lambda _own, t: [point(x, y) for _, x, y in walkers(t)],
    ),
}


def _bag(folder: Path, name: str, plugin: StoragePlugin = StoragePlugin.MCAP) -> Path:
    types, people = OWN[name]
    store: Any = get_typestore(Stores.ROS2_HUMBLE)
    found: dict[str, Any] = {}
    for kind, text in types.items():
        found.update(get_types_from_msg(text, kind))
    store.register(found)
    with Writer(folder, version=9, storage_plugin=plugin) as bag:
        odom = bag.add_connection("/odom", "nav_msgs/msg/Odometry", typestore=store)
        own = bag.add_connection("/humans", "my_lab/msg/All", typestore=store)
        for t in TIMES:
            stamp, listed = round(1e9 * t), people(store.types, t)
            moving = odometry(t, pose(0.5 * t, 0.0), twist(0.5))
            first = listed if name == "two lists" else header(t)
            message = store.types["my_lab/msg/All"](first, listed)
            bag.write(odom, stamp, store.serialize_cdr(moving, "nav_msgs/msg/Odometry"))
            bag.write(own, stamp, store.serialize_cdr(message, "my_lab/msg/All"))
    return folder


@pytest.mark.parametrize("name", ["plain numbers", "a stamped pose", "an array of fixed length"])
def test_people_are_found_by_their_places(tmp_path: Path, name: str) -> None:
    check_walkers(read(_bag(tmp_path / "bag", name), people="/humans"))


def test_definitions_in_sqlite(tmp_path: Path) -> None:
    bag = _bag(tmp_path / "bag", "plain numbers", StoragePlugin.SQLITE3)
    check_walkers(read(bag, people="/humans"))


@pytest.mark.parametrize(
    ("name", "fields"), [("no places", "header, names"), ("two lists", "left, right")]
)
def test_what_is_no_list_of_people_is_refused(tmp_path: Path, name: str, fields: str) -> None:
    with pytest.raises(InputError, match=f"no list of people.*; it has {fields}"):
        read(_bag(tmp_path / "bag", name), people="/humans")
