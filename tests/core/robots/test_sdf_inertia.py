"""Links of SDFormat without ``<inertial>``, or with a part of one; Drake's parser is the oracle."""

from __future__ import annotations

import numpy as np
import pytest
from pydrake.multibody.parsing import Parser
from pydrake.multibody.plant import MultibodyPlant

from crowdbot.core.robots.check import check_model
from crowdbot.core.robots.xml import name_of
from crowdbot.plugin import (
    Command,
    Description,
    PublishedWheel,
    RobotLimits,
    RobotModel,
    read_description,
    read_published,
)
from crowdbot.testing.commanded_motion import drive

SHELL = """<collision><origin xyz="0 0 0.15"/>
  <geometry><cylinder radius="0.25" length="0.15"/></geometry></collision>"""
WHEELS = dict.fromkeys(("left", "right"), PublishedWheel(0.05, 5.0))
_INERTIAS = {
    "base_link": "",
    "left_wheel": "<inertial><mass>0.4</mass></inertial>",
    "right_wheel": "<inertial><mass>0.4</mass><inertia><ixx>0.5</ixx></inertia></inertial>",
    "mast": "<inertial><pose>0.01 0 0.2 0 0 0</pose><inertia><ixx>0.02</ixx><iyy>0.02</iyy>"
    "<izz>0.01</izz></inertia></inertial>",
}
_JOINTS = "".join(
    f'<joint name="{name}" type="revolute"><parent>base_link</parent><child>{name}_wheel</child>'
    "<axis><xyz>0 0 1</xyz><limit><effort>5</effort></limit></axis></joint>"
    for name in ("left", "right")
)


def _cart(inertias: dict[str, str]) -> str:
    poses = {
        "left_wheel": "0 0.15 0.05 -1.570796327 0 0", "right_wheel": "0 -0.15 0.05 -1.570796327 0 0"
    }  # fmt: skip
    shape = (
        '<collision name="c"><geometry><cylinder><radius>0.05</radius><length>0.02</length>'
        "</cylinder></geometry></collision>"
    )
    links = "".join(
        f'<link name="{name}"><pose>{poses.get(name, "0 0 0 0 0 0")}</pose>{inertial}'
        f"{shape if name in poses else ''}</link>"
        for name, inertial in inertias.items()
    )
    held = (
        '<joint name="held" type="fixed"><parent>base_link</parent><child>mast</child></joint>'
        if "mast" in inertias
        else ""
    )
    return f'<sdf version="1.9"><model name="cart">{links}{_JOINTS}{held}</model></sdf>'


def _model(found: Description) -> RobotModel:
    made = found.differential_drive("left", "right")
    return RobotModel(
        description=found.text, base="base_link", base_height=found.base_height(made), drive=made,
        limits=RobotLimits(v_min=-0.5, v_max=0.5, w_max=1.0, a_max=1.0, alpha_max=2.0),
        footprint_radius=0.25, height=0.4, force_height=0.2, mass=found.mass, notes=found.notes,
    )  # fmt: skip


def test_defaults_are_those_that_drake_takes() -> None:
    text = _cart(_INERTIAS)
    found, plant = read_description(text), MultibodyPlant(0.0)
    (model,) = Parser(plant).AddModelsFromString(text, "sdf")
    plant.Finalize()
    context = plant.CreateDefaultContext()
    for link in found.model.findall("link"):
        body = plant.GetBodyByName(name_of(link), model)
        assert found.mass_of(name_of(link)) == body.default_mass()
        inertia = body.CalcSpatialInertiaInBodyFrame(context)
        about = inertia.CalcRotationalInertia().ShiftToCenterOfMass(
            inertia.get_mass(), inertia.get_com()
        )
        own = [float(link.findtext(f"inertial/inertia/{n}", "")) for n in ("ixx", "iyy", "izz")]
        assert np.diag(about.CopyToFullMatrix3()) == pytest.approx(own)
    centre = plant.CalcCenterOfMassPositionInWorld(context)
    base = plant.GetFrameByName("base_link").CalcPoseInWorld(context)
    assert base.inverse().multiply(centre) == pytest.approx(found.centre_of_mass("base_link"))


def test_each_link_with_a_default_is_told() -> None:
    notes = read_description(_cart(_INERTIAS)).notes
    assert notes == (
        "link without <inertial> gets 1 kg and moments of inertia of 1 kg m^2, the defaults of "
        "SDFormat: base_link",
        "link without <mass> gets 1 kg, the default of SDFormat: mast",
        "2 links without all moments of inertia get 1 kg m^2 for each that is missing, the default "
        "of SDFormat: left_wheel, right_wheel",
    )


def test_a_robot_without_any_inertial_drives() -> None:
    text = _cart(dict.fromkeys(("base_link", "left_wheel", "right_wheel"), ""))
    assert check_model(_model(read_description(text))).mass == 3.0
    turns = text.replace("<effort>5</effort>", "<lower>-1e16</lower><upper>1e16</upper>")
    found = read_published(turns, wheels=WHEELS, shell=SHELL)
    assert found.mass == pytest.approx(3.0)
    assert any("3 links without <inertial> get 1 kg" in note for note in found.notes)
    assert "wheel without a limit gets a torque of 5 N m: left" in found.notes
    model = check_model(_model(found))
    assert drive(model, "differential_drive", Command(0.2, 0.0), 1.0)[-1].x > 0.05
