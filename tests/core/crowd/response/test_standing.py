"""A robot that stands is touched by nobody who takes notice of it, and hardly with force."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from crowdbot.core.crowd import state as s
from crowdbot.core.crowd.response.parameters import Human
from tests.core.crowd.crowd_reference import Array
from tests.core.crowd.crowd_worlds import TICKS, challenge, rows
from tests.core.crowd.response.meetings import BODY, PERSON, Meeting, robot
from tests.core.crowd.response.test_human import CAPSULE, SQUARE
from tests.examples import costly


@given(
    y=st.floats(-0.6, 0.6), speed=st.floats(0.1, 1.8), late=st.booleans(), gap=st.floats(0.15, 4.0)
)
@costly(60)
def test_nobody_walks_into_a_robot_that_stands(
    y: float, speed: float, late: bool, gap: float
) -> None:
    """Not even late people, nor those in front of whom it appears; and no harder than it takes."""
    start = (-np.sqrt((BODY + PERSON + gap) ** 2 - y * y), y)
    meeting = Meeting([start], [(speed, 0.0)], [robot(0.0, 0.0)], late).run(5.0)
    assert not meeting.touched
    least = 0.5 * speed * speed / max(gap - Human().standing_gap, 0.02)
    assert meeting.peak <= max(6.0, 1.3 * least + 3.0)


@pytest.mark.parametrize("speed", [1.0, 1.6])
@pytest.mark.parametrize("y", [0.0, 0.1, 0.4])
def test_who_has_noticed_in_time_needs_no_force(speed: float, y: float) -> None:
    meeting = Meeting([(-6.0, y)], [(speed, 0.0)], [robot(0.0, 0.0)]).run(8.0)
    assert not meeting.touched
    assert meeting.peak <= 3.0 + 1e-9


@pytest.mark.parametrize(("outline", "radius"), [(SQUARE, 0.0), (CAPSULE, 0.15)])
@pytest.mark.parametrize("yaw", [0.0, 0.7])
def test_of_any_footprint(outline: Array, radius: float, yaw: float) -> None:
    row = robot(0.0, 0.0, 0.0, 0.0, radius, yaw, 0.0)
    for y in (-0.3, 0.01, 0.4):
        meeting = Meeting([(-3.0, y)], [(1.4, 0.0)], [row], late=True, outline=outline).run(5.0)
        assert not meeting.touched


def test_who_is_pushed_leans_back() -> None:
    """A push of 4 m/s^2 towards the robot does not bring anybody onto it."""
    meeting = Meeting([(-0.8, 0.0)], [(0.0, 0.0)], [robot(0.0, 0.0)])
    for _ in range(3 * TICKS):
        meeting.people[0, s.VX] += 4.0 / TICKS
        meeting.tick()
    assert not meeting.touched


def test_between_standing_and_moving_it_fades() -> None:
    """The same step towards a robot that stands, creeps and moves."""
    pushed = []
    for speed in (0.0, 0.05, 0.1, 0.2, 0.3, 0.6):
        meeting = Meeting([(-0.55, 0.0)], [(0.0, 0.0)], [robot(0.0, 0.0, 0.0, speed)], late=True)
        meeting.tick()
        pushed.append(float(np.hypot(*meeting.accelerations[0][0])))
    assert pushed[0] == pushed[1] > pushed[2] > pushed[3] > pushed[4] == pushed[5] == 0.0


def _hits(id_: str, at: tuple[float, float], speed: float, seconds: float, careful: bool) -> int:
    """Contacts of a robot on a straight way through a crowd of the challenge."""
    engine = challenge(id_)
    flat = engine.initial_state()
    people = rows(flat)
    near = np.hypot(people[:, s.X] - at[0], people[:, s.Y] - at[1]) < 1.0
    people[near, s.WAITING] = s.AT_PORTAL
    row = np.array([robot(*at)])
    for tick in range(round(seconds * TICKS)):
        if tick % 8 == 0:
            dx, dy = people[:, s.X] - row[0, 0], np.abs(people[:, s.Y] - row[0, 1])
            here = people[:, s.WAITING] == s.PRESENT
            blocked = careful and np.any(here & (dx > 0.0) & (dx < 1.6) & (dy < 0.7))
            change = (0.0 if blocked else speed) - row[0, 2]
            row[0, 2] += max(-1.0 / 16.0, min(1.0 / 16.0, change))
        engine.advance(flat, row)
        row[0, 0] += row[0, 2] / TICKS
    felt, touches = s.contact_with(flat)
    return int(felt[s.CONTACTS] + np.sum(touches[:, s.TOUCHING]))


@pytest.mark.slow
@pytest.mark.parametrize("cell", ["in-d0500-fast", "counter-d0500-dispersed"])
def test_a_parked_robot_is_not_touched(cell: str) -> None:
    assert _hits(f"{cell}-c20-r05", (25.0, 0.0), 0.0, 20.0, careful=False) == 0


@pytest.mark.slow
def test_a_blind_robot_hits_people_and_one_that_stops_hardly_any() -> None:
    cell = "counter-d0500-dispersed-c20-r05"
    blind = _hits(cell, (2.5, 0.0), 0.65, 60.0, careful=False)
    assert blind >= 2
    assert _hits(cell, (2.5, 0.0), 0.65, 60.0, careful=True) < blind


def test_nobody_is_thrown_aside() -> None:
    meeting = Meeting([(-4.0, 0.1)], [(1.6, 0.0)], [robot(0.0, 0.0, -0.6)])
    assert 0.0 < meeting.run(4.0).peak <= 3.0 + 1e-9
