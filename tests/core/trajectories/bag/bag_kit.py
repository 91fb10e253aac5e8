"""Small bags of ROS 2 for tests: a robot that drives along x at 0.5 m/s, and two people."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from rosbags.rosbag2 import StoragePlugin, Writer

import crowdbot
from crowdbot.core.trajectories.bag.definitions import known_types

#: When the messages of a bag are sent, s.
TIMES: tuple[float, ...] = tuple(float(t) for t in np.round(np.arange(0.1, 5.0, 0.1), 3))
Row = tuple[str, float, Any]


def make(name: str, *values: Any) -> Any:
    """Return a message; ``name`` is ``package/Name``."""
    return known_types().types[name.replace("/", "/msg/")](*values)


def header(t: float, frame: str = "map") -> Any:
    ns = round(t * 1e9)
    stamp = make("builtin_interfaces/Time", ns // 10**9, ns % 10**9)
    return make("std_msgs/Header", stamp, frame)


def point(x: float, y: float, z: float = 0.0) -> Any:
    return make("geometry_msgs/Point", float(x), float(y), float(z))


def vector(x: float = 0.0, y: float = 0.0, z: float = 0.0) -> Any:
    return make("geometry_msgs/Vector3", float(x), float(y), float(z))


def turn(yaw: float) -> Any:
    return make("geometry_msgs/Quaternion", 0.0, 0.0, math.sin(yaw / 2), math.cos(yaw / 2))


def pose(x: float, y: float, yaw: float = 0.0) -> Any:
    return make("geometry_msgs/Pose", point(x, y), turn(yaw))


def twist(vx: float = 0.0, vy: float = 0.0, w: float = 0.0) -> Any:
    return make("geometry_msgs/Twist", vector(vx, vy), vector(0.0, 0.0, w))


def odometry(
    t: float, at: Any, velocity: Any, *, frame: str = "map", child: str = "base_link"
) -> Any:
    covariance = np.zeros(36)
    return make(
        "nav_msgs/Odometry", header(t, frame), child,
        make("geometry_msgs/PoseWithCovariance", at, covariance),
        make("geometry_msgs/TwistWithCovariance", velocity, covariance),
    )  # fmt: skip


def marker(
    t: float,
    number: int,
    at: tuple[float, float],
    *,
    kind: int = 3,
    action: int = 0,
    group: str = "people",
    points: Sequence[tuple[float, float]] = (),
    frame: str = "map",
) -> Any:
    none = np.zeros(0, np.uint8)
    return make(
        "visualization_msgs/Marker", header(t, frame), group, number, kind, action, pose(*at),
        vector(0.5, 0.5, 1.7), make("std_msgs/ColorRGBA", 0.0, 0.5, 1.0, 1.0),
        make("builtin_interfaces/Duration", 0, 0), False, [point(*p) for p in points], [], "",
        make("sensor_msgs/CompressedImage", header(t), "", none), [], "", "",
        make("visualization_msgs/MeshFile", "", none), False,
    )  # fmt: skip


def array(markers: Iterable[Any]) -> Any:
    return make("visualization_msgs/MarkerArray", list(markers))


def transform(
    t: float, parent: str, child: str, xyz: tuple[float, float, float], yaw: float = 0.0
) -> Any:
    at = make("geometry_msgs/Transform", vector(*xyz), turn(yaw))
    stamped = make("geometry_msgs/TransformStamped", header(t, parent), child, at)
    return make("tf2_msgs/TFMessage", [stamped])


def walkers(t: float) -> list[tuple[int, float, float]]:
    """One person comes towards the robot at y = 1, one stands at (4, -2)."""
    return [(1, 5.0 - 0.8 * t, 1.0), (2, 4.0, -2.0)]


def robot_rows(times: Sequence[float] = TIMES, frame: str = "map") -> list[Row]:
    return [("/odom", t, odometry(t, pose(0.5 * t, 0.0), twist(0.5), frame=frame)) for t in times]


def marker_rows(times: Sequence[float] = TIMES) -> list[Row]:
    return [("/people", t, array(marker(t, i, (x, y)) for i, x, y in walkers(t))) for t in times]


def write(folder: Path, rows: Iterable[Row], plugin: StoragePlugin = StoragePlugin.MCAP) -> Path:
    """Write a bag of topics, times of recording (s) and messages; return its folder."""
    with Writer(folder, version=8, storage_plugin=plugin) as bag:
        connections: dict[str, Any] = {}
        for topic, t, message in sorted(rows, key=lambda row: row[1]):
            kind = message.__msgtype__
            if topic not in connections:
                connections[topic] = bag.add_connection(topic, kind, typestore=known_types())
            data = known_types().serialize_cdr(message, kind)
            bag.write(connections[topic], round(t * 1e9), data)
    return folder


def read(bag: Path, **options: Any) -> crowdbot.Trajectories:
    """Read the bag's ``/odom`` and ``/people``."""
    given: dict[str, Any] = {
        "robot": "/odom",
        "people": "/people",
        "robot_radius": 0.2,
        "robot_mass": 20.0,
    }
    return crowdbot.Trajectories.from_rosbag(bag, **(given | options))


def check_walkers(run: crowdbot.Trajectories, ids: Sequence[int] | None = None) -> None:
    """Check that exactly the two people of `walkers` are there, where they should be."""
    assert run.agents is not None
    assert run.agents.x.shape[1] == 2
    if ids is not None:
        assert run.agents.id.tolist() == list(ids)
    start = run.t[0]
    for column, (first, y) in enumerate(((4.92, 1.0), (4.0, -2.0))):
        speed = -0.8 if column == 0 else 0.0
        x = run.agents.x[:, column]
        known = np.isfinite(x)
        assert known.sum() >= len(run.t) - 3
        np.testing.assert_allclose(x[known], (first + speed * (run.t - start))[known], atol=2e-3)
        np.testing.assert_allclose(run.agents.y[known, column], y, atol=2e-3)
