"""Robots as their makers publish them: what is made of them, and what is said about it."""

from __future__ import annotations

import struct
from pathlib import Path

import numpy as np
import pytest

from crowdbot.core.robots.check import check_model
from crowdbot.errors import PluginError
from crowdbot.plugin import (
    DifferentialDrive,
    HolonomicDrive,
    PublishedWheel,
    RobotLimits,
    RobotModel,
    read_description,
    read_published,
)
from tests.core.robots.published_files import WHEELS, pepper, qolo

SHELL = """<collision><origin xyz="0 0 -0.3"/>
  <geometry><cylinder radius="0.27" length="0.9"/></geometry></collision>"""
CASTER = """<collision><origin xyz="-0.5 0 -0.12"/>
  <geometry><sphere radius="0.08"/></geometry></collision>"""
LIMITS = RobotLimits(v_min=-0.5, v_max=0.5, vy_max=0.5, w_max=2.0, a_max=0.5, alpha_max=3.0)
OMNI = dict.fromkeys(WHEELS, PublishedWheel(radius=0.07))
DRIVEN = {
    "to_wheel_right": PublishedWheel(radius=0.2, effort=60.0),
    "to_wheel_left": PublishedWheel(radius=0.2, effort=60.0),
}


def pepper_model() -> RobotModel:
    described = read_published(pepper(), wheels=OMNI, shell=SHELL)
    return RobotModel(
        description=described.text, base="base_link", base_height=0.82,
        drive=HolonomicDrive(max_force=70.0, max_torque=20.0, wheel_radius=0.07, track=0.31),
        limits=LIMITS, footprint_radius=0.27, height=1.21, force_height=0.6,
        mass=described.mass, notes=described.notes,
    )  # fmt: skip


def test_a_humanoid_on_three_omni_wheels() -> None:
    """Everything that is simplified is told, and what is left is a robot."""
    model = check_model(pepper_model())
    assert model.mass == pytest.approx(4.0 + 16.9 + 2 * (0.3 + 0.5 + 0.4 + 0.3) + 3 * 1.6, rel=1e-3)
    described = read_description(model.description)
    assert described.root == "base_link"
    assert described.pose("base_footprint", "base_link")[2, 3] == pytest.approx(-0.82)
    assert not any(joint.free for joint in described.joints.values())
    assert all(joint.kind == "fixed" for joint in described.joints.values())
    notes = "\n".join(model.notes)
    for expected in (
        "16 joints are held at zero: base_link_fixedjoint, HeadYaw, HeadPitch, HipRoll and 12 more",
        "24 joints that mimic others are held at zero: LFinger11, LFinger12, LFinger13, LFinger21",
        "3 wheels do not turn, they slide: WheelFL, WheelFR, WheelB",
        "collision meshes are not there and left out: package://pepper_meshes/torso.stl",
        "3 wheels touch the floor as spheres",
        "15 transmissions left out",
        "2 <gazebo> elements left out",
        "43 meshes for looks left out",
    ):
        assert expected in notes


def qolo_model() -> RobotModel:
    described = read_published(
        qolo(), wheels=DRIVEN, shell=SHELL.replace("-0.3", "0.4") + CASTER, base="tf_qolo"
    )
    # The names are exchanged: the left wheel is the one called right.
    drive = described.differential_drive("to_wheel_right", "to_wheel_left", base="tf_qolo")
    return RobotModel(
        description=described.text, base="tf_qolo",
        base_height=described.base_height(drive, base="tf_qolo"), drive=drive,
        limits=RobotLimits(v_min=-1, v_max=1, w_max=1, a_max=1, alpha_max=1),
        footprint_radius=0.27, height=1.7, force_height=0.6, mass=described.mass,
        notes=described.notes,
    )  # fmt: skip


def test_a_chair_with_fixed_wheels_is_made_to_drive() -> None:
    model = check_model(qolo_model())
    assert isinstance(model.drive, DifferentialDrive)
    assert model.drive.command_radius == 0.2
    assert model.drive.track == pytest.approx(0.54)
    described = read_description(model.description)
    notes = "\n".join(model.notes)
    assert "joint that is fixed is made to turn, as a driven wheel: to_wheel_right" in notes
    assert "wheel without a limit gets a torque of 60 N m: to_wheel_left" in notes
    assert "2 inertias are larger than bodies of their size and mass have: wheel_" in notes
    wheel = described.link("wheel_left").find("inertial/inertia")
    assert wheel is not None
    assert float(wheel.get("iyy", "")) == pytest.approx(0.5 * 1.5 * 0.2**2)
    with pytest.raises(
        PluginError, match=r"'to_wheel_left' is on the right of 'tf_qolo', .*xchange"
    ):
        described.differential_drive("to_wheel_left", "to_wheel_right", base="tf_qolo")


def _stl(path: Path, corners: np.ndarray[tuple[int, ...], np.dtype[np.float32]]) -> None:
    rows = b"".join(struct.pack("<12fH", 0, 0, 1, *t.ravel(), 0) for t in corners.reshape(-1, 3, 3))
    path.write_bytes(b"x" * 80 + struct.pack("<I", len(corners) // 3) + rows)


def test_a_mesh_that_is_there_becomes_its_box(tmp_path: Path) -> None:
    """Corners at (-1, 2, 0) to (3, 4, 10), a tenth of it: 0.4 x 0.2 x 1 m about (0.1, 0.3, 0.5)."""
    (tmp_path / "stl").mkdir()
    corners = np.array([[-1, 2, 0], [3, 4, 10], [0, 3, 1]], np.float32)
    _stl(tmp_path / "stl" / "bumper.stl", corners)
    text = "\n".join(f"vertex {x} {y} {z}" for x, y, z in corners.tolist())
    (tmp_path / "stl" / "tf_qolo.stl").write_text(f"solid a\n{text}\nendsolid")
    described = read_published(
        qolo(), wheels=DRIVEN, shell="", base="tf_qolo", packages={"qolo": tmp_path}
    )
    assert "2 collision meshes become the boxes around them: tf_qolo, bumper" in described.notes
    for name in ("bumper", "tf_qolo"):
        collision = described.link(name).find("collision")
        assert collision is not None
        box, origin = collision.find("geometry/box"), collision.find("origin")
        assert box is not None
        assert origin is not None
        size = [float(x) for x in box.get("size", "").split()]
        assert size == pytest.approx([0.4, 0.2, 1.0])
        assert [float(x) for x in origin.get("xyz", "").split()] == pytest.approx([0.1, 0.3, 0.5])


def test_links_of_another_tree_are_left_out() -> None:
    loose = '<link name="world"/><link name="stand"/>'
    joint = '<joint name="j" type="fixed"><parent link="world"/><child link="stand"/></joint>'
    text = qolo().replace("</robot>", f"{loose}{joint}</robot>")
    with pytest.raises(PluginError, match=r"collides as a mesh.*read_published"):
        read_description(text)
    described = read_published(text, wheels=DRIVEN, shell="", base="tf_qolo")
    assert described.root == "tf_qolo"
    assert (
        "2 links that do not hang together with the base are left out: world, stand"
        in described.notes
    )


def test_zero_inertia_is_replaced() -> None:
    text = qolo().replace('ixx="0.015" iyy="0.015" izz="0.015"', 'ixx="0" iyy="0" izz="0"')
    described = read_published(text, wheels=DRIVEN, shell="", base="tf_qolo")
    expected = "inertia is zero or of no body and replaced by that of a disc: bumper"
    assert expected in described.notes


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"wheels": {"to_whel_left": DRIVEN["to_wheel_left"]}}, "did you mean 'to_wheel_left'"),
        ({"base": "base_link"}, "no link 'base_link'; there are: tf_qolo"),
        ({"shell": "<visual/>"}, "holds <collision> elements"),
        ({"shell": "<collision>"}, "not well-formed"),
    ],
)
def test_what_does_not_fit_is_named(change: dict[str, object], message: str) -> None:
    fitting: dict[str, object] = {"wheels": DRIVEN, "shell": "", "base": "tf_qolo"}
    with pytest.raises(PluginError, match=message):
        read_published(qolo(), **{**fitting, **change})  # type: ignore[arg-type]


def test_macros_are_refused_with_what_to_do() -> None:
    space = 'xmlns:xacro="http://www.ros.org/wiki/xacro"'
    text = f'<robot name="r" {space}><xacro:include filename="a"/><link name="base_link"/></robot>'
    with pytest.raises(PluginError, match="xacro macros; expand them into a file: xacro ROBOT"):
        read_published(text, wheels={}, shell="")
