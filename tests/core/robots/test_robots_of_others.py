"""Descriptions as others write them: frames, casters, axles, four driven wheels, damping."""

from __future__ import annotations

from dataclasses import replace
from xml.etree import ElementTree as Xml

import numpy as np
import pytest

from crowdbot.core.robots.check import check_model
from crowdbot.core.robots.xml import matrix
from crowdbot.errors import PluginError
from crowdbot.plugin import (
    Command,
    Description,
    DifferentialDrive,
    PublishedWheel,
    RobotLimits,
    RobotModel,
    read_description,
    read_published,
)
from crowdbot.testing.commanded_motion import drive

WHEELS = "differential_drive"
SHELL = """<collision><origin xyz="0 0 0.15"/>
  <geometry><cylinder radius="0.25" length="0.15"/></geometry></collision>"""
CASTER = """<collision><origin xyz="-0.2 0 0.02"/>
  <geometry><sphere radius="0.02"/></geometry></collision>"""
WHEEL_SHAPE = "<geometry><cylinder><radius>0.05</radius><length>0.02</length></cylinder></geometry>"


def _inertial(mass: float, moment: float, pose: str = "0 0 0 0 0 0") -> str:
    moments = "".join(f"<{n}>{moment if n[1] == n[2] else 0}</{n}>"
                      for n in ("ixx", "iyy", "izz", "ixy", "ixz", "iyz"))  # fmt: skip
    return (
        f"<inertial><pose>{pose}</pose><mass>{mass}</mass><inertia>{moments}</inertia></inertial>"
    )


def _cart(*, wheel: str, joint: str, axis: str = "<xyz>0 0 1</xyz>", more: str = "") -> str:
    """A cart in SDFormat; ``{y}`` is the side of a wheel in ``wheel`` and ``joint``."""
    text = (
        f'<sdf version="1.9"><model name="cart"><link name="base_link">{_inertial(8, 0.1)}'
        '<collision name="body"><pose>0 0 0.15 0 0 0</pose><geometry><cylinder><radius>0.2</radius>'
        "<length>0.2</length></cylinder></geometry></collision></link>"
        f'<link name="ball"><pose>-0.15 0 0.02 0 0 0</pose>{_inertial(0.05, 1e-5)}'
        '<collision name="c"><geometry><sphere><radius>0.02</radius></sphere></geometry>'
        '</collision></link><joint name="caster" type="ball"><parent>base_link</parent>'
        f"<child>ball</child></joint>{more}"
    )
    for name, y in (("left", 0.15), ("right", -0.15)):
        text += (
            f'<link name="{name}_wheel">{wheel.format(y=y)}</link><joint name="{name}" '
            f'type="revolute"><parent>base_link</parent><child>{name}_wheel</child>'
            f"{joint.format(y=y)}<axis>{axis}<limit><effort>5</effort></limit></axis></joint>"
        )
    return text + "</model></sdf>"


_SHAPE = '<collision name="c"><pose>{at} -1.570796327 0 0</pose>' + WHEEL_SHAPE + "</collision>"
_ORIGIN = _SHAPE.replace("{at}", "0 0 0")
_AT_AXLE = "<pose>0 {y} 0.05 0 0 0</pose>" + _inertial(0.4, 5e-4) + _ORIGIN
_AT_MODEL = _inertial(0.4, 5e-4, "0 {y} 0.05 0 0 0") + _SHAPE.replace("{at}", "0 {y} 0.05")
_IN_FRAME = '<pose relative_to="axle">0 {y} 0 0 0 0</pose>' + _AT_AXLE.partition("</pose>")[2]
_FRAMES = """<frame name="chassis"><pose>0 0 0.03 0 0 0.5</pose></frame>
<frame name="axle" attached_to="chassis">
<pose relative_to="chassis">0 0 0.02 0 0 -0.5</pose></frame>"""
_TURNED = "<pose>{x} -1.570796327 0 0</pose>"
#: Ways to write the same cart.
CARTS = {
    "links at the axle": _cart(wheel=_AT_AXLE, joint=_TURNED.format(x="0 0 0")),
    "links at the model's origin": _cart(wheel=_AT_MODEL, joint=_TURNED.format(x="0 {y} 0.05")),
    "nested frames": _cart(wheel=_IN_FRAME, joint=_TURNED.format(x="0 0 0"), more=_FRAMES),
    "joints in the model": _cart(
        wheel=_AT_MODEL,
        joint='<pose relative_to="__model__">0 {y} 0.05 -1.570796327 0 0</pose>',
    ),
    "axes in the model": _cart(
        wheel=_AT_AXLE, joint="", axis='<xyz expressed_in="__model__">0 1 0</xyz>'
    ),
    "axes of a parent": _cart(
        wheel=_AT_AXLE, joint="",
        axis="<xyz>0 1 0</xyz><use_parent_model_frame>1</use_parent_model_frame>",
    ),
}  # fmt: skip
#: Both wheels in a model of their own, in the world of a file; it hangs lower, and is turned.
NESTED = (
    CARTS["links at the axle"]
    .replace('<sdf version="1.9">', '<sdf version="1.9"><world name="w">')
    .replace("</model></sdf>", "</model></world></sdf>")
    .replace('<link name="left_wheel">', '<model name="drive"><pose>0 0 0.02 0 0 1</pose>'
             '<frame name="low"><pose>0 0 -0.02 0 0 -1</pose></frame><link name="left_wheel">')
    .replace("<pose>0 0.15 0.05", '<pose relative_to="low">0 0.15 0.05')
    .replace("<pose>0 -0.15 0.05", '<pose relative_to="low">0 -0.15 0.05')
    .replace("</link><joint name=\"left\"", "</link></model><joint name=\"left\"")
    .replace('<link name="right_wheel">', '<model name="drive2"><frame name="low"/>'
             '<link name="right_wheel">')
    .replace("</link><joint name=\"right\"", "</link></model><joint name=\"right\"")
    .replace("<child>left_wheel", "<child>drive::left_wheel")
    .replace("<child>right_wheel", "<child>drive2::right_wheel")
)  # fmt: skip
LIMITS = RobotLimits(v_min=-0.3, v_max=0.6, w_max=1.5, a_max=1.0, alpha_max=3.0)


def _model(found: Description, text: str, left: str = "left", right: str = "right") -> RobotModel:
    drive_ = found.differential_drive(left, right)
    return RobotModel(
        description=text, base="base_link", base_height=found.base_height(drive_), drive=drive_,
        limits=LIMITS, footprint_radius=0.2, height=0.4, force_height=0.2, mass=found.mass,
        notes=found.notes,
    )  # fmt: skip


@pytest.mark.parametrize("name", CARTS)
def test_frames_of_sdformat(name: str) -> None:
    found = read_description(CARTS[name])
    model = check_model(_model(found, CARTS[name]))
    assert isinstance(model.drive, DifferentialDrive)
    assert model.drive.track == pytest.approx(0.3)
    assert model.base_height == pytest.approx(0.0)
    assert found.pose("left_wheel", "base_link")[:3, 3] == pytest.approx([0.0, 0.15, 0.05])
    assert any("ball joint is held; its caster slides: caster" in note for note in model.notes)


def test_models_inside_a_model() -> None:
    found = read_description(NESTED)
    model = check_model(_model(found, NESTED))
    assert isinstance(model.drive, DifferentialDrive)
    assert (model.drive.track, model.base_height) == pytest.approx((0.3, 0.0))
    left = found.pose("drive__left_wheel", "base_link")
    assert left == pytest.approx(read_description(CARTS["links at the axle"]).pose(
        "left_wheel", "base_link"), abs=1e-9)  # fmt: skip
    assert any("drive__PART, drive2__PART" in note for note in found.notes)
    last = drive(model, WHEELS, Command(0.2, 0.5), 1.0)[-1]
    assert last.yaw > 0.2


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("<frame", "<include><uri>model://arm</uri></include><frame", "includes 'model://arm'"),
        ('"drive2"', '"drive2" placement_frame="low"', "'drive2' is placed by its frame 'low'"),
        ('</world>', '<model name="box"/></world>', "2 models, not one robot: 'cart', 'box'"),
    ],
)  # fmt: skip
def test_models_that_are_not_inside(old: str, new: str, message: str) -> None:
    with pytest.raises(PluginError, match=message):
        read_description(NESTED.replace(old, new, 1))


def test_frames_that_are_not_there() -> None:
    for old, new, message in (
        ('relative_to="axle"', 'relative_to="axel"', "'axel', .* did you mean 'axle'"),
        ('relative_to="chassis"', 'relative_to="axle"', "'axle' is relative to itself"),
    ):
        with pytest.raises(PluginError, match=message):
            read_description(CARTS["nested frames"].replace(old, new))


@pytest.mark.parametrize("name", ["links at the model's origin", "axes in the model"])
def test_frames_of_sdformat_drive_alike(name: str) -> None:
    last = [
        drive(_model(read_description(CARTS[n]), CARTS[n]), WHEELS, Command(0.2, 0.5), 1.0)[-1]
        for n in (name, "links at the axle")
    ]
    assert last[0] == pytest.approx(last[1], abs=1e-4)
    assert last[0].yaw > 0.2


def test_sdformat_is_made_drivable_too() -> None:
    wheels = dict.fromkeys(("left", "right"), PublishedWheel(0.05, 5.0))
    found = read_published(CARTS["links at the model's origin"], wheels=wheels, shell=SHELL)
    assert found.format == "urdf"
    model = check_model(_model(found, found.text))
    assert isinstance(model.drive, DifferentialDrive)
    assert model.drive.track == pytest.approx(0.3)
    assert any("ball joint" in note for note in model.notes)
    assert drive(model, WHEELS, Command(0.2, 0.5), 1.0)[-1].yaw > 0.2  # Drake reads it


def test_a_link_on_a_fixed_joint_keeps_its_frame() -> None:
    mast = (
        f'<link name="mast"><pose>0 0 0.5 0 0 0</pose>{_inertial(0.1, 1e-4)}</link>'
        '<joint name="on" type="fixed"><pose>0 0 -0.3 0 0 0</pose><parent>base_link</parent>'
        "<child>mast</child></joint>"
    )
    found = read_description(_cart(wheel=_AT_AXLE, joint=_TURNED.format(x="0 0 0"), more=mast))
    assert found.pose("mast", "base_link")[:3, 3] == pytest.approx([0.0, 0.0, 0.5])


# --------------------------------------------------------------------------------- URDF
def _base(x: float, places: dict[str, tuple[float, float]], *, damping: float = 0.0) -> str:
    """A base in URDF whose wheels are ``x`` ahead of base_link."""
    text = (
        '<robot name="base"><link name="base_footprint"/><joint name="foot" type="fixed">'
        '<parent link="base_footprint"/><child link="base_link"/><origin xyz="0 0 0.1"/></joint>'
        '<link name="base_link"><inertial><origin xyz="0 0 0.1"/><mass value="10"/><inertia '
        'ixx="0.2" iyy="0.2" izz="0.3" ixy="0" ixz="0" iyz="0"/></inertial></link>'
    )
    for name, (ahead, y) in places.items():
        text += (
            f'<link name="{name}_wheel"><inertial><mass value="1"/><inertia ixx="0.001" '
            'iyy="0.001" izz="0.001" ixy="0" ixz="0" iyz="0"/></inertial></link>'
            f'<joint name="{name}" type="continuous"><parent link="base_link"/>'
            f'<child link="{name}_wheel"/><origin xyz="{x + ahead} {y} -0.04"/><axis xyz="0 1 0"/>'
            f'<limit effort="8" velocity="30"/><dynamics damping="{damping}"/></joint>'
        )
    return text + "</robot>"


TWO = {"left": (0.0, 0.18), "right": (0.0, -0.18)}
FOUR = {"front_left": (0.15, 0.2), "front_right": (0.15, -0.2),
        "rear_left": (-0.15, 0.2), "rear_right": (-0.15, -0.2)}  # fmt: skip


def _published(text: str, shell: str = SHELL + CASTER) -> Description:
    names = [name for name in (*TWO, *FOUR) if f'"{name}"' in text]
    wheels = dict.fromkeys(names, PublishedWheel(0.06, 8.0))
    return read_published(text, wheels=wheels, shell=shell)


@pytest.mark.parametrize("axis", ['<axis xyz="0 -1 0"/>', '<axis xyz="0 0 0"/>', ""])
def test_wheels_that_would_drive_back_or_not_at_all(axis: str) -> None:
    text = _base(0.0, TWO).replace('<axis xyz="0 1 0"/>', axis)
    if "-1" not in axis:
        text = text.replace("continuous", "fixed")
    found = _published(text)
    model = check_model(_model(found, found.text))
    expected = "reversed, so that it drives ahead" if "-1" in axis else "fixed is made to turn"
    assert sum(expected in note for note in model.notes) == 2
    assert drive(model, WHEELS, Command(0.3, 0.0), 1.0)[-1].x > 0.1


def test_wheels_along_the_robot_or_exchanged_or_at_two_heights_are_told() -> None:
    along = _published(_base(0.0, {"left": (0.2, 0.0), "right": (-0.2, -0.01)}))
    with pytest.raises(PluginError, match="lie along the x axis of 'base_link'"):
        _model(along, along.text)
    two = _base(0.0, TWO)
    with pytest.raises(PluginError, match=r"'right' is on the right .* 'left' on its left: exch"):
        _model(_published(two), two, left="right", right="left")
    uneven = _published(two.replace("-0.18 -0.04", "-0.18 -0.05"))
    with pytest.raises(PluginError, match="'left' and 'right' are 10 mm apart in height"):
        check_model(_model(uneven, uneven.text))


@pytest.mark.parametrize("rpy", ["0 0 0", "-1.570796327 0 0", "1.570796327 0 0.3"])
def test_a_wheel_beside_its_joint_stands_where_its_shape_is(rpy: str) -> None:
    text = _base(0.0, TWO)
    for side in (1.0, -1.0):  # a wheel's own frame is turned; its shape lies outside of the joint
        turn = matrix([0.0, 0.0, 0.0, *(float(x) for x in rpy.split())])[:3, :3]
        x, y, z = turn.T @ (0.0, 0.02 * side, 0.0)
        ax, ay, az = turn.T @ (0.0, 1.0, 0.0)
        old = f'{0.18 * side} -0.04"/><axis xyz="0 1 0"/>'
        text = text.replace(old, f'{0.18 * side} -0.04" rpy="{rpy}"/><axis xyz="{ax} {ay} {az}"/>')
        name = "left" if side > 0 else "right"
        shape = (
            f'<collision><origin xyz="{x} {y} {z}"/><geometry><sphere radius="0.06"/></geometry>'
        )
        text = text.replace(
            f'<link name="{name}_wheel">', f'<link name="{name}_wheel">{shape}</collision>'
        )
    found = _published(text)
    model = check_model(_model(found, found.text))
    assert isinstance(model.drive, DifferentialDrive)
    assert model.drive.track == pytest.approx(0.4)
    assert "the middle of the wheel is 20 mm to the left of its joint: left" in found.notes
    assert drive(model, WHEELS, Command(0.0, 0.5), 1.0)[-1].yaw == pytest.approx(0.4, abs=0.1)


def test_negative_limits_stand_for_none() -> None:
    text = (
        _base(0.0, TWO)
        .replace('velocity="30"', 'velocity="-1"')
        .replace('effort="8"', 'effort="-1"')
    )
    with pytest.raises(PluginError, match="'left' has the velocity limit -1; leave it out"):
        read_description(text)
    found = _published(text)
    assert drive(_model(found, found.text), WHEELS, Command(0.3, 0.0), 1.0)[-1].x > 0.1
    sdf = CARTS["links at the axle"].replace(
        "<effort>5</effort>", "<effort>-1</effort><velocity>-1</velocity>"
    )
    wheels = dict.fromkeys(("left", "right"), PublishedWheel(0.05, 5.0))
    made = read_published(sdf, wheels=wheels, shell=SHELL)
    assert drive(_model(made, made.text), WHEELS, Command(0.2, 0.0), 1.0)[-1].x > 0.05


def test_a_link_with_two_inertias_is_told() -> None:
    text = _base(0.0, TWO).replace("</inertial></link>", '</inertial><inertial><mass value="0.5"/>'
        '<inertia ixx="0.1" iyy="0.1" izz="0.1"/></inertial></link>', 1)  # fmt: skip
    with pytest.raises(PluginError, match="'base_link' has several <inertial>; add them up"):
        read_description(text)
    found = _published(text)
    assert found.mass == pytest.approx(12.0)
    assert "link has a further <inertial>, which is left out: base_link" in found.notes


def test_descriptions_without_a_mass_or_a_name() -> None:
    bare = _base(0.0, TWO)
    while "<inertial>" in bare:
        before, rest = bare.split("<inertial>", 1)
        bare = before + rest.split("</inertial>", 1)[1]
    with pytest.raises(PluginError, match="no link of the robot's description has a mass: write"):
        _published(bare)
    nameless = _base(0.0, TWO).replace(' name="base">', ">", 1)
    with pytest.raises(PluginError, match="has no name: write <robot name="):
        read_description(nameless)
    assert _published(nameless).model.get("name") == "robot"


@pytest.mark.parametrize("x", [0.0013, 0.04, -0.02])
def test_an_axle_beside_the_base(x: float) -> None:
    found = _published(_base(x, TWO))
    note = f"'base_link' is moved {1e3 * abs(x):.3g} mm {'ahead' if x > 0 else 'back'}"
    assert any(note in text for text in found.notes)
    model = check_model(_model(found, found.text))
    described = read_description(model.description)
    assert described.pose("left_wheel", "base_link")[0, 3] == pytest.approx(0.0, abs=1e-9)
    assert described.pose("base_footprint", "base_link")[:3, 3] == pytest.approx([0, 0, -0.1])
    inertial = described.link("base_link").find("inertial/origin")
    assert inertial is not None
    assert float(inertial.get("xyz", "").split()[0]) == pytest.approx(-x)


def test_an_axle_beside_the_base_of_a_description() -> None:
    """Some millimetres are told; more are refused."""
    text = _published(_base(0.0, TWO)).text
    model = _model(read_description(text), text)
    off = replace(
        model,
        description=text.replace('"0.0 0.18', '"0.002 0.18').replace('"0.0 -0.18', '"0.002 -0.18'),
    )
    assert off.description != text
    assert "the axle is 2 mm ahead of 'base_link'" in "".join(check_model(off).notes)
    far = replace(model, description=off.description.replace("0.002", "0.02"))
    with pytest.raises(PluginError, match=r"0\.02 m ahead of 'base_link'.*read_published moves it"):
        check_model(far)


def test_four_driven_wheels() -> None:
    found = _published(_base(0.0, FOUR), SHELL)
    assert any("4 driven wheels (skid steer) are approximated by two" in n for n in found.notes)
    model = check_model(_model(found, found.text, "front_left", "front_right"))
    described = read_description(model.description)
    assert described.joint("front_left").effort == 16.0
    assert described.pose("front_left_wheel", "base_link")[:2, 3] == pytest.approx([0.0, 0.2])
    last = drive(model, WHEELS, Command(0.3, 0.4), 2.0)[-1]
    assert last.tilt < 0.02
    assert last.w == pytest.approx(0.4, abs=0.02)
    assert np.hypot(last.vx, last.vy) == pytest.approx(0.3, abs=0.01)


def test_four_driven_wheels_of_a_description() -> None:
    text = _published(_base(0.0, TWO)).text
    model = _model(read_description(text), text)
    four = _base(0.0, FOUR).replace(
        "</inertial></link>",
        "</inertial><collision><geometry><sphere radius='0.06'/></geometry></collision></link>",
    )
    assert isinstance(model.drive, DifferentialDrive)
    drive_ = replace(model.drive, left_joint="front_left", right_joint="front_right", track=0.4)
    broken = replace(model, description=four, drive=drive_, mass=14.0)
    with pytest.raises(PluginError, match=r"4 wheels .* it is skid-steered: read_published"):
        check_model(broken)


def test_damping_that_holds_a_robot_is_told() -> None:
    entries = []
    for damping in (0.001, 50.0):
        found = _published(_base(0.0, TWO, damping=damping))
        entries.append("".join(check_model(_model(found, found.text)).notes))
        reached = drive(_model(found, found.text), WHEELS, Command(0.6, 0.0), 3.0)[-1].vx
        if damping > 1.0:
            assert f"holds the robot at {reached:.2g}" in entries[-1]
    assert "damping" not in entries[0]


@pytest.mark.parametrize(
    "text",
    [
        '<robot xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:include filename="a"/></robot>',
        '<robot name="r"><xacro:macro name="wheel"/></robot>',
        '<robot name="r"><link name="base_link"/><joint name="${side}_wheel"/></robot>',
    ],
)
def test_macros_are_told_with_what_expands_them(text: str) -> None:
    with pytest.raises(PluginError, match=r"xacro ROBOT\.urdf\.xacro > ROBOT\.urdf"):
        read_description(text)


def test_optional_variables_of_the_environment_are_their_defaults(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setenv("IMU_AT", "9 9 9")
    text = (
        _base(0.0, TWO)
        .replace("0 0 0.1", "$(optenv IMU_AT 0 0 0.1)")
        .replace('damping="0.0"', 'damping="$(optenv DRAG)0"')
    )
    found = read_description(text)
    assert found.pose("base_link", "base_footprint")[2, 3] == pytest.approx(0.1)
    assert found.notes == ("2 of xacro's properties written out: IMU_AT, DRAG",)


@pytest.mark.parametrize(
    ("version", "pose"),
    [
        ("1.9", '<pose degrees="true">{at} -90 0 0</pose>'),
        ("1.9", '<pose rotation_format="euler_rpy" degrees="true">{at} -90 0 0</pose>'),
        ("1.9", '<pose rotation_format="quat_xyzw">{at} -0.7071068 0 0 0.7071068</pose>'),
        ("1.6", '<pose frame="base_link">{at} -1.5707963 0 0</pose>'),
    ],
)
def test_poses_of_sdf_in_any_format(version: str, pose: str) -> None:
    wheel = pose.format(at="0 {y} 0.05") + _inertial(0.5, 0.001)
    shape = '<collision name="c">' + WHEEL_SHAPE + "</collision>"
    text = _cart(wheel=wheel + shape, joint="").replace('version="1.9"', f'version="{version}"')
    described = read_description(text)
    turned = described.pose("left_wheel", "base_link")
    np.testing.assert_allclose(turned[:3, :3], [[1, 0, 0], [0, 0, 1], [0, -1, 0]], atol=1e-6)
    assert described.differential_drive("left", "right").track == pytest.approx(0.3)


@pytest.mark.parametrize(
    ("pose", "expected"),
    [
        ('<pose rotation_format="axis_angle">0 0 0 0 0 0</pose>', "known: euler_rpy, quat_xyzw"),
        ('<pose rotation_format="quat_xyzw">0 0 0 0 0 0</pose>', "has 6 numbers, not 7"),
        ('<pose rotation_format="quat_xyzw">0 0 0 0 0 0 0</pose>', "quaternion of length 0"),
    ],
)
def test_poses_of_sdf_that_are_none_are_refused(pose: str, expected: str) -> None:
    with pytest.raises(PluginError, match=expected):
        read_description(_cart(wheel=pose + _inertial(0.5, 0.001), joint=""))


URDF = (
    '<robot name="cart"><link name="base"/><link name="wheel"/>'
    '<joint name="turns" type="continuous"><parent link="base"/><child link="wheel"/></joint>'
)


@pytest.mark.parametrize(
    ("more", "what"),
    [
        ('<link name="wheel"/>', "two links named 'wheel'"),
        (
            '<link name="arm"/><joint name="turns" type="fixed"><parent link="base"/>'
            '<child link="arm"/></joint>',
            "two joints named 'turns'",
        ),
    ],
)
def test_names_that_stand_twice_are_refused(more: str, what: str) -> None:
    read_description(f"{URDF}</robot>")
    with pytest.raises(PluginError, match=what):
        read_description(f"{URDF}{more}</robot>")


@pytest.mark.parametrize("text", ["", " \n", "\ufeff"])
def test_an_empty_text_is_told_as_such(text: str) -> None:
    with pytest.raises(PluginError, match="description is empty"):
        read_description(text)


@pytest.mark.parametrize(
    "shape", ["plane", "cone", "heightmap", "polyline", "image", "cilinder", "Box"]
)
def test_shapes_that_would_be_lost_are_refused(shape: str) -> None:
    """Drake leaves out shapes that it does not know, and cannot drive with a plane."""
    body = "<cylinder><radius>0.2</radius><length>0.2</length></cylinder>"
    cart = CARTS["links at the axle"]
    assert body in cart
    with pytest.raises(PluginError, match=f"'base_link' collides as a {shape}; use box, cylinder"):
        read_description(cart.replace(body, f"<{shape}/>"))
    kept = '<drake:capsule xmlns:drake="drake.mit.edu" radius="0.2"/>'
    assert read_description(cart.replace(body, kept)).links


# ----------------------------------------------------------------------------- links
LINKS = CARTS["links at the axle"]
CAMERA = (
    '<link name="cam"><pose>0.1 0 0.3 0 0 0</pose>{}</link><joint name="cj" type="fixed">'
    "<parent>base_link</parent><child>cam</child></joint></model>"
)


@pytest.mark.parametrize("mass", [0, -1])
def test_links_that_drake_would_weigh_otherwise_are_refused(mass: float) -> None:
    text = LINKS.replace("</model>", CAMERA.format(_inertial(mass, 0.01)))
    with pytest.raises(PluginError, match=r"link 'cam' has (mass 0, which SDF|a mass of -1 kg)"):
        check_model(_model(read_description(text), text))


def test_moments_without_a_mass_are_refused() -> None:
    text = _published(_base(0.0, TWO)).text
    link = '<link name="cam"><inertial><mass value="0"/><inertia {}/></inertial></link>'
    link += '<joint name="cj" type="fixed"><parent link="base_link"/><child link="cam"/></joint>'
    for moments, refused in (('ixx="0" iyy="0" izz="0"', False), ('ixx="1" iyy="1" izz="1"', True)):
        with_link = text.replace("</robot>", f"{link.format(moments)}</robot>")
        model = replace(_model(read_description(text), text), description=with_link)
        if refused:
            with pytest.raises(PluginError, match="'cam' has mass 0 and moments"):
                check_model(model)
        else:
            check_model(model)


def test_parts_that_move_need_a_mass() -> None:
    """Drake fails amid a run otherwise."""
    text = _published(_base(0.0, TWO)).text
    model = _model(read_description(text), text)
    wheel = Xml.fromstring(text).find("link[@name='left_wheel']/inertial")
    assert wheel is not None
    whole = Xml.tostring(wheel, encoding="unicode").strip()
    assert whole in text
    without = text.replace(whole, "", 1)
    bare = replace(model, description=without, mass=read_description(without).mass)
    with pytest.raises(PluginError, match="'left_wheel' weighs nothing"):
        check_model(bare)
    mass = Xml.tostring(next(wheel.iter("mass")), encoding="unicode").strip()
    point = text.replace(whole, f"<inertial>{mass}<inertia ixx='0' iyy='0' izz='0'/></inertial>", 1)
    with pytest.raises(PluginError, match="'left_wheel' has no moments of inertia"):
        check_model(replace(model, description=point))


def test_moments_that_no_body_has_are_told() -> None:
    text = LINKS.replace("<ixx>0.1<", "<ixx>1.0<")
    assert text != LINKS
    found = check_model(_model(read_description(text), text))
    assert any("the moments of inertia of 'base_link'" in note for note in found.notes)


@pytest.mark.parametrize(
    ("shape", "depth"),
    [
        ("<box><size>0.3 0.3 0.4</size></box>", 50),
        ("<cylinder><radius>0.2</radius><length>0.4</length></cylinder>", 50),
        ("<capsule><radius>0.1</radius><length>0.3</length></capsule>", 100),
        ("<sphere><radius>0.2</radius></sphere>", 50),
        ("<ellipsoid><radii>0.1 0.2 0.25</radii></ellipsoid>", 100),
        ("<box><size>0.3 0.3 0.305</size></box>", None),
    ],
)
def test_shapes_below_the_floor_are_told(shape: str, depth: int | None) -> None:
    whole = "<cylinder><radius>0.2</radius><length>0.2</length></cylinder>"
    assert whole in LINKS
    text = LINKS.replace(whole, shape)
    notes = check_model(_model(read_description(text), text)).notes
    entries = [note for note in notes if "below the floor" in note]
    assert len(entries) == (depth is not None)
    if depth is not None:
        assert f"of 'base_link' reaches {depth} mm below the floor" in entries[0]


def test_wheels_that_are_not_beside_the_base_alike_are_told() -> None:
    text = LINKS.replace("<pose>0 0.15 0.05", "<pose>0 0.17 0.05")
    notes = check_model(_model(read_description(text), text)).notes
    assert any("middle between its wheels is 10 mm to the left of 'base_link'" in n for n in notes)
