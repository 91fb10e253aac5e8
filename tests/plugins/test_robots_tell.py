"""Robots: the wheels that odometry takes, outline and drive that planners get; and groups."""

from __future__ import annotations

import math
from typing import Any, ClassVar, Literal

import numpy as np
import pytest

import crowdbot
from crowdbot.core.crowd import Agents
from crowdbot.core.planning.resolve import resolve_planner
from crowdbot.core.registry.registry import discover
from crowdbot.core.sim.built_run import build_run
from crowdbot.core.types.robot import (
    DifferentialDrive,
    HolonomicDrive,
    RobotBody,
    RobotLimits,
    RobotModel,
    robot_body,
)
from crowdbot.core.view.build import field_of_view
from crowdbot.plugin import Mount, RobotSpec, SensorSpec
from crowdbot.plugins.planners.shared.robot_outline_build import disc_radius, half_width_and_front
from crowdbot.plugins.sensors.infrared import InfraredSpec
from crowdbot.plugins.sensors.lidar2d import Lidar2dSpec
from crowdbot.plugins.sensors.people_tracker import PeopleTrackerSpec
from crowdbot.plugins.sensors.rgbd_camera import RgbdCameraSpec
from crowdbot.plugins.sensors.ultrasound import UltrasoundSpec
from crowdbot.plugins.sensors.wheel_odometry import WheelOdometrySpec
from tests.paths import ROOT

SCENARIO = ROOT / "docs" / "tutorial" / "files" / "my_scenario.yaml"


def model(drive: Any = None, footprint: Any = None, radius: float = 0.2) -> RobotModel:
    return RobotModel(
        description="", base="base", base_height=0.0, footprint_radius=radius, height=1.0,
        drive=drive or DifferentialDrive(
            left_joint="l", right_joint="r", command_radius=0.06, track=0.3
        ),
        limits=RobotLimits(v_min=0.0, v_max=1.0, w_max=1.0, a_max=1.0, alpha_max=1.0),
        force_height=0.3, mass=10.0, footprint=footprint,
    )  # fmt: skip


def test_a_model_has_the_wheels_that_odometry_counts() -> None:
    assert model().wheels == (0.06, 0.3)
    holonomic = HolonomicDrive(max_force=1.0, max_torque=1.0, wheel_radius=0.05, track=0.4)
    assert model(holonomic).wheels == (0.05, 0.4)


class FirmwareSpec(RobotSpec):
    """A robot whose firmware has an opinion about its wheels."""

    kind: Literal["firmware"] = "firmware"
    wheels = (0.06, 0.3)


class PlainSpec(RobotSpec):
    """A robot without one."""

    kind: Literal["plain"] = "plain"


def test_odometry_takes_the_wheels_that_the_robots_spec_says() -> None:
    fitted = WheelOdometrySpec().on_robot(FirmwareSpec())
    assert (fitted.wheel_radius, fitted.track) == (0.06, 0.3)
    own = WheelOdometrySpec(track=0.5).on_robot(FirmwareSpec())
    assert (own.wheel_radius, own.track) == (0.06, 0.5)
    assert WheelOdometrySpec().on_robot(PlainSpec()) == WheelOdometrySpec()
    tracker = PeopleTrackerSpec()
    assert tracker.on_robot(FirmwareSpec()) is tracker


def test_a_turtlebot_writes_the_wheels_its_firmware_believes_in() -> None:
    scenario = crowdbot.load(SCENARIO)
    assert isinstance(scenario, crowdbot.Scenario)
    spec: Any = scenario.robots["robot"].sensors["odometry"]
    assert (spec.wheel_radius, spec.track) == (0.035, 0.23)
    values = crowdbot.load(SCENARIO, set={"robots.robot.sensors.odometry.track": 0.3})
    assert isinstance(values, crowdbot.Scenario)
    assert values.robots["robot"].sensors["odometry"].track == 0.3  # type: ignore[attr-defined]


@pytest.mark.parametrize(
    ("footprint", "radius", "expected"),
    [
        (None, 0.2, (0.2, 0.2, 0.2, 0.2)),
        ([[-0.1, 0.0], [0.4, 0.0]], 0.2, (0.6, 0.3, 0.2, 0.6)),
        ([[-0.3, -0.2], [0.4, -0.2], [0.4, 0.2], [-0.3, 0.2]], 0.9, (0.4, 0.3, 0.2, 0.447214)),
    ],
)
def test_a_body_says_how_far_it_reaches(footprint: Any, radius: float, expected: Any) -> None:
    array = None if footprint is None else np.array(footprint)
    body = robot_body(model(footprint=array, radius=radius))
    found = (body.front, body.back, body.half_width, body.reach)
    assert found == pytest.approx(expected, abs=1e-6)
    assert body.drive == "differential"
    assert disc_radius(None, body) == body.reach
    assert disc_radius(0.5, body) == 0.5
    assert half_width_and_front(None, body) == (body.half_width, body.front)
    assert half_width_and_front(0.5, body) == (0.5, 0.5)
    assert disc_radius(None, None) == 0.178


def test_the_task_of_a_turtlebot_holds_its_body() -> None:
    scenario = crowdbot.load(SCENARIO)
    assert isinstance(scenario, crowdbot.Scenario)
    registry = discover()
    built = build_run(scenario, registry, resolve_planner("stand_still", registry), "used")
    body = built.task.robot
    assert isinstance(body, RobotBody)
    assert (body.drive, body.reach, body.footprint) == ("differential", 0.178, None)


def test_a_partial_mount_keeps_the_other_defaults() -> None:
    assert PeopleTrackerSpec.model_validate({"kind": "people_tracker"}).mount.z == 0.4
    moved = PeopleTrackerSpec.model_validate({"kind": "people_tracker", "mount": {"x": 0.1}})
    assert (moved.mount.x, moved.mount.z) == (0.1, 0.4)
    low = PeopleTrackerSpec.model_validate({"kind": "people_tracker", "mount": {"z": 0.0}})
    assert low.mount.z == 0.0
    assert PeopleTrackerSpec(mount=Mount(x=0.1)).mount.z == 0.0


def _sensor(**fields: Any) -> SensorSpec:
    annotations = dict.fromkeys(fields, float)
    made: Any = type("S", (SensorSpec,), {
        "__annotations__": {"kind": Literal["x"], **annotations}, "kind": "x", **fields,
        "__module__": __name__,
    })()  # fmt: skip
    assert isinstance(made, SensorSpec)
    return made


@pytest.mark.parametrize(
    ("spec", "half", "reach"),
    [
        (UltrasoundSpec(), 0.3296, 4.5),
        (UltrasoundSpec(radius=0.5, range_max=3.0), 0.2512, 3.0),
        (InfraredSpec(dispersion=0.1), 0.1, 4.5),
        (PeopleTrackerSpec(view=2.0), 1.0, 10.0),
        (RgbdCameraSpec(horizontal_view=1.2, depth_max=6.0), 0.6, 6.0),
        (Lidar2dSpec(), math.radians(120.0), 10.0),
    ],
)
def test_our_sensors_show_their_own_opening(spec: SensorSpec, half: float, reach: float) -> None:
    assert field_of_view(spec) == pytest.approx((-half, half, reach), abs=1e-4)


def test_sensors_of_plugins_show_what_they_reach() -> None:
    assert field_of_view(_sensor(range_max=5.0, opening=3.0)) == (-1.5, 1.5, 5.0)
    assert field_of_view(_sensor(max_range=4.0)) == (-math.pi, math.pi, 4.0)
    assert field_of_view(_sensor(rate=4.0)) is None

    class Own(SensorSpec):
        kind: Literal["own"] = "own"
        wide: ClassVar[float] = 0.5

        def field_of_view(self) -> tuple[float, float, float]:
            return 0.0, self.wide, 7.0

    assert field_of_view(Own()) == (0.0, 0.5, 7.0)


def test_agents_know_their_groups() -> None:
    assert Agents.of(x=[0, 1], y=[0, 0]).group.tolist() == [-1, -1]
    assert Agents.of(x=[0, 1], y=[0, 0], group=[3, 3]).group.tolist() == [3, 3]
