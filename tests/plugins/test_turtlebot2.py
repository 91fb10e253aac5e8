"""The robot's numbers, checked on the plant that Drake makes of its text."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from pydrake.multibody.parsing import Parser
from pydrake.multibody.plant import MultibodyPlant

from crowdbot.core.interfaces import RobotModel
from crowdbot.plugins.robots.turtlebot2 import Turtlebot2Spec
from crowdbot.plugins.robots.turtlebot2_build import build


def _plant(model: RobotModel) -> Any:
    plant: Any = MultibodyPlant(1.0 / 128.0)
    Parser(plant).AddModelsFromString(model.sdf, "sdf")
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
    assert (com - base)[:2] == pytest.approx([0.0, 0.0], abs=1e-9)
    assert (com - base)[2] + model.base_height == pytest.approx(model.force_height, abs=0.01)


def test_inertia_is_that_of_a_body_of_its_size() -> None:
    model = build(Turtlebot2Spec())
    plant = _plant(model)
    context = plant.CreateDefaultContext()
    inertia = plant.CalcSpatialInertia(
        context, plant.GetBodyByName(model.base).body_frame(),
        [plant.GetBodyByName(n).index() for n in ("base_link", "left_wheel", "right_wheel")],
    )  # fmt: skip
    around_z = inertia.Shift(inertia.get_com()).CalcRotationalInertia().get_moments()[2]
    cylinder = 0.5 * 6.0 * model.footprint_radius**2
    wheels = 2 * 0.15 * (0.5 * model.drive.track) ** 2
    assert around_z == pytest.approx(cylinder + wheels, rel=0.05)


def test_wheels_turn_forward_together() -> None:
    """Both wheels at the same positive rate drive along +x; the right one faster turns left."""
    model = build(Turtlebot2Spec())
    plant = _plant(model)
    assert plant.num_actuators() == 2
    context = plant.CreateDefaultContext()
    for name, side in ((model.drive.left_joint, 1.0), (model.drive.right_joint, -1.0)):
        joint = plant.GetJointByName(name)
        axis = joint.frame_on_parent().CalcPoseInWorld(context).rotation() @ joint.revolute_axis()
        assert axis == pytest.approx([0.0, 1.0, 0.0], abs=1e-9)
        wheel = plant.EvalBodyPoseInWorld(context, joint.child_body()).translation()
        base = plant.EvalBodyPoseInWorld(context, plant.GetBodyByName(model.base)).translation()
        assert (wheel - base)[1] == pytest.approx(side * 0.5 * model.drive.track)
        assert (wheel - base)[2] + model.base_height == pytest.approx(model.drive.command_radius)


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
    assert np.isclose(build(Turtlebot2Spec()).drive.command_radius, 0.0352)
