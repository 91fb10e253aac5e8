"""Arms that are held elsewhere than at zero, and what an arm to the side does to the wheels."""

from __future__ import annotations

import struct
from pathlib import Path

import numpy as np
import pytest

from crowdbot.core.robots.check import check_model
from crowdbot.errors import PluginError
from crowdbot.plugin import (
    Description,
    PublishedWheel,
    RobotLimits,
    RobotModel,
    read_description,
    read_published,
)

_BODY = """<inertial><mass value="{}"/>
  <inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial>"""
#: An arm of 1 m at shoulder height, to the right at zero; a rail; a thumb that mimics the shoulder.
ROBOT = f"""<robot name="arm">
  <link name="base_link">{_BODY.format(10)}</link>
  <link name="left">{_BODY.format(1)}</link><link name="right">{_BODY.format(1)}</link>
  <link name="upper"/><link name="hand">{_BODY.format(4)}</link><link name="thumb"/>
  <joint name="left_wheel" type="continuous"><axis xyz="0 1 0"/>
    <origin xyz="0 0.2 0.1"/><parent link="base_link"/><child link="left"/></joint>
  <joint name="right_wheel" type="continuous"><axis xyz="0 1 0"/>
    <origin xyz="0 -0.2 0.1"/><parent link="base_link"/><child link="right"/></joint>
  <joint name="shoulder" type="revolute"><axis xyz="0 0 1"/><limit lower="-1" upper="1.6"/>
    <origin xyz="0 0 1"/><parent link="base_link"/><child link="upper"/></joint>
  <joint name="rail" type="prismatic"><axis xyz="0 -1 0"/><limit lower="0" upper="0.5"/>
    <origin xyz="0 -1 0"/><parent link="upper"/><child link="hand"/></joint>
  <joint name="thumb_joint" type="revolute"><axis xyz="1 0 0"/>
    <mimic joint="shoulder" multiplier="-2" offset="0.5"/>
    <parent link="hand"/><child link="thumb"/></joint>
  <joint name="screw" type="fixed"><parent link="hand"/><child link="tip"/></joint>
  <link name="tip"/>
</robot>"""
WHEELS = dict.fromkeys(("left_wheel", "right_wheel"), PublishedWheel(radius=0.1, effort=5.0))
QUARTER = 0.5 * np.pi


def described(**positions: float) -> Description:
    return read_published(ROBOT, wheels=WHEELS, shell="", positions=positions)


def test_joints_are_held_where_it_is_said_and_those_that_mimic_follow() -> None:
    still = described()
    np.testing.assert_allclose(still.pose("hand", "base_link")[:3, 3], [0.0, -1.0, 1.0], atol=1e-9)
    assert "2 joints are held at zero: shoulder, rail" in still.notes
    moved = described(shoulder=QUARTER, rail=0.25)
    hand = moved.pose("hand", "base_link")
    np.testing.assert_allclose(hand[:3, 3], [1.25, 0.0, 1.0], atol=1e-9)
    np.testing.assert_allclose(hand[:3, 0], [0.0, 1.0, 0.0], atol=1e-9)
    thumb = moved.pose("thumb", "hand")
    angle = float(np.arctan2(thumb[2, 1], thumb[1, 1]))
    assert angle == pytest.approx(-2.0 * QUARTER + 0.5)
    assert not any("held at zero" in note for note in moved.notes)


def test_a_driven_wheel_that_mimics_another_keeps_its_axis_and_gets_a_motor() -> None:
    axis = '<joint name="right_wheel" type="continuous"><axis xyz="0 1 0"/>'
    text = ROBOT.replace(axis, f'{axis}<mimic joint="left_wheel"/>')
    made = read_published(text, wheels=WHEELS, shell="")
    assert "driven wheel has a motor of its own, and mimics none: right_wheel" in made.notes
    assert "joint that mimics another is held at zero: thumb_joint" in made.notes
    wheel = made.joint("right_wheel")
    assert (wheel.free, wheel.effort, wheel.axis.tolist()) == (True, 5.0, [0.0, 1.0, 0.0])


def test_positions_that_no_joint_can_have_are_errors() -> None:
    with pytest.raises(PluginError, match=r"no joint 'sholder'; did you mean 'shoulder'"):
        described(sholder=0.1)
    with pytest.raises(PluginError, match=r"'shoulder' goes from -1 to 1\.6, not to 2"):
        described(shoulder=2.0)
    with pytest.raises(PluginError, match="'screw' is fixed, and does not move"):
        described(screw=0.1)
    with pytest.raises(PluginError, match="'left_wheel' is a wheel"):
        described(left_wheel=0.1)


def test_an_arm_to_the_side_is_told_since_a_light_wheel_slips() -> None:
    def notes(made: Description) -> str:
        model = RobotModel(
            description=made.text, base="base_link", base_height=0.0,
            drive=made.differential_drive("left_wheel", "right_wheel", base="base_link"),
            limits=RobotLimits(v_min=-1.0, v_max=1.0, w_max=1.0, a_max=1.0, alpha_max=1.0),
            footprint_radius=0.3, height=1.0, force_height=0.5, mass=made.mass,
        )  # fmt: skip
        return "\n".join(check_model(model).notes)

    aside = described()
    assert aside.centre_of_mass("base_link") == pytest.approx([0.0, -4.0 / 16.0, 0.2625])
    expected = (
        "250 mm to the right of the middle between its wheels: 'left_wheel' bears little weight"
    )
    assert expected in notes(aside)
    assert "bears little weight" not in notes(described(shoulder=QUARTER))


@pytest.mark.parametrize("package", ["my_description", "meshes_of_others"])
def test_packages_are_found_above_and_beside_the_description(tmp_path: Path, package: str) -> None:
    folder = tmp_path / "share" / "my_description" / "urdf"
    folder.mkdir(parents=True)
    corners = np.array([[-1, 2, 0], [3, 4, 10], [0, 3, 1]], "<f4")
    rows = struct.pack("<12fH", 0, 0, 1, *corners.ravel().tolist(), 0)
    (tmp_path / "share" / package / "stl").mkdir(parents=True)
    stl = tmp_path / "share" / package / "stl" / "hand.stl"
    stl.write_bytes(b"x" * 80 + struct.pack("<I", 1) + rows)
    shapes = "".join(
        f'<collision><geometry><mesh filename="package://{package}/{rest}"/></geometry></collision>'
        for rest in ("stl/hand.stl", "stl/hand.dae", "../secret.stl", "stl/lost.stl")
    )
    (stl.parent / "hand.dae").write_text("<COLLADA/>", encoding="utf-8")
    (tmp_path / "share" / "secret.stl").write_bytes(stl.read_bytes())
    text = ROBOT.replace('<link name="tip"/>', f'<link name="tip">{shapes}</link>')
    (folder / "arm.urdf").write_text(text, encoding="utf-8")
    made = read_published(folder / "arm.urdf", wheels=WHEELS, shell="")
    notes = "\n".join(made.notes)
    assert "collision mesh becomes the box around it: tip" in notes
    assert (
        f"collision mesh is empty or neither STL nor OBJ, and left out: package://{package}/stl/hand.dae"
        in notes
    )
    lost = f"package://{package}/../secret.stl, package://{package}/stl/lost.stl"
    assert f"2 collision meshes are not there and left out: {lost}" in notes
    assert len(list(read_description(made.text).link("tip").iter("box"))) == 1
