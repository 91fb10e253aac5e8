"""URDF, read back by a parser of somebody else."""

from __future__ import annotations

import math
import warnings
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from crowdbot.cli import main
from crowdbot.core.registry.registry import discover
from crowdbot.core.robots.build import build_model
from crowdbot.core.robots.urdf_export import to_urdf
from crowdbot.core.scenarios.library import open_spec
from crowdbot.core.support.atomic_write import atomic_write
from crowdbot.errors import CrowdbotError, InputError
from crowdbot.plugin import RobotModel

with warnings.catch_warnings():
    warnings.simplefilter("ignore")
    from urdf_parser_py.urdf import URDF  # type: ignore[import-not-found,import-untyped,unused-ignore]

SEEN_FROM = {"lidar2d", "ultrasound", "rgbd_camera"}
CHALLENGE = ["export-urdf", "robot", "--spec", "challenge-2020"]


def _exported(capsys: pytest.CaptureFixture[str], *arguments: str) -> object:
    assert main(list(arguments)) == 0
    return URDF.from_xml_string(capsys.readouterr().out.encode())


def test_an_independent_parser_agrees(capsys: pytest.CaptureFixture[str]) -> None:
    robot = _exported(capsys, *CHALLENGE)
    links = {link.name: link for link in robot.links}  # type: ignore[attr-defined]
    joints = {joint.name: joint for joint in robot.joints}  # type: ignore[attr-defined]
    assert robot.get_root() == "base_footprint"  # type: ignore[attr-defined]
    masses = [x.inertial.mass for x in links.values() if x.inertial]
    assert sum(masses) == pytest.approx(6.3)
    for side, y in (("left", 0.115), ("right", -0.115)):
        wheel = joints[f"{side}_wheel_joint"]
        assert wheel.type == "continuous"
        assert wheel.origin.xyz == pytest.approx([0.0, y, 0.025])
        assert wheel.origin.rpy == pytest.approx([-math.pi / 2, 0.0, 0.0])
        assert wheel.axis == pytest.approx([0.0, 0.0, 1.0])
        assert wheel.limit.effort == 1.0
        assert wheel.limit.velocity == pytest.approx((0.65 + 0.115 * 3.14) / 0.0352)
    assert joints["base_footprint_joint"].origin.xyz == pytest.approx([0, 0, 0.0102])
    for name, x, yaw in (("front_lidar", 0.17, 0.0), ("rear_lidar", -0.17, math.pi)):
        mounted = joints[f"{name}_joint"]
        assert (mounted.parent, mounted.child) == ("base_link", name)
        assert mounted.origin.xyz == pytest.approx([x, 0.0, 0.24])
        assert mounted.origin.rpy == pytest.approx([0.0, 0.0, yaw])
    assert "odometry" not in links


@pytest.mark.parametrize("kind", ["pepper", "qolo", "cuybot", "smart_wheelchair"])
def test_every_robot_is_read_with_its_sensors_where_they_are(
    kind: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "one.yaml"
    file.write_text(f"""crowdbot: 1
scenario:
  id: one
  extends: ["builtin:parts/corridor_50x10.yaml", "builtin:parts/{kind}.yaml"]
  robots.robot.task: {{start: [2.5, 0, 0], goal: {{zone: robot_goal}}, time_limit: 9 s}}
""")
    registry = discover(allow=())
    values = open_spec(str(file), registry, ()).scenarios[0].robots["robot"]
    model: RobotModel = build_model(registry, values.model)
    robot: Any = _exported(capsys, "export-urdf", "robot", "--spec", str(file))
    links = {link.name: link for link in robot.links}
    joints = {joint.child: joint for joint in robot.joints}
    assert robot.get_root() == "base_footprint"
    assert sum(x.inertial.mass for x in links.values() if x.inertial) == pytest.approx(model.mass)
    assert sum(len(x.visuals) for x in links.values()) > 8
    assert joints["base_link"].origin.xyz == pytest.approx([0.0, 0.0, model.base_height])
    driven = [j for j in robot.joints if j.type == "continuous" and j.limit is not None]
    assert len(driven) == (0 if model.limits.vy_max > 0.0 else 2)
    placed = [n for n, sensor in values.sensors.items() if sensor.kind in SEEN_FROM]
    assert len(placed) == {"pepper": 5, "qolo": 3, "cuybot": 3, "smart_wheelchair": 15}[kind]
    for name in placed:
        sensor: Any = values.sensors[name]
        mount, joint = sensor.mount, joints[name]
        assert joint.parent == "base_link"
        assert joint.origin.xyz == pytest.approx([mount.x, mount.y, mount.z])
        assert joint.origin.rpy == pytest.approx([0.0, 0.0, mount.yaw])


def test_masses_are_those_of_the_plant(capsys: pytest.CaptureFixture[str]) -> None:
    """Drake reads the URDF too: another base frame, which leaves the determinant as it is."""
    from pydrake.multibody.parsing import Parser
    from pydrake.multibody.plant import MultibodyPlant

    model: RobotModel = build_model(discover(), discover().find("robot", "turtlebot2").spec())
    assert main(["export-urdf", "turtlebot2"]) == 0
    texts = {"sdf": model.description, "urdf": capsys.readouterr().out}
    found = {}
    for kind, text in texts.items():
        plant = MultibodyPlant(0.0)
        Parser(plant).AddModelsFromString(text, kind)
        plant.Finalize()
        found[kind] = np.linalg.det(plant.CalcMassMatrix(plant.CreateDefaultContext()))
    assert found["urdf"] == pytest.approx(found["sdf"], rel=1e-9)


def test_a_file_is_written_whole(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    target = tmp_path / "robot.urdf"
    assert main([*CHALLENGE, "--id", "in-d0125-slow-c01-r02", "--out", str(target)]) == 0
    assert URDF.from_xml_string(target.read_bytes()).name == "robot"
    assert [p.name for p in tmp_path.iterdir()] == ["robot.urdf"]
    assert main([*CHALLENGE, "--out", str(target / "robot.urdf")]) == 1  # a file, no folder
    assert f"{target / 'robot.urdf'}: cannot be written" in capsys.readouterr().err


@pytest.mark.slow
@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["turtlebot"], "unknown robot 'turtlebot'; did you mean 'turtlebot2'?"),
        (["robt", "--spec", "challenge-2020"], "unknown robot 'robt'; did you mean 'robot'?"),
        (["robot", "--spec", "challenge-2020", "--id", "x"], "unknown scenario 'x'"),
    ],
)
def test_unknown_names(
    arguments: list[str], message: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["export-urdf", *arguments]) == 1
    assert message in capsys.readouterr().err


def _model(sdf: str) -> RobotModel:
    from dataclasses import replace

    registry = discover()
    built: RobotModel = build_model(registry, registry.find("robot", "turtlebot2").spec())
    return replace(built, description=sdf)


NESTED = """<sdf version="1.9"><model name="m">
  <link name="base_link"/>
  <link name="arm"><pose relative_to="base_link">1 2 3 0.1 0.2 0.3</pose></link>
  <link name="hand"><pose relative_to="arm">0.5 0 0 0 0 1</pose>
    <visual name="v"><pose>0 0 1 0 0 0</pose><geometry><box><size>1 2 3</size></box></geometry>
      <material><diffuse>1 0 0 1</diffuse></material></visual></link>
  <joint name="a" type="fixed"><parent>base_link</parent><child>arm</child></joint>
  <joint name="b" type="revolute"><parent>base_link</parent><child>hand</child>
    <axis><xyz>0 1 0</xyz><limit><lower>-1</lower><upper>2</upper></limit></axis></joint>
</model></sdf>"""


def test_poses_are_taken_to_the_joints_parent() -> None:
    robot = URDF.from_xml_string(to_urdf(_model(NESTED), {}, "m").encode())
    joints = {joint.name: joint for joint in robot.joints}
    assert joints["a"].origin.xyz == pytest.approx([1, 2, 3])
    assert joints["a"].origin.rpy == pytest.approx([0.1, 0.2, 0.3])
    c, s = math.cos, math.sin
    ahead = [c(0.3) * c(0.2), s(0.3) * c(0.2), -s(0.2)]  # first column of the arm's rotation
    hand = joints["b"]
    assert hand.origin.xyz == pytest.approx(
        [a + 0.5 * d for a, d in zip((1, 2, 3), ahead, strict=True)]
    )
    assert (hand.limit.lower, hand.limit.upper) == (-1.0, 2.0)
    (link,) = [x for x in robot.links if x.name == "hand"]
    assert link.visual.geometry.size == pytest.approx([1, 2, 3])
    assert link.visual.material.color.rgba == pytest.approx([1, 0, 0, 1])


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("<parent>base_link</parent>", "<parent>body</parent>", "no link 'body'"),
        ("<box><size>1 2 3</size></box>", "<plane/>", "'v' has the shape 'plane', which"),
        ("1 2 3 0.1", "1 2 3", "has 5 numbers"),
    ],
)  # fmt: skip
def test_what_urdf_cannot_say(old: str, new: str, message: str) -> None:
    with pytest.raises(CrowdbotError, match=message):
        to_urdf(_model(NESTED.replace(old, new)), {}, "m")


def test_nothing_is_left_of_a_file_that_failed(tmp_path: Path) -> None:
    folder = tmp_path / "taken"
    folder.mkdir()
    with pytest.raises(InputError, match="taken: cannot be written"):
        atomic_write(folder, "text")
    assert [p.name for p in tmp_path.iterdir()] == ["taken"]


def test_a_link_without_looks_is_seen_as_what_it_collides_as() -> None:
    """Convex pieces as the boxes around them, turned and moved with their collision."""
    text = (
        '<robot name="r"><link name="base_link"><inertial><mass value="9"/><inertia ixx="1" '
        'iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>'
        '<collision name="a"><origin xyz="0 0 0.3"/><geometry><box size="1 2 3"/></geometry>'
        '</collision><collision><origin xyz="1 0 0" rpy="0 0 1.5707963267948966"/><geometry>'
        '<mesh filename="p.piece" corners="0 0 0 2 0 0 0 1 0 0 0 4"/></geometry></collision>'
        '</link><link name="mast"><visual><geometry><sphere radius="0.1"/></geometry></visual>'
        '<collision><geometry><sphere radius="0.2"/></geometry></collision></link>'
        '<joint name="j" type="fixed"><parent link="base_link"/><child link="mast"/></joint>'
        "</robot>"
    )
    plain = build_model(discover(), discover().find("robot", "cuybot").spec())
    model = replace(plain, description=text, base="base_link")
    robot = URDF.from_xml_string(to_urdf(model, {}, "r").encode())
    links = {link.name: link for link in robot.links}
    box, piece = links["base_link"].visuals
    assert (box.geometry.size, box.origin.xyz) == ([1, 2, 3], [0, 0, 0.3])
    assert piece.geometry.size == [2, 1, 4]
    assert piece.origin.xyz == pytest.approx([1 - 0.5, 1.0, 2.0])
    assert piece.origin.rpy == pytest.approx([0, 0, math.pi / 2])
    assert [v.geometry.radius for v in links["mast"].visuals] == [0.1]
