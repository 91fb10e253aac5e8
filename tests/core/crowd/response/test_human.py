"""People notice robots, react, and evade them within what legs can do."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from crowdbot.core.crowd import state as s
from crowdbot.core.crowd.response.parameters import Human
from tests.core.crowd.crowd_reference import Array
from tests.core.crowd.response.meetings import BODY, PERSON, Meeting, Place, robot
from tests.examples import costly

SQUARE = 0.25 * np.array([[1.0, -1.0], [1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0]])
CAPSULE = np.array([[-0.3, 0.0], [0.3, 0.0]])
REACTION = Human().reaction_time


def _turn(place: Place, angle: float) -> Place:
    c, sine = math.cos(angle), math.sin(angle)
    return c * place[0] - sine * place[1], sine * place[0] + c * place[1]


# ------------------------------------------------------------------------ evading
@given(
    way=st.floats(-math.pi, math.pi), pace=st.floats(0.0, 0.65),
    own=st.floats(0.3, 1.8), miss=st.floats(-0.4, 0.4),
)  # fmt: skip
@costly(60)
def test_nobody_walks_into_a_robot_that_he_sees_and_that_keeps_its_course(
    way: float, pace: float, own: float, miss: float
) -> None:
    """Both are on the way to (almost) one point, 4 m ahead of the robot's or the person's feet."""
    when = 4.0 / max(own, pace)
    velocity = pace * math.cos(way), pace * math.sin(way)
    x, y = -when * velocity[0], miss - when * velocity[1]
    assume(math.hypot(x + own * when, y) > 2.5)  # far enough apart to begin with
    assume(abs(math.atan2(y, x + own * when)) < 1.6)  # in view
    meeting = Meeting([(-own * when, 0.0)], [(own, 0.0)], [robot(x, y, *velocity)])
    meeting.run(2.0 * when)
    assert not meeting.touched
    assert meeting.peak <= 3.0 + 1e-9


@given(
    at=st.tuples(st.floats(-6, 6), st.floats(-3, 3)), v=st.tuples(*[st.floats(-1.5, 1.5)] * 2),
    pace=st.tuples(*[st.floats(-0.7, 0.7)] * 2), late=st.booleans(),
)  # fmt: skip
@costly(60)
def test_will_and_evasion_together_keep_within_the_cap(
    at: Place, v: Place, pace: Place, late: bool
) -> None:
    """Beside a robot that moves there is no other force, however it moves, until they touch."""
    assume(math.hypot(*at) > 1.0 and math.hypot(*pace) > 0.31)
    meeting = Meeting([at], [v], [robot(0.0, 0.0, *pace)], late)
    meeting.run(6.0, until=lambda: meeting.touched)
    free = np.array(meeting.accelerations[:-1] or [np.zeros((1, 2))])
    assert np.max(np.hypot(free[..., 0], free[..., 1])) <= 3.0 + 1e-9


def test_a_head_on_robot_is_passed_with_the_clearance_that_people_want() -> None:
    meeting = Meeting([(-8.0, 0.0)], [(1.3, 0.0)], [robot(0.0, 0.1, -0.6)])
    least = math.inf
    for _ in range(8 * 128):
        meeting.tick()
        away = np.hypot(*(meeting.people[0, :2] - meeting.robots[0, :2]))
        least = min(least, float(away) - BODY - PERSON)
    assert least == pytest.approx(Human().clearance, abs=0.1)
    assert meeting.people[0, s.Y] < 0.0  # the shorter way round
    assert meeting.people[0, s.X] > 0.0


@pytest.mark.parametrize(("outline", "radius"), [(SQUARE, 0.0), (CAPSULE, 0.15)])
@pytest.mark.parametrize("yaw", [0.0, 0.5, 1.5])
def test_any_footprint_is_evaded_and_a_long_one_by_more(
    outline: Array, radius: float, yaw: float
) -> None:
    row = robot(0.0, 0.1, -0.5, 0.0, radius, yaw, 0.0)
    meeting = Meeting([(-8.0, 0.0)], [(1.3, 0.0)], [row], outline=outline)
    meeting.run(8.0)
    assert not meeting.touched
    corners = outline @ np.array([[math.cos(yaw), math.sin(yaw)], [-math.sin(yaw), math.cos(yaw)]])
    beside = 0.1 - float(np.max(-corners[:, 1])) - radius - PERSON
    lowest = float(meeting.people[0, s.Y])
    assert meeting.people[0, s.X] > 0.5
    assert lowest < beside - 0.1


def test_a_segment_without_length_is_a_disc() -> None:
    disc = Meeting([(-8.0, 0.0)], [(1.3, 0.0)], [robot(0.0, 0.1, -0.5)]).run(7.0)
    capsule = Meeting(
        [(-8.0, 0.0)], [(1.3, 0.0)], [robot(0.0, 0.1, -0.5)], outline=np.zeros((2, 2))
    ).run(7.0)
    assert capsule.people[0, :4] == pytest.approx(disc.people[0, :4], abs=1e-9)


# ------------------------------------------------------------------------ symmetry
@given(
    at=st.tuples(st.floats(-5, -2), st.floats(-1, 1)),
    v=st.tuples(st.floats(0.5, 1.8), st.floats(-0.3, 0.3)),
    pace=st.tuples(st.floats(-0.6, 0.6), st.floats(-0.6, 0.6)), late=st.booleans(),
    angle=st.floats(-3, 3), by=st.tuples(st.floats(-9, 9), st.floats(-9, 9)), flip=st.booleans(),
)  # fmt: skip
@costly(40)
def test_no_place_direction_or_side_is_preferred(
    at: Place, v: Place, pace: Place, late: bool, angle: float, by: Place, flip: bool
) -> None:
    """Turned, shifted and mirrored meetings end turned, shifted and mirrored."""
    w = np.subtract(v, pace)
    assume(abs(at[0] * w[1] - at[1] * w[0]) > 1e-3 * np.hypot(*w))  # no exact tie of both sides

    def mapped(place: Place, shift: bool) -> Place:
        x, y = _turn((place[0], -place[1] if flip else place[1]), angle)
        return (x + by[0], y + by[1]) if shift else (x, y)

    one = Meeting([at], [v], [robot(0.0, 0.0, *pace)], late).run(2.5)
    origin = mapped((0.0, 0.0), shift=True)
    two = Meeting(
        [mapped(at, shift=True)], [mapped(v, shift=False)],
        [robot(*origin, *mapped(pace, shift=False))], late,
    ).run(2.5)  # fmt: skip
    assume(not one.touched)
    x, y, vx, vy = one.people[0, :4].tolist()
    assert two.people[0, :2] == pytest.approx(mapped((x, y), shift=True), abs=1e-5)
    assert two.people[0, 2:4] == pytest.approx(mapped((vx, vy), shift=False), abs=1e-5)


# --------------------------------------------------------------------- far and absent
@pytest.mark.parametrize("late", [False, True])
def test_a_robot_far_away_changes_nobody_by_a_bit(late: bool) -> None:
    people, v = [(0.0, 0.0), (0.4, 1.0)], [(1.2, 0.0), (0.5, 0.4)]
    alone = Meeting(people, v, [], late).run(5.0)
    watched = Meeting(people, v, [robot(3.0, 40.0)], late).run(5.0)
    assert watched.state == alone.state


def test_the_same_meeting_is_the_same_bytes() -> None:
    made = [
        Meeting(
            [(-3.0, 0.1), (-4.0, 0.6)], [(1.4, 0.0)] * 2, [robot(0.0, 0.0, -0.5)], [True, False]
        )
        for _ in range(2)
    ]
    assert made[0].run(4.0).state == made[1].run(4.0).state


# ------------------------------------------------------------------------- noticing
def _first_reaction(meeting: Meeting) -> float:
    meeting.run(9.0, until=lambda: meeting.peak > 1e-6 if meeting.accelerations else False)
    return meeting.now


@pytest.mark.parametrize("speed", [0.8, 1.4, 1.8])
def test_late_people_notice_at_their_time_to_contact(speed: float) -> None:
    meeting = Meeting([(-9.0, 0.05)], [(speed, 0.0)], [robot(0.0, 0.0, -0.5)], late=True)
    noticed = Human().late_time * (speed + 0.5)  # surface gap
    due = (9.0 - BODY - PERSON - noticed) / (speed + 0.5) + REACTION
    assert due - 0.02 <= _first_reaction(meeting) <= due + 3.0 / 16.0


def test_attentive_people_have_time() -> None:
    meeting = Meeting([(-5.0, 0.05)], [(1.4, 0.0)], [robot(0.0, 0.0, -0.5)])
    seconds = (5.0 - BODY - PERSON) / 1.9
    assert _first_reaction(meeting) < seconds - 1.5
    late = Meeting([(-5.0, 0.05)], [(1.4, 0.0)], [robot(0.0, 0.0, -0.5)], late=True)
    assert _first_reaction(late) > seconds - 0.5


def test_nobody_reacts_before_the_reaction_time() -> None:
    meeting = Meeting([(-1.5, 0.05)], [(1.0, 0.0)], [robot(0.0, 0.0, -0.5)])
    assert REACTION <= _first_reaction(meeting) <= REACTION + 2.0 / 16.0


def test_nobody_sees_behind_his_back() -> None:
    """Overtaken from behind, attentive or not, until they are touched."""
    meeting = Meeting([(0.0, 0.0)], [(0.3, 0.0)], [robot(-3.0, 0.0, 1.0)])
    meeting.run(9.0, until=lambda: meeting.touched)
    assert meeting.touched
    assert np.max(np.abs(np.array(meeting.accelerations[:-1]))) < 1e-9


def test_who_has_noticed_forgets_beyond_sight_and_outside_the_world() -> None:
    meeting = Meeting([(-3.0, 0.5)], [(1.4, 0.0)], [robot(0.0, 0.0)])
    meeting.tick()
    assert meeting.people[0, s.NOTICED] == 0.0
    meeting.run(7.0, until=lambda: meeting.people[0, s.NOTICED] == s.UNAWARE)
    gap = math.hypot(*meeting.people[0, :2]) - BODY - PERSON
    assert Human().sight < gap < Human().sight + 0.2
    again = Meeting([(-3.0, 0.5)], [(1.4, 0.0)], [robot(0.0, 0.0)])
    again.tick()
    again.people[0, s.WAITING] = s.GONE
    again.run(0.1)
    assert again.people[0, s.NOTICED] == s.UNAWARE


# --------------------------------------------------------------------- several robots
def test_evasions_of_several_robots_add_up_within_the_cap() -> None:
    """Two robots at the same place count twice, as far as people can."""
    sides = {}
    for count in (1, 2, 8):
        meeting = Meeting([(-4.0, 0.3)], [(1.4, 0.0)], [robot(0.0, 0.0, -0.3)] * count)
        _first_reaction(meeting)
        sides[count] = meeting.accelerations[-1][0]
    assert sides[2] == pytest.approx(2.0 * sides[1], abs=1e-6)
    assert np.hypot(*sides[8]) <= 3.0 + 1e-9


def test_who_has_noticed_one_robot_looks_out_for_another() -> None:
    """Even for one at the edge of what he would have seen; without the first he walks on."""
    behind = robot(-3.2, 0.0, 2.4)
    ahead = robot(5.0, 3.0)
    alone = Meeting([(0.0, 0.05)], [(1.0, 0.0)], [behind]).run(1.2)
    both = Meeting([(0.0, 0.05)], [(1.0, 0.0)], [behind, ahead]).run(1.2)
    assert np.max(np.abs(alone.accelerations)) < 1e-9
    assert np.max(np.abs(both.accelerations)) > 0.3


# ----------------------------------------------------------------------- hidden motion
def test_who_does_not_see_how_the_robot_moves_takes_it_for_standing() -> None:
    meeting = Meeting([(-7.5, 0.05)], [(1.4, 0.0)], [robot(0.0, 0.0, -0.5)])
    hidden = Meeting([(-7.5, 0.05)], [(1.4, 0.0)], [robot(0.0, 0.0, -0.5)])
    object.__setattr__(hidden.engine.world, "robot_visible", False)
    assert _first_reaction(hidden) > _first_reaction(meeting) + 0.2
