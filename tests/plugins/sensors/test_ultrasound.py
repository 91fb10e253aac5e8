"""Ultrasound: its zone, the nearest thing in it."""

import math
from typing import cast

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from crowdbot.core.scenarios.library import open_spec
from crowdbot.core.sensing.build import build_sensor
from crowdbot.plugin import Pose, Sensor
from crowdbot.plugins.sensors.ultrasound_build import zone_length
from crowdbot.testing.sensor_scenes import context
from tests.core.sensing.sensing_worlds import REGISTRY, Array, read, scalar, scene_of, sensor

LENGTH, RADIUS = 4.5, 1.0
HALF = math.atan(8.0 * RADIUS / (3.0 * math.sqrt(3.0) * LENGTH))


def outline(t: Array) -> tuple[Array, Array]:
    """Along and across the axis, by the parameter of the design's formula."""
    along = 0.5 * LENGTH * (1.0 - np.cos(t))
    return along, 4.0 * RADIUS / (3.0 * math.sqrt(3.0)) * (1.0 - np.cos(t)) * np.sin(t)


def test_the_zone_is_the_drop() -> None:
    t = np.linspace(math.pi / 2, math.pi, 400)
    along, across = outline(t)
    angle = np.arctan2(across, along)
    assert across.max() == pytest.approx(RADIUS, abs=1e-4)
    assert math.degrees(HALF) == pytest.approx(18.9, abs=0.05)
    reach = zone_length(angle, LENGTH, RADIUS)
    np.testing.assert_allclose(reach, np.hypot(along, across), rtol=1e-6)
    assert zone_length(np.array([HALF + 1e-6, 1.0]), LENGTH, RADIUS).tolist() == [0.0, 0.0]


def test_info() -> None:
    info = sensor("ultrasound").info()
    assert (info.category, info.ros_type) == ("ultrasound", "sensor_msgs/msg/Range")
    assert info.shape == (1,)
    assert info.angles is not None
    assert np.ptp(info.angles) == pytest.approx(0.659, abs=1e-3)
    assert not info.random


@settings(max_examples=80)
@given(st.floats(-0.6, 0.6), st.floats(0.3, 5.0), st.floats(-3.0, 3.0))
def test_a_thin_post_is_seen_inside_the_zone_only(bearing: float, away: float, yaw: float) -> None:
    """A post as thin as the gap between rays; nothing is claimed about the very edge."""
    post = [away * math.cos(bearing + yaw), away * math.sin(bearing + yaw), 0.04 * away]
    got = scalar(sensor("ultrasound"), scene_of(pillars=[post]), Pose(0.0, 0.0, yaw))
    reach = float(zone_length(np.array([abs(bearing)]), LENGTH, RADIUS)[0])
    near = away - post[2]
    if abs(bearing) < HALF - 0.04 and near < reach - 0.1:
        assert got == pytest.approx(max(near, 0.2), rel=0.02)
    elif abs(bearing) > HALF + 0.06:
        assert math.isinf(got)


@pytest.mark.parametrize("bearing", [0.0, 8.0, 15.0])
def test_the_edge_of_the_drop(bearing: float) -> None:
    """A wall across the ray, just inside and just outside the reach at its bearing."""
    one, angle = sensor("ultrasound", resolution="0.5 deg"), math.radians(bearing)
    reach = float(zone_length(np.array([angle]), LENGTH, RADIUS)[0])
    for off, seen in ((-0.02, True), (0.05, False)):
        x, y = (reach + off) * math.cos(angle), (reach + off) * math.sin(angle)
        post = scene_of(pillars=[[x, y, 0.01 + 0.005 * reach]])
        assert math.isfinite(scalar(one, post)) is seen or off > 0.0
        if not seen:
            far = scene_of(pillars=[[1.05 * x, 1.05 * y, 0.01]])
            assert math.isinf(scalar(one, far))


@pytest.mark.parametrize("resolution", ["2 deg", "1.3 deg", "0.5 deg", "10 deg"])
@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_the_zone_is_searched_up_to_its_very_edge(resolution: str, side: float) -> None:
    """A plate across the edge, of which a hundredth of a degree is inside; and one outside."""
    one = sensor("ultrasound", resolution=resolution)
    for begin, seen in ((HALF - 2e-4, True), (HALF + 2e-4, False)):
        near, far = (1.5 * np.array([math.cos(a), side * math.sin(a)]) for a in (begin, 0.6))
        got = scalar(one, scene_of(walls=[[*near, *far]]))
        assert math.isfinite(got) is seen


SHAPES = st.sampled_from([(4.5, 1.0), (4.5, 0.3), (2.0, 1.5)])


def _nearest_in_zone(hit: Array, angle: Array, length: float, radius: float) -> float:
    """Least of distances along bearings that lie in the zone, by the design's formula.

    A wide zone reaches farther than its length to the sides; the sensor's range does not.
    """
    reach = np.minimum(zone_length(np.abs(angle), length, radius), length)
    seen = (hit >= 0.0) & (hit <= reach)
    return float(np.min(hit[seen], initial=math.inf))


@pytest.mark.slow
@settings(max_examples=100)
@example((2.0, 1.5), 1.0, 2.0, 0.0, 1.0)
@given(SHAPES, st.floats(-1.5, 1.5), st.floats(0.3, 4.6), st.floats(-3.0, 3.0), st.floats(0, 3))
def test_a_slanted_wall_is_measured_exactly(
    shape: tuple[float, float], tilt: float, away: float, yaw: float, cut: float
) -> None:
    """A wall anywhere, whole or from some point on: against a dense search of the zone."""
    length, radius = shape
    half = math.atan(8.0 * radius / (3.0 * math.sqrt(3.0) * length))
    angle = np.linspace(-half, half, 40_001)
    with np.errstate(divide="ignore"):
        hit = away / np.cos(angle - tilt)
    hit[away * np.tan(angle - tilt) < -cut] = -1.0
    best = _nearest_in_zone(hit, angle, length, radius)
    foot, along = (
        np.array([math.cos(tilt), math.sin(tilt)]),
        np.array([-math.sin(tilt), math.cos(tilt)]),
    )
    ends = np.array([away * foot - cut * along, away * foot + 99.0 * along])
    c, s = math.cos(yaw), math.sin(yaw)
    wall = (ends @ np.array([[c, s], [-s, c]])).ravel()
    one = sensor("ultrasound", range_max=length, radius=radius)
    got = scalar(one, scene_of(walls=[wall]), Pose(0.0, 0.0, yaw))
    if math.isinf(best):
        assert math.isinf(got) or got > 0.99 * length
    else:
        assert got == pytest.approx(max(best, 0.2), rel=3e-3)


@settings(max_examples=60)
@given(st.floats(-0.3, 0.3), st.floats(0.5, 4.6), st.floats(0.005, 0.5))
def test_what_faces_the_sensor_is_measured_exactly(
    bearing: float, away: float, radius: float
) -> None:
    """Posts of any width, between the rays too."""
    post = [away * math.cos(bearing), away * math.sin(bearing), min(radius, 0.5 * away)]
    near = away - post[2]
    if near < float(zone_length(np.array([abs(bearing)]), LENGTH, RADIUS)[0]) - 1e-6:
        got = scalar(sensor("ultrasound", resolution="10 deg"), scene_of(pillars=[post]))
        assert got == pytest.approx(max(near, 0.2), abs=1e-9)


@pytest.mark.parametrize("tilt", [0.0, 0.1, 0.25])
def test_a_wall_at_an_angle_reads_its_nearest_point_in_the_zone(tilt: float) -> None:
    """The foot of the perpendicular lies inside: that is the reading, not the axis' hit."""
    c, s = math.cos(tilt), math.sin(tilt)
    wall = [[2 * c + 9 * s, 2 * s - 9 * c, 2 * c - 9 * s, 2 * s + 9 * c]]
    assert scalar(sensor("ultrasound"), scene_of(walls=wall)) == pytest.approx(2.0, rel=2e-3)


def test_the_nearest_of_two_and_a_leg() -> None:
    far = scene_of([(3.0, 0.0)], walls=[[4.0, -9, 4.0, 9]], facing=math.pi / 2)
    front = 3.0 - 0.07 - 0.5 * 0.9 * 0.191 * 1.7
    assert scalar(sensor("ultrasound", mount={"z": 0.15}), far) == pytest.approx(front, rel=3e-3)


def test_floor_and_low_things() -> None:
    one = sensor("ultrasound", mount={"z": 0.15})
    assert math.isinf(scalar(one, scene_of()))  # the floor gives no echo
    step = scene_of(pillars=[[2.0, 0.0, 0.3]], pillar_heights=(0.0, 0.05))
    assert scalar(one, step) == pytest.approx(math.hypot(1.7, 0.11), rel=0.02)


def test_incidence_limit() -> None:
    tilted = scene_of(walls=[[2.0 - 9.0, -9.0, 2.0 + 9.0, 9.0]])  # 45 deg
    assert scalar(sensor("ultrasound"), tilted) < 2.0
    assert math.isinf(scalar(sensor("ultrasound", max_incidence="20 deg"), tilted))


def test_inside_a_body_and_too_near() -> None:
    one = sensor("ultrasound")
    assert scalar(one, scene_of(pillars=[[0.1, 0.0, 0.3]])) == 0.2
    assert scalar(one, scene_of(pillars=[[0.2, 0.0, 0.1]])) == 0.2
    for pose in (Pose(0, 0, 0.0), Pose(0, 0, 1.0)):
        assert math.isinf(scalar(one, scene_of(pillars=[[-0.5, -0.5, 0.3]]), pose))


def test_the_ring_of_the_challenge_sees_all_round() -> None:
    """A person of 0.3 m at 2 m is seen from every side, by the sensors that face it."""
    spec = open_spec("challenge-2020", REGISTRY).scenarios[0].robots["robot"].sensors
    ring = {
        f"us{k}": cast(Sensor, build_sensor(REGISTRY, spec[f"us{k}"], context())) for k in range(12)
    }
    for k, one in enumerate(ring.values()):
        x, y, z, yaw = one.info().mount
        assert math.hypot(x, y) == pytest.approx(0.17, abs=5e-4)
        assert math.remainder(yaw - k * math.pi / 6, math.tau) == pytest.approx(0.0, abs=1e-9)
        assert math.atan2(y, x) == pytest.approx(math.remainder(yaw, math.tau), abs=2e-3)
        assert (z, one.info().rate) == (0.15, 8.0)
    for bearing in np.arange(0.0, math.tau, 0.05):
        scene = scene_of(pillars=[[2 * math.cos(bearing), 2 * math.sin(bearing), 0.3]])
        found = [k for k, one in enumerate(ring.values()) if np.isfinite(read(one, scene)[0])]
        near = round(bearing / (math.pi / 6)) % 12
        assert near in found
        assert all(min((k - near) % 12, (near - k) % 12) <= 1 for k in found)
