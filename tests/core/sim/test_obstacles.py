"""Walls, blocks and pillars of a floor stop the robot, and its lidar sees them where they are."""

from __future__ import annotations

import numpy as np
import pytest
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import DiagramBuilder
from pydrake.systems.primitives import ConstantVectorSource

from crowdbot.core.robots.build import build_model
from crowdbot.core.sensing.scene import Scene
from crowdbot.core.sim.control.differential_drive import wheel_gains
from crowdbot.core.sim.plant import add_plant, place_robot
from crowdbot.core.sim.robot_state import RobotStateSystem
from crowdbot.plugin import EnvironmentParts, Pose
from crowdbot.plugins.environments.floor import FloorSpec
from crowdbot.plugins.environments.place_build import build
from tests.core.sim.sim_worlds import registry, scenario

BODY = 0.178


def drive(parts: EnvironmentParts, start: Pose, seconds: float) -> tuple[float, float]:
    """Where a robot gets that drives straight on at about 0.4 m/s."""
    (robot,) = scenario().robots.values()
    builder = DiagramBuilder()
    rig = add_plant(builder, parts, build_model(registry(), robot.model), wheel_gains(6.3, 0.0352))
    wheels = builder.AddSystem(ConstantVectorSource([0.0, 0.0, 11.0, 11.0]))
    builder.Connect(wheels.get_output_port(), rig.plant.get_desired_state_input_port(rig.model))
    state = builder.AddSystem(RobotStateSystem(rig))
    builder.Connect(rig.plant.get_state_output_port(rig.model), state.GetInputPort("plant_state"))
    simulator = Simulator(builder.Build())
    context = rig.plant.GetMyMutableContextFromRoot(simulator.get_mutable_context())
    place_robot(rig, context, start)
    simulator.AdvanceTo(seconds)
    found = state.convert(rig.plant.get_state_output_port(rig.model).Eval(context))
    return found.x, found.y


OBSTACLES: dict[str, dict[str, object]] = {
    "wall": {"walls": {"w": {"start": [3.0, -1.0], "end": [3.0, 1.0], "thickness": 0.2}}},
    "block": {"blocks": {"b": {"corners": [[2.9, -1], [3.9, -1], [3.9, 1], [2.9, 1]]}}},
    "pillar": {"pillars": {"p": {"x": 3.4, "y": 0.0, "radius": 0.5}}},
}


@pytest.mark.parametrize("kind", OBSTACLES)
def test_the_robot_is_stopped_where_the_lidar_sees_it(kind: str) -> None:
    area = {"x": (-5.0, 15.0), "y": (-5.0, 5.0)}
    parts = build(FloorSpec.model_validate({"area": area, **OBSTACLES[kind]}))
    x, y = drive(parts, Pose(1.0, 0.0, 0.0), 8.0)
    assert x + BODY == pytest.approx(2.9, abs=0.01)
    assert abs(y) < 0.1
    scene = Scene(parts.walls, parts.wall_heights, [], [], parts.pillars, parts.pillar_heights)
    distance, incidence, body = scene.cast(
        np.array([[1.0, 0.0, 0.2]]), np.array([[1.0, 0.0, 0.0]]), 10.0
    )
    assert distance[0] == pytest.approx(1.9)
    assert incidence[0] == pytest.approx(0.0, abs=1e-6)
    assert body[0] == -(2 + len(parts.walls)) if kind == "pillar" else body[0] <= -2


def test_without_an_obstacle_it_drives_on() -> None:
    parts = build(FloorSpec.model_validate({"area": {"x": (-5.0, 15.0), "y": (-5.0, 5.0)}}))
    assert drive(parts, Pose(1.0, 0.0, 0.0), 8.0)[0] > 3.5


def test_rays_take_the_nearest_of_wall_pillar_and_person() -> None:
    pillars = [[4.0, 0.0, 0.5], [6.0, 0.0, 0.5]]
    scene = Scene([[5.0, -9.0, 5.0, 9.0]], [0.0, 2.5], [0.33], [1.7], pillars, [0.0, 1.5])
    ray = (np.array([[0.0, 0.0, 1.2]]), np.array([[1.0, 0.0, 0.0]]), 10.0)
    trunk = 0.5 * 0.259 * 1.7
    for x, expected in ((2.0, (2.0 - trunk, 0)), (4.5, (3.5, -3)), (8.0, (3.5, -3))):
        scene.update(None, np.array([[x, 0.0, 0.0, 0.0]]), np.ones(1, np.bool_))
        distance, _, body = scene.cast(*ray)
        assert (distance[0], body[0]) == (pytest.approx(expected[0]), expected[1])
    over = (np.array([[0.0, 0.0, 1.6]]), ray[1], 10.0)  # above the pillars
    distance, _, body = scene.cast(*over)
    assert (distance[0], body[0]) == (5.0, -2)
