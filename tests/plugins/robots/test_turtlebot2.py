"""The robot's numbers, checked on the plant that Drake makes of its text."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from pydrake.multibody.parsing import Parser
from pydrake.multibody.plant import MultibodyPlant

from crowdbot.plugin import DifferentialDrive, RobotModel
from crowdbot.plugins.robots.body_part import Part
from crowdbot.plugins.robots.turtlebot2 import Turtlebot2Spec
from crowdbot.plugins.robots.turtlebot2_build import build
from crowdbot.plugins.robots.turtlebot2_parts import parts


def _drive(model: RobotModel) -> DifferentialDrive:
    assert isinstance(model.drive, DifferentialDrive)
    return model.drive


def _plant(model: RobotModel) -> Any:
    plant: Any = MultibodyPlant(1.0 / 128.0)
    Parser(plant).AddModelsFromString(model.description, "sdf")
    plant.Finalize()
    return plant


@pytest.mark.parametrize("mass", [6.3, 11.0])
def test_mass_and_balance(mass: float) -> None:
    model = build(Turtlebot2Spec(mass=mass))
    plant = _plant(model)
    context = plant.CreateDefaultContext()
    assert model.mass == mass
    assert plant.CalcTotalMass(context) == pytest.approx(mass)
    com = plant.CalcCenterOfMassPositionInWorld(context)
    base = plant.EvalBodyPoseInWorld(context, plant.GetBodyByName(model.base)).translation()
    assert (com - base)[:2] == pytest.approx([0.0, 0.0], abs=1e-5)
    assert (com - base)[2] + model.base_height == pytest.approx(model.force_height, abs=1e-9)


def _cloud(part: Part, rng: np.random.Generator, count: int = 4000) -> NDArray[np.float64]:
    """Points spread evenly over a part, from base_link (N, 3), m."""
    u = rng.random((count, 3)) - 0.5
    a, b, c = part.size
    if part.shape == "box":
        return u * (a, b, c) + part.at
    angle, r = 2.0 * math.pi * u[:, 0], a * np.sqrt(u[:, 1] + 0.5)
    return np.column_stack([r * np.cos(angle), r * np.sin(angle), c * u[:, 2]]) + part.at


def test_inertia_is_that_of_the_parts() -> None:
    """Sums over points spread over the parts, instead of the formulas for solids."""
    model, rng = build(Turtlebot2Spec()), np.random.default_rng(1)
    body = [p for p in parts(6.0) if p.mass]
    points = np.concatenate([_cloud(p, rng) for p in body])
    mass = np.repeat([p.mass / 4000 for p in body], 4000)
    centre = mass @ points / mass.sum()
    away = points - centre
    expected = [mass @ ((away**2).sum(axis=1) - away[:, i] ** 2) for i in range(3)]
    plant = _plant(model)
    base = plant.GetBodyByName(model.base)
    inertia = base.default_spatial_inertia()
    assert inertia.get_com() == pytest.approx(centre, abs=1e-3)
    moments = inertia.Shift(inertia.get_com()).CalcRotationalInertia().get_moments()
    assert moments == pytest.approx(expected, rel=0.01)


def test_parts_weigh_what_the_data_sheets_say_and_stay_within_the_disc() -> None:
    body = parts(6.0)
    weight = {p.name: p.mass for p in body}
    assert sum(weight[n] for n in ("skirt", "body", "deck")) + 0.3 == pytest.approx(2.35)
    assert sum(m for n, m in weight.items() if n.startswith("pole")) == pytest.approx(0.38)
    assert weight["camera"] + weight["camera_foot"] == pytest.approx(0.564)
    for part in body:
        a, b, _ = part.size
        across = a if part.shape == "cylinder" else math.hypot(a, b) / 2
        if part.name.startswith("plate"):
            across = a - abs(part.at[0])  # cut to a hexagon in truth
        if part.mass and part.name != "camera":
            assert math.hypot(*part.at[:2]) + across < 0.21
    assert max(p.at[2] + p.size[2] / 2 for p in body) + 0.0102 == pytest.approx(0.4, abs=0.02)


def test_wheels_turn_forward_together() -> None:
    """Both wheels at the same positive rate drive along +x; the right one faster turns left."""
    model = build(Turtlebot2Spec())
    drive = _drive(model)
    plant = _plant(model)
    assert plant.num_actuators() == 2
    context = plant.CreateDefaultContext()
    for name, side in ((drive.left_joint, 1.0), (drive.right_joint, -1.0)):
        joint = plant.GetJointByName(name)
        axis = joint.frame_on_parent().CalcPoseInWorld(context).rotation() @ joint.revolute_axis()
        assert axis == pytest.approx([0.0, 1.0, 0.0], abs=1e-9)
        wheel = plant.EvalBodyPoseInWorld(context, joint.child_body()).translation()
        base = plant.EvalBodyPoseInWorld(context, plant.GetBodyByName(model.base)).translation()
        assert (wheel - base)[1] == pytest.approx(side * 0.5 * drive.track)
        assert (wheel - base)[2] + model.base_height == pytest.approx(drive.command_radius)


def test_limits_are_those_of_the_spec() -> None:
    limits = build(
        Turtlebot2Spec(
            max_speed=0.5, max_yaw_rate=2.0, max_acceleration=0.8, max_yaw_acceleration=3.0
        )
    ).limits
    assert limits.v_max == -limits.v_min == 0.5
    assert (limits.w_max, limits.a_max, limits.alpha_max) == (2.0, 0.8, 3.0)
    default = build(Turtlebot2Spec()).limits
    assert (default.v_max, default.w_max, default.a_max, default.alpha_max) == (
        0.65,
        3.14,
        1.0,
        2.0,
    )
    assert math.isclose(build(Turtlebot2Spec()).footprint_radius, 0.178)
    assert np.isclose(_drive(build(Turtlebot2Spec())).command_radius, 0.0352)
