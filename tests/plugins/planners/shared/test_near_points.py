"""Points of ultrasound and depth cameras that no lidar sees."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from crowdbot.core.planning.selected_sensors import select_sensors
from crowdbot.errors import InputError
from crowdbot.plugin import Observation, Pinhole, Pose, Reading, SensorInfo
from crowdbot.plugins.planners.dwa.dwa import DwaSpec
from crowdbot.plugins.planners.shared.near_points_build import NearPoints

_NOTHING = np.empty((0, 2))


def _info(category: str, **more: Any) -> SensorInfo:
    return SensorInfo(
        category=category, frame="", mount=(0.1, 0.0, 0.2, 0.0), rate=8.0, ros_type="",
        **{"shape": (1,), **more},
    )  # fmt: skip


def _seen(readings: dict[str, Reading]) -> Observation:
    return Observation(
        t=0.0, pose=Pose(0.0, 0.0, 0.0), twist=(0.0, 0.0), goal=(1.0, 0.0),
        goal_zone=_NOTHING, readings=readings,
    )  # fmt: skip


def test_an_echo_becomes_an_arc_unless_a_lidar_sees_what_echoes() -> None:
    near = NearPoints({"us": _info("ultrasound", angles=np.array([-0.4, 0.4]))})
    obs = _seen({"us": Reading(0.0, np.array([0.8]))})
    arc = near(obs, _NOTHING)
    np.testing.assert_allclose(np.hypot(arc[:, 0] - 0.1, arc[:, 1]), 0.8)
    assert np.ptp(arc[:, 1]) > 0.2
    assert len(near(obs, np.array([[0.95, 0.1]]))) == 0
    assert len(near(obs, np.array([[2.5, 0.1]]))) == len(arc)
    assert len(near(_seen({"us": Reading(0.0, np.array([np.inf]))}), _NOTHING)) == 0
    assert len(near(_seen({}), _NOTHING)) == 0


def test_an_echo_from_the_edge_of_the_cone_is_explained_by_a_person_just_beyond_it() -> None:
    near = NearPoints({"us": _info("ultrasound", angles=np.array([-0.4, 0.4]))})
    obs = _seen({"us": Reading(0.0, np.array([0.8]))})
    for angle, explained in ((0.5, True), (-0.5, True), (0.7, False), (-0.7, False)):
        person = np.array([[0.1 + 0.85 * np.cos(angle), 0.85 * np.sin(angle)]])
        assert (len(near(obs, person)) == 0) is explained


def test_a_camera_shows_what_hangs_at_the_robot_s_height_and_not_the_floor() -> None:
    camera = Pinhole(width=40, height=30, focal=35.0)
    near = NearPoints(
        {"camera": _info("camera", shape=(30, 40), camera=camera, range_min=0.3, range_max=8.0)}
    )
    floor = np.full((30, 40), np.inf)
    rows = np.arange(30)
    down = (rows - 14.5) / 35.0
    floor[down > 0] = (0.2 / down[down > 0])[:, None]
    assert len(near(_seen({"camera": Reading(0.0, floor)}), _NOTHING)) == 0
    gate = floor.copy()
    gate[down < -0.1] = 1.0  # from 0.3 m above the floor on
    points = near(_seen({"camera": Reading(0.0, gate)}), _NOTHING)
    assert len(points) == 40
    np.testing.assert_allclose(points[:, 0], 1.1)
    lintel = np.where(down < -0.35, 1.0, np.inf)[:, None] * np.ones(40)
    assert len(near(_seen({"camera": Reading(0.0, lintel)}), _NOTHING)) == 0


def test_near_sensors_are_taken_where_the_robot_has_them() -> None:
    sensors = {"front": _info("lidar"), "us0": _info("ultrasound"), "joy": _info("joystick")}
    needs = ("lidar", *(f"{want}?" for want in DwaSpec(near_sensors=True).wants))
    assert select_sensors(needs, sensors, "dwa") == ("front", "us0")
    assert DwaSpec().wants == ()
    with pytest.raises(InputError, match="needs 'imu'"):
        select_sensors(("imu",), sensors, "dwa")


def test_the_field_is_left_out_while_it_is_the_default() -> None:
    assert "near_sensors" not in DwaSpec().model_dump(mode="json")
    assert DwaSpec(near_sensors=True).model_dump(mode="json")["near_sensors"] is True
