"""Frames of a robot's links in /tf_static, against the description they come from."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from crowdbot.core.recording.header import RecordingHeader, RobotHeader, with_frames
from crowdbot.core.recording.scenery import static_frames
from crowdbot.core.robots.description_file import read_description
from crowdbot.core.types.robot import RobotLimits
from crowdbot.core.types.sensor import SensorInfo

Array = NDArray[np.float64]


def _joint(kind: str, parent: str, child: str, xyz: str, rpy: str = "0 0 0") -> str:
    return (
        f'<joint name="{child}_joint" type="{kind}"><parent link="{parent}"/>'
        f'<child link="{child}"/><origin xyz="{xyz}" rpy="{rpy}"/><axis xyz="0 0 1"/></joint>'
    )


def _robot(*joints: str) -> str:
    names = sorted({part.split('"')[0] for j in joints for part in j.split('link="')[1:]})
    return (
        f'<robot name="r">{"".join(f"<link name={n!r}/>" for n in names)}{"".join(joints)}</robot>'
    )


ARM = _robot(
    _joint("fixed", "chassis", "mast", "0.1 0 0.4", "0.2 -0.3 0.5"),
    _joint("revolute", "mast", "elbow", "0 0 0.3", "0 1.2 0"),
    _joint("prismatic", "elbow", "finger", "0.05 0 0"),
    _joint("fixed", "finger", "nail", "0 0.01 0", "1 0 0"),
    _joint("continuous", "chassis", "caster", "-0.2 0 0.05"),
    _joint("fixed", "caster", "tyre", "0 0 0"),
    _joint("fixed", "mast", "eye", "0.02 0 0", "0 0 0.7"),
    _joint("fixed", "chassis", "base_link", "0 0 0.08"),
    _joint("fixed", "base_footprint", "chassis", "0 0 0.07"),
)
#: base_footprint hangs below the body, as in some published files.
HANGING = _robot(
    _joint("fixed", "base_link", "base_footprint", "0 0 -0.15"),
    _joint("fixed", "shell", "base_link", "0.1 0 -0.2", "0 0.3 0.1"),
    _joint("fixed", "shell", "flag", "0 0 1"),
)
LIMITS = RobotLimits(v_min=0.0, v_max=1.0, w_max=1.0, a_max=1.0, alpha_max=1.0)


def _frames(urdf: str, namespace: str = "", **sensors: SensorInfo) -> list[Any]:
    robot = RobotHeader(
        radius=0.2, mass=10.0, goal=None, base_height=0.15, limits=LIMITS, footprint=None
    )
    header = RecordingHeader(scenario="s", robot=robot, sensors=sensors, namespace=namespace)
    return static_frames(with_frames(header), urdf)


def _matrix(frame: Any) -> Array:
    q, at = frame.transform.rotation, frame.transform.translation
    x, y, z, w = q.x, q.y, q.z, q.w
    found = np.eye(4)
    found[:3, :3] = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    found[:3, 3] = at.x, at.y, at.z
    return found


def _seen_from(base: str, frames: Iterable[Any]) -> dict[str, Array]:
    """Poses of all frames below one; every frame has one parent."""
    parents = {f.child_frame_id: f for f in frames}
    found = {base: np.eye(4)}
    while more := {
        child: found[f.header.frame_id] @ _matrix(f)
        for child, f in parents.items()
        if child not in found and f.header.frame_id in found
    }:
        found |= more
    return found


@pytest.mark.parametrize(
    ("urdf", "links"),
    [
        (ARM, {"base_link", "chassis", "mast", "elbow", "finger", "nail", "eye"}),
        (HANGING, {"base_link", "shell", "flag"}),
    ],
    ids=["arm", "hanging"],
)
def test_each_link_is_where_the_description_has_it(urdf: str, links: set[str]) -> None:
    frames = _frames(urdf)
    children = [frame.child_frame_id for frame in frames]
    assert len(children) == len(set(children))
    poses = _seen_from("base_footprint", frames)
    assert set(poses) == {"base_footprint"} | links
    described = read_description(urdf)
    for link in links:
        assert poses[link] == pytest.approx(described.pose(link, "base_footprint"), abs=1e-9)


def test_a_sensor_on_a_link_keeps_its_frame_and_other_links_hang_from_it() -> None:
    urdf = _robot(
        _joint("fixed", "base_link", "eye", "0.3 0 0.2"), _joint("fixed", "eye", "lid", "0 0 0.1")
    )
    eye = SensorInfo(
        category="lidar", frame="eye", mount=(0.3, 0.0, 0.2, 0.0), rate=8.0, shape=(3,),
        ros_type="sensor_msgs/msg/LaserScan", angles=np.array([-0.1, 0.0, 0.1]),
    )  # fmt: skip
    frames = _frames(urdf, "a", eye=eye)
    parents = {f.child_frame_id: f.header.frame_id for f in frames}
    assert parents == {
        "a/odom": "map", "a/base_link": "a/base_footprint", "a/eye": "a/base_link",
        "a/lid": "a/eye",
    }  # fmt: skip


def test_without_further_links_nothing_is_added() -> None:
    wheels = _robot(
        _joint("continuous", "base_link", "wheel", "0 0.1 0"),
        _joint("fixed", "base_footprint", "base_link", "0 0 0.15"),
    )
    assert len(_frames(wheels)) == len(_frames("")) == 2
