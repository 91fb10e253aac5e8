"""People found in lidar points by their legs."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from crowdbot.core.sensing.noise import sensor_rng
from crowdbot.core.sensing.points import LidarPoints
from crowdbot.core.sensing.scene import Scene
from crowdbot.plugin import Pose, Reading, RobotState
from crowdbot.plugins.planners.shared.people_build import carry, people_in, with_discs
from tests.plugins.planners.world import lidars

Array = NDArray[np.float64]
NOTHING = np.empty((0, 2))


def seen(
    people: Array, facing: float = 0.0, walls: Array | None = None, phase: float = 0.0
) -> Array:
    """What the two lidars of the challenge's robot show of walking people, base frame."""
    count = len(people)
    lines = np.empty((0, 4)) if walls is None else walls
    scene = Scene(lines, [0.0, 2.5], np.full(count, 0.33), 1.7)
    way = np.tile([math.cos(facing), math.sin(facing)], (count, 1))
    robot = RobotState(0, 0, 0, 0, 0, 0, 0, 0.0102, 0, 0)
    xyv = np.column_stack([people, way])
    scene.update(robot, xyv, np.ones(count, np.bool_), way, np.full(count, phase))
    sensors = lidars()
    readings = {
        n: Reading(0.0, s.read(scene, Pose(0, 0, 0), 0.0, sensor_rng(0, "r", n, 0)))
        for n, s in sensors.items()
    }
    return LidarPoints({n: s.info() for n, s in sensors.items()})(readings, 0.0, (0.0, 0.0))


@settings(max_examples=100)
@given(
    st.floats(1.4, 5.5),
    st.floats(-math.pi, math.pi),
    st.floats(-math.pi, math.pi),
    st.floats(0.0, 1.4),
)
def test_one_person_is_found_where_it_is(
    away: float, bearing: float, facing: float, phase: float
) -> None:
    """To within half a step: one leg may hide the other."""
    where = np.array([[away * math.cos(bearing), away * math.sin(bearing)]])
    people, rest = people_in(seen(where, facing, phase=phase), 6.0)
    assert len(people) >= 1
    assert np.hypot(*(people - where).T).max() < 0.3
    assert (np.hypot(*(rest - where).T) < 0.33).all()  # of a leg that the other one covers


@pytest.mark.parametrize("facing", [0.0, math.pi])
def test_both_legs_give_the_middle(facing: float) -> None:
    where = np.array([[2.5, 0.4], [4.0, -1.5]])
    for phase in (0.0, 0.2, 0.4):
        people, _ = people_in(seen(where, facing, phase=phase), 6.0)
        assert len(people) == 2
        np.testing.assert_allclose(people[np.argsort(people[:, 0])], where, atol=0.08)


def test_walls_are_nobody() -> None:
    walls = np.array([[-1.0, -3.0, 9.0, -3.0], [-1.0, 3.0, 9.0, 3.0], [5.0, -3.0, 5.0, 3.0]])
    points = seen(np.empty((0, 2)), walls=walls)
    people, rest = people_in(points, 6.0)
    assert len(people) == 0
    np.testing.assert_array_equal(rest, points)


def test_a_piece_of_wall_between_two_people_is_nobody() -> None:
    wall = np.array([[4.0, -9.0, 4.0, 9.0]])
    where = np.array([[2.0, -0.3], [2.0, 0.3]])
    people, _ = people_in(seen(where, walls=wall), 3.0)
    assert (people[:, 0] < 2.5).all()
    assert 2 <= len(people) <= 3


def test_those_out_of_reach_stay_points() -> None:
    points = seen(np.array([[4.0, 0.0]]))
    assert len(people_in(points, 3.0)[0]) == 0
    np.testing.assert_array_equal(people_in(points, 3.0)[1], points)
    np.testing.assert_array_equal(people_in(points, 0.0)[1], points)
    assert [len(x) for x in people_in(NOTHING, 6.0)] == [0, 0]


def test_very_near_legs_stay_as_well() -> None:
    people, rest = people_in(seen(np.array([[0.6, 0.1]])), 6.0)
    assert len(people) >= 1
    assert len(rest) > 0


@given(st.floats(0.5, 6.0), st.floats(-3.0, 3.0))
def test_discs_are_what_a_lidar_would_see(away: float, bearing: float) -> None:
    people = np.array([[away * math.cos(bearing), away * math.sin(bearing)]])
    wall = np.array([[9.0, 9.0]])
    points = with_discs(wall, people, 0.33)
    assert points[0].tolist() == [9.0, 9.0]
    arc = points[1:]
    np.testing.assert_allclose(np.hypot(*(arc - people).T), 0.33)
    gap = np.hypot(*arc.T)
    assert gap.min() == pytest.approx(away - 0.33)
    assert gap.max() == pytest.approx(math.sqrt(away**2 - 0.33**2))  # the tangent
    assert len(with_discs(wall, np.array([[0.2, 0.1]]), 0.33)) == 1  # around the robot


def test_points_of_a_disc_move_with_their_person() -> None:
    people, going = np.array([[2.0, 0.0], [2.5, 0.0]]), np.array([[-1.0, 0.0], [0.5, 0.5]])
    points = np.array([[1.67, 0.0], [2.83, 0.0], [5.0, 0.0], [2.2, 0.2]])
    velocities = np.full((4, 2), 9.0)
    carry(points, velocities, people, going, 0.33)
    assert velocities.tolist() == [[-1.0, 0.0], [0.5, 0.5], [9.0, 9.0], [-1.0, 0.0]]
