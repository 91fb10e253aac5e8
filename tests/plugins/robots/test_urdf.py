"""`kind: urdf`: robots from their URDF, with drive, wheels, outline, and sensors by link."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from crowdbot.core.registry.registry import discover
from crowdbot.core.robots.build import build_model, build_robot
from crowdbot.core.robots.description_file import read_description
from crowdbot.core.robots.task import sensor_infos
from crowdbot.core.scenarios.library import open_spec
from crowdbot.core.types.robot import RobotModel
from crowdbot.dsl.scenario.scenario import Scenario
from crowdbot.errors import InputError, PluginError, SpecError
from crowdbot.plugin import DifferentialDrive, HolonomicDrive
from tests.core.robots.published_files import WHEELS, pepper, qolo
from tests.paths import ROOT

REGISTRY = discover(allow=())
LIMITS = {"max_speed": 0.5, "max_yaw_rate": 1.0, "max_acceleration": 0.5, "max_yaw_acceleration": 2}
TROLLEY = (ROOT / "docs" / "howto" / "files" / "my_robots" / "trolley.urdf").read_text()
DRIVES: dict[str, dict[str, Any]] = {
    "trolley": {"left": "left_wheel_joint", "right": "right_wheel_joint", "radius": 0.08},
    "qolo": {"left": "to_wheel_right", "right": "to_wheel_left", "radius": 0.2},
}


def _scenario(folder: Path, text: str, sensors: str = "{}", **model: Any) -> Scenario:
    (folder / "robot.urdf").write_text(text, encoding="utf-8")
    fields = {"kind": "urdf", "file": "robot.urdf", **LIMITS, **model}
    document = f"""\
crowdbot: 1
scenario:
  id: x
  extends: ["builtin:parts/corridor_50x10.yaml"]
  robots:
    robot:
      model: {fields}
      sensors: {sensors}
      task: {{start: [2.5, 0, 0], goal: {{zone: robot_goal}}}}
"""
    (folder / "x.yaml").write_text(document.replace("'", '"').replace("None", "null"))
    return open_spec(str(folder / "x.yaml"), REGISTRY).scenarios[0]


def _model(folder: Path, text: str, **model: Any) -> RobotModel:
    return build_robot(REGISTRY, _scenario(folder, text, **model).robots["robot"])


def test_two_wheels_and_a_disc(tmp_path: Path) -> None:
    model = _model(
        tmp_path, TROLLEY, drive={**DRIVES["trolley"], "effort": 4},
        disc={"radius": 0.25, "height": 0.9},
    )  # fmt: skip
    assert isinstance(model.drive, DifferentialDrive)
    assert model.drive.track == pytest.approx(0.32)
    assert (model.footprint, model.footprint_radius, model.height) == (None, 0.25, 0.9)
    assert model.base_height == pytest.approx(0.08)
    assert model.limits.v_max == 0.5


def test_a_chair_with_a_box_and_a_caster(tmp_path: Path) -> None:
    model = _model(
        tmp_path, qolo(), base="tf_qolo", drive={**DRIVES["qolo"], "effort": 60},
        box={"length": 0.9, "width": 0.6, "height": 1.5, "x": -0.2},
        casters={"rear": {"x": -0.5, "radius": 0.08}},
    )  # fmt: skip
    assert model.footprint is not None
    np.testing.assert_allclose(model.footprint.min(axis=0), [-0.65, -0.3])
    assert any("made to turn, as a driven wheel" in note for note in model.notes)
    base = read_description(model.description).link("tf_qolo")
    names = {shape.get("name") for shape in base.findall("collision")}
    assert {"outline", "rear_caster"} <= names


def test_three_omni_wheels(tmp_path: Path) -> None:
    model = _model(
        tmp_path, pepper(), kind="urdf_holonomic", disc={"radius": 0.27, "height": 1.21},
        drive={"joints": list(WHEELS), "radius": 0.07, "max_force": 70.0, "max_torque": 20.0},
    )  # fmt: skip
    assert isinstance(model.drive, HolonomicDrive)
    assert model.base_height == pytest.approx(0.82, abs=0.05)
    assert model.limits.vy_max == 0.5


def _skid_steer() -> str:
    """A body on four driven wheels, as makers of outdoor robots publish them."""
    at = {"front_left": "0.13 0.19", "front_right": "0.13 -0.19",
          "rear_left": "-0.13 0.19", "rear_right": "-0.13 -0.19"}  # fmt: skip
    parts = [_body("base_link", 16.0, 0.4)]
    for name, place in at.items():
        parts.append(_body(f"{name}_wheel", 0.5, 0.002))
        parts.append(
            f'<joint name="{name}_joint" type="continuous"><parent link="base_link"/>'
            f'<child link="{name}_wheel"/><origin xyz="{place} 0.03"/><axis xyz="0 1 0"/></joint>'
        )
    return f'<robot name="skid">{"".join(parts)}</robot>'


def _body(name: str, mass: float, moment: float) -> str:
    inertia = f'<inertia ixx="{moment}" iyy="{moment}" izz="{moment}" ixy="0" ixz="0" iyz="0"/>'
    return f'<link name="{name}"><inertial><mass value="{mass}"/>{inertia}</inertial></link>'


def test_several_wheels_on_each_side(tmp_path: Path) -> None:
    sides = {s: [f"front_{s}_joint", f"rear_{s}_joint"] for s in ("left", "right")}
    model = _model(
        tmp_path, _skid_steer(), drive={**sides, "radius": 0.1, "effort": 5},
        box={"length": 0.5, "width": 0.43, "height": 0.25},
    )  # fmt: skip
    assert isinstance(model.drive, DifferentialDrive)
    assert model.drive.track == pytest.approx(0.38)
    assert any("4 driven wheels (skid steer) are approximated by two" in n for n in model.notes)
    left = read_description(model.description).joint("front_left_joint")
    assert left.effort == pytest.approx(10.0)
    with pytest.raises(SpecError, match="at least 1"):
        _model(tmp_path, _skid_steer(), drive={**sides, "left": [], "radius": 0.1, "effort": 5},
               disc={"radius": 0.25, "height": 0.3})  # fmt: skip


#: A name and a number given as properties, one by another, as in files of ROBOTIS.
PLAIN = """<robot name="trolley" xmlns:xacro="http://ros.org/wiki/xacro">
  <xacro:arg name="prefix" default=""/>
  <xacro:property name="before" value="$(arg prefix)"/>
  <xacro:property name="mast_mass" value="0.8"/>"""


def test_plain_properties_of_xacro_are_written_out(tmp_path: Path) -> None:
    text = TROLLEY.replace('value="0.8"', 'value="${mast_mass}"')
    text = text.replace('"base_link"', '"${before}base_link"')
    text = text.replace('<robot name="trolley">', PLAIN)
    assert all(use in text for use in ("${before}", "${mast_mass}"))
    fields = {"drive": {**DRIVES["trolley"], "effort": 4}, "disc": {"radius": 0.25, "height": 0.9}}
    model = _model(tmp_path, text, **fields)
    plain = _model(tmp_path, TROLLEY, **fields)
    expected = "3 of xacro's properties written out: prefix, before, mast_mass"
    assert model.notes == (expected, *plain.notes)
    assert model.mass == plain.mass
    assert (
        read_description(model.description).links.keys() == read_description(TROLLEY).links.keys()
    )
    for left in ("${before + 1}", "${unknown}"):
        with pytest.raises(PluginError, match="xacro macros; expand them"):
            _model(tmp_path, text.replace("${before}", left), **fields)
    alike = text.replace('name="before"', 'name="prefix"').replace("${before}", "${prefix}")
    model = _model(tmp_path, alike, **fields)  # as in files of TurtleBot3
    assert model.notes[0] == "2 of xacro's properties written out: prefix, mast_mass"


def test_names_in_sdformat_are_checked_at_their_place(tmp_path: Path) -> None:
    links = '<link name="chassis"/><link name="wheel"/><joint name="hinge" type="revolute"/>'
    text = f'<sdf version="1.6"><model name="cart">{links}</model></sdf>'
    drive = {"left": "hinge", "right": "hinge", "radius": 0.1, "effort": 4}
    fields: dict[str, Any] = {"drive": drive, "disc": {"radius": 0.25, "height": 0.9}}
    with pytest.raises(SpecError, match="no link 'base_link'; known: chassis, wheel"):
        _scenario(tmp_path, text, **fields)
    included = text.replace(links, links + "<include><uri>model://camera</uri></include>")
    _scenario(tmp_path, included, **fields)


def test_sensors_by_link(tmp_path: Path) -> None:
    model = {"drive": {**DRIVES["trolley"], "effort": 4}, "disc": {"radius": 0.25, "height": 0.9}}
    sensors = "{lidar: {kind: lidar2d, link: mast}, other: {kind: lidar2d, mount: {x: 0.1}}}"
    infos = sensor_infos(REGISTRY, _scenario(tmp_path, TROLLEY, sensors, **model), "robot")
    pose = read_description(TROLLEY).pose("mast", "base_link")
    assert infos["lidar"].mount == pytest.approx((*pose[:3, 3], 0.0))
    assert infos["other"].mount[0] == 0.1
    for wrong, message in (
        ("{lidar: {kind: lidar2d, link: mast, mount: {x: 1}}}", "has a mount, too"),
        ("{odometry: {kind: wheel_odometry, link: mast}}", "is not mounted on a link"),
        ("{bump: {kind: bumper, link: left_wheel}}", r"'left_wheel' is tilted \(roll -1.57"),
    ):
        scenario = _scenario(tmp_path, TROLLEY, wrong, **model)
        with pytest.raises((InputError, PluginError), match=message):
            sensor_infos(REGISTRY, scenario, "robot")


def test_wrong_documents(tmp_path: Path) -> None:
    drive = {**DRIVES["trolley"], "effort": 4}
    with pytest.raises(SpecError, match="either 'disc' or 'box'"):
        _scenario(tmp_path, TROLLEY, drive=drive)
    disc = {"radius": 0.25, "height": 0.9}
    wrong = {**drive, "left": "left_weel_joint"}
    expected = "no joint 'left_weel_joint'; did you mean 'left_wheel"
    with pytest.raises(SpecError, match=expected):
        _scenario(tmp_path, TROLLEY, drive=wrong, disc=disc)
    scenario = _scenario(tmp_path, TROLLEY + "<!-- xacro: -->", drive=wrong, disc=disc)
    with pytest.raises(PluginError, match=expected):
        build_model(REGISTRY, scenario.robots["robot"].model)
    (tmp_path / "robot.urdf").unlink()
    with pytest.raises(SpecError, match=r"robot\.urdf"):
        open_spec(str(tmp_path / "x.yaml"), REGISTRY)
