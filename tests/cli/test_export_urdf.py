"""URDF, read back by a parser of somebody else."""

from __future__ import annotations

import math
import warnings
from pathlib import Path

import numpy as np
import pytest

from crowdbot.cli import main
from crowdbot.core.interfaces import RobotModel
from crowdbot.core.registry.registry import discover
from crowdbot.core.robots import build_model
from crowdbot.core.robots.urdf_export import to_urdf
from crowdbot.core.support.atomic_write import atomic_write
from crowdbot.errors import CrowdbotError, InputError

with warnings.catch_warnings():
    warnings.simplefilter("ignore")
    from urdf_parser_py.urdf import URDF  # type: ignore[import-not-found,import-untyped,unused-ignore]

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
    assert main([*CHALLENGE, "--out", str(tmp_path / "no" / "robot.urdf")]) == 1
    assert str(tmp_path / "no" / "robot.urdf") in capsys.readouterr().err


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
        ("<box><size>1 2 3</size></box>", "<plane/>", "no shape like that of 'v'"),
        ("1 2 3 0.1", "1 2 3", "has 5 numbers"),
        ('<joint name="a" type="fixed">', '<joint name="a" type="fixed"><pose>1 0 0 0 0 0</pose>',
         "joint 'a' stands beside"),
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
