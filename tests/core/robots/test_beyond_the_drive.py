"""Robots of others whose numbers contradict their limits, or that are fixed to the world."""

from __future__ import annotations

import re

import pytest

from crowdbot.core.robots.check import check_model
from crowdbot.errors import PluginError
from crowdbot.plugin import (
    DifferentialDrive,
    PublishedWheel,
    RobotLimits,
    RobotModel,
    read_description,
    read_published,
)

SHELL = '<collision><geometry><cylinder radius="0.25" length="0.1"/></geometry></collision>'
LIMITS = RobotLimits(v_min=-0.8, v_max=0.8, w_max=2.0, a_max=1.0, alpha_max=3.0)


def _inertial(mass: float) -> str:
    moments = " ".join(f'{n}="{0.004 if n[1] == n[2] else 0}"' for n in (
        "ixx", "iyy", "izz", "ixy", "ixz", "iyz"))  # fmt: skip
    return f'<inertial><mass value="{mass}"/><inertia {moments}/></inertial>'


def _urdf(*, mass: float = 10.0, y: float = 0.2, turns: float = 20.0, radius: float = 0.1,
          more: str = "") -> str:  # fmt: skip
    text = f'<robot name="r"><link name="base_link">{_inertial(mass)}</link>{more}'
    for name, side in (("left", y), ("right", -y)):
        text += (
            f'<link name="{name}_wheel">{_inertial(1.0)}<collision><origin rpy="1.5707963 0 0"/>'
            f'<geometry><cylinder radius="{radius}" length="0.03"/></geometry></collision></link>'
            f'<joint name="{name}" type="continuous"><parent link="base_link"/>'
            f'<child link="{name}_wheel"/><origin xyz="0 {side} 0"/><axis xyz="0 1 0"/>'
            f'<limit effort="4" velocity="{turns}"/></joint>'
        )
    return text + "</robot>"


def _model(text: str) -> RobotModel:
    wheels = dict.fromkeys(("left", "right"), PublishedWheel(radius=0.1, effort=4.0))
    found = read_published(text, wheels=wheels, shell=SHELL)
    drive = found.differential_drive("left", "right")
    assert isinstance(drive, DifferentialDrive)
    return RobotModel(
        description=found.text, base="base_link", base_height=found.base_height(drive), drive=drive,
        limits=LIMITS, footprint_radius=0.25, height=0.5, force_height=0.2, mass=found.mass,
        notes=found.notes,
    )  # fmt: skip


def test_a_plain_robot_is_quiet() -> None:
    assert check_model(_model(_urdf())).notes == (
        "2 wheels touch the floor as spheres: left, right",
    )
    assert check_model(_model(_urdf(turns=-1.0))).notes == check_model(_model(_urdf())).notes


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (_urdf(turns=2.0), "limited to 2 rad/s, which is 0.2 m/s; .* v_max is 0.8 m/s"),
        (_urdf(mass=10_000.0), r"together 8 N m, accelerates its 10002 kg by 0.008 m/s\^2"),
        (_urdf(y=200.0), "its wheels are 400 m apart, and its outline reaches 0.25 m"),
        (_urdf(radius=0.12), "wheel's radius is 0.1 m, not 0.12 m: left"),
    ],
)
def test_what_the_wheels_contradict_is_told(text: str, message: str) -> None:
    assert any(re.search(message, note) for note in check_model(_model(text)).notes)


@pytest.mark.parametrize("kind", ["fixed", "floating"])
def test_a_robot_that_hangs_on_the_world_drives(kind: str) -> None:
    more = (
        f'<link name="world"/><joint name="anchor" type="{kind}"><parent link="world"/>'
        '<child link="base_link"/></joint>'
    )
    notes = check_model(_model(_urdf(more=more))).notes
    assert "joint to the world is left out, the robot drives: anchor" in notes
    if kind == "floating":
        return
    found = read_description(_urdf(more=more))
    drive = found.differential_drive("left", "right")
    plain = RobotModel(
        description=found.text, base="base_link", base_height=0.1, drive=drive, limits=LIMITS,
        footprint_radius=0.25, height=0.5, force_height=0.2, mass=found.mass,
    )  # fmt: skip
    with pytest.raises(PluginError, match="a link is called 'world', as the simulator's own"):
        check_model(plain)


def test_a_model_of_sdformat_that_hangs_on_the_world_drives() -> None:
    wheels = dict.fromkeys(("left", "right"), PublishedWheel(radius=0.1, effort=4.0))
    ball = "<collision name='c'><geometry><sphere><radius>0.1</radius></sphere></geometry>"
    inertia = "".join(f"<{n}>{0.004 if n[1] == n[2] else 0}</{n}>" for n in (
        "ixx", "iyy", "izz", "ixy", "ixz", "iyz"))  # fmt: skip
    heavy = f"<inertial><mass>5</mass><inertia>{inertia}</inertia></inertial>"
    text = f"<sdf version='1.9'><model name='r'><link name='base_link'>{heavy}</link>"
    for name, y in (("left", 0.2), ("right", -0.2)):
        text += (
            f"<link name='{name}_w'><pose>0 {y} 0 0 0 0</pose>{heavy}{ball}</collision></link>"
            f"<joint name='{name}' type='revolute'><parent>base_link</parent><child>{name}_w"
            "</child><axis><xyz>0 1 0</xyz></axis></joint>"
        )
    text += (
        "<joint name='anchor' type='fixed'><parent>world</parent><child>base_link</child></joint>"
        "<plugin name='drive' filename='x.so'><wheel_separation>0.3</wheel_separation>"
        "<wheel_diameter>0.2</wheel_diameter></plugin></model></sdf>"
    )
    found = read_published(text, wheels=wheels, shell=SHELL)
    assert "joint to the world is left out, the robot drives: anchor" in found.notes
    assert [note for note in found.notes if "plugin" in note] == [
        "wheel separation 0.3 m in Gazebo's plugin is not used: the description has 0.4 m"
    ]


def test_drives_of_gazebo_in_a_urdf() -> None:
    drive = "<wheelSeparation>0.4</wheelSeparation><wheelDiameter>{}</wheelDiameter>"
    for size, count in (("0.2", 0), ("0.3", 1), ("${{d}}", 0)):
        more = f"<gazebo><plugin name='d' filename='x'>{drive.format(size)}</plugin></gazebo>"
        notes = _model(_urdf(more=more)).notes
        assert sum("wheel radius 0.15 m in Gazebo's plugin" in note for note in notes) == count
