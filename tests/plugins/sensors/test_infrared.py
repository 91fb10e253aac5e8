"""Infrared: a narrow beam that sees what faces it."""

import math

import numpy as np
import pytest

from crowdbot.plugin import Pose
from tests.core.sensing.sensing_worlds import read, scalar, scene_of, sensor


def facing_wall(tilt: float, away: float = 2.0) -> list[list[float]]:
    """A long wall through (away, 0), its normal at an angle to the x axis."""
    c, s = 9.0 * math.cos(tilt), 9.0 * math.sin(tilt)
    return [[away + s, -c, away - s, c]]


def test_info() -> None:
    info = sensor("infrared").info()
    assert (info.category, info.ros_type, info.shape) == ("infrared", "sensor_msgs/msg/Range", (1,))
    assert info.random
    assert info.angles is not None
    assert np.degrees(info.angles) == pytest.approx([-0.5, 0.5])


@pytest.mark.parametrize("yaw", [0.0, 1.0, -2.5])
def test_a_wall_ahead_whatever_the_heading(yaw: float) -> None:
    c, s = math.cos(yaw), math.sin(yaw)
    wall = [[2 * c + 9 * s, 2 * s - 9 * c, 2 * c - 9 * s, 2 * s + 9 * c]]
    got = scalar(sensor("infrared"), scene_of(walls=wall), Pose(0.0, 0.0, yaw))
    assert got == pytest.approx(2.0, rel=1e-4)


def test_reads_the_nearest_ray_of_the_cone() -> None:
    """On a wall at 30 deg a cone of 5 deg meets 2 m / (cos + sin tan 30) first, nearly."""
    edge = math.radians(5.0)
    one = sensor("infrared", dispersion="5 deg", rays=3000)
    got = scalar(one, scene_of(walls=facing_wall(math.radians(30))))
    shortest = 2.0 * math.cos(math.radians(30)) / math.cos(math.radians(30) - edge)
    assert shortest <= got < shortest * 1.001


@pytest.mark.parametrize(("degrees", "seen"), [(0, True), (44, True), (46, False), (80, False)])
def test_incidence_limit(degrees: float, seen: bool) -> None:
    scene = scene_of(walls=facing_wall(math.radians(degrees)))
    assert math.isfinite(scalar(sensor("infrared"), scene)) is seen
    assert math.isfinite(scalar(sensor("infrared", max_incidence="90 deg"), scene))


def test_what_is_behind_a_slanting_surface_stays_hidden() -> None:
    scene = scene_of(walls=[*facing_wall(math.radians(60), 1.0), *facing_wall(0.0, 2.0)])
    assert math.isinf(scalar(sensor("infrared"), scene))


def test_beside_the_beam_nothing_is_seen() -> None:
    beam = 2.0 * math.tan(math.radians(0.5))
    one = sensor("infrared", rays=1000)
    assert scalar(one, scene_of(pillars=[[2.1, 0.0, 0.1]])) == pytest.approx(2.0, abs=1e-3)
    assert math.isinf(scalar(one, scene_of(pillars=[[2.1, 0.1 + 1.2 * beam, 0.1]])))


def test_rays_are_uniform_in_their_distance_from_the_axis() -> None:
    """Twice as dense at half the distance: the share of readings that a post at the rim stops."""
    one = sensor("infrared", dispersion="10 deg", rays=1, max_incidence="90 deg")
    rim = math.tan(math.radians(10.0))
    scene = scene_of(walls=[[1.0, 0.5 * rim, 1.0, 9.0]], robot_z=1.0)
    hits = sum(math.isfinite(scalar(one, scene, tick=k)) for k in range(4000)) / 4000
    # y = u cos(a) > 1/2, u uniform: integral over u in (1/2, 1) of acos(1 / (2 u)) / pi.
    u = np.linspace(0.5, 1.0, 20_001)
    expected = np.trapezoid(np.arccos(0.5 / u) / math.pi, u)
    assert hits == pytest.approx(expected, abs=4 * math.sqrt(expected / 4000))


def test_inside_a_body_and_another_tick() -> None:
    one = sensor("infrared", rays=5, dispersion="5 deg")
    assert scalar(one, scene_of(pillars=[[0.0, 0.0, 1.0]])) == 0.2
    wall = scene_of(walls=facing_wall(0.3))
    assert read(one, wall, tick=1) == read(one, wall, tick=1)
    assert read(one, wall, tick=1) != read(one, wall, tick=2)
