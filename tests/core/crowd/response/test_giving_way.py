"""People as recorded near robots and vehicles: clearance by speed, giving way, hearing."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from crowdbot.core.crowd import Agents, CrowdEngine, CrowdWorld
from crowdbot.core.crowd import state as s
from crowdbot.core.crowd.response.from_spec import response_of
from crowdbot.core.crowd.response.parameters import Human
from crowdbot.dsl.scenario.robot_response import GivingWay, HumanResponse
from tests.core.crowd.response.meetings import BODY, PERSON, Meeting, Place, robot

WAY = response_of(GivingWay())
CART = 0.5 * np.array([[2.2, -1.2], [2.2, 1.2], [-2.2, 1.2], [-2.2, -1.2]])


def _closest(meeting: Meeting, seconds: float) -> float:
    """Run, and return the smallest gap to a disc, m."""
    least = math.inf
    for _ in range(round(seconds * 128)):
        meeting.tick()
        away = np.hypot(*(meeting.people[0, :2] - meeting.robots[0, :2]))
        least = min(least, float(away) - BODY - PERSON)
    return least


def _head_on(speed: float, response: Human = WAY) -> float:
    """Return the gap at which a person passes a robot that comes head on."""
    start = -4.5 * (1.3 + speed)
    meeting = Meeting([(start, 0.0)], [(1.3, 0.0)], [robot(0.0, 0.05, -speed)], response=response)
    return _closest(meeting, 7.0)


def test_the_old_response_has_none_of_the_new_parts() -> None:
    assert response_of(HumanResponse()) == Human()


def test_the_faster_the_robot_the_larger_the_gap_up_to_a_limit() -> None:
    gaps = [_head_on(speed) for speed in (0.5, 1.0, 2.0, 3.0, 4.5)]
    assert gaps[0] == pytest.approx(WAY.clearance, abs=0.12)
    assert gaps[1] == pytest.approx(WAY.clearance, abs=0.12)
    assert gaps[2] > gaps[1] + 0.25
    assert gaps[3] > gaps[2] + 0.1
    assert gaps[4] == pytest.approx(WAY.most_clearance, abs=0.35)
    assert max(_head_on(v, Human()) for v in (1.0, 3.0)) < 0.35


def test_people_differ_in_what_they_want() -> None:
    found = []
    for attention in (0.05, 0.5, 0.95):
        meeting = Meeting([(-8.0, 0.0)], [(1.3, 0.0)], [robot(0.0, 0.05, -0.6)], response=WAY)
        agents = replace(meeting.engine.agents, attention=np.array([attention]))
        meeting.engine = CrowdEngine(agents, meeting.engine.world, meeting.engine.policies)
        found.append(_closest(meeting, 6.0))
    assert found[0] < found[1] - 0.05 < found[2] - 0.1


@pytest.mark.parametrize("attention", [-0.1, 1.1, math.nan])
def test_attention_is_a_share(attention: float) -> None:
    with pytest.raises(ValueError, match="attention of agents must be from 0 to 1"):
        Agents.of(x=[0.0], y=[0.0], attention=attention)


def _crossing(lead: float, speed: float, response: Human, seconds: float = 9.0) -> Meeting:
    """A cart drives along y over the person's way, which the person reaches ``lead`` later."""
    ahead = 1.3 * (4.0 + lead)
    cart = robot(0.0, -4.0 * speed, 0.0, speed, 0.0, math.pi / 2, 0.0)
    meeting = Meeting(
        [(-ahead, 0.0)], [(1.3, 0.0)], [cart],
        outline=CART, response=response,
    )  # fmt: skip
    return meeting.run(seconds, until=lambda: bool(meeting.robots[0, 1] > 1.2))


@pytest.mark.parametrize("lead", [-0.2, 0.0, 0.3])
def test_a_person_gives_way_to_a_vehicle_by_slowing_down_and_then_walks_on(lead: float) -> None:
    meeting = _crossing(lead, 3.0, WAY)
    assert not meeting.touched
    assert meeting.people[0, s.X] < -1.1  # it passes first
    slowest = float(np.hypot(meeting.people[0, s.VX], meeting.people[0, s.VY]))
    assert slowest < 0.8 * 1.3
    meeting.run(6.0)
    assert meeting.people[0, s.X] > 1.0
    assert meeting.people[0, s.VX] > 1.2


def test_before_who_gives_way_passed_first() -> None:
    assert _crossing(-0.2, 3.0, Human()).people[0, s.X] > -1.1


def _passes_first(speed: float, heading: float, early: float, response: Human) -> bool:
    """Cross the way of a car of 4.4 m whose front is ``early`` nearer than where both meet."""
    ahead = np.array([math.cos(heading), math.sin(heading)])
    at = -(4.0 * speed + early) * ahead
    car = robot(*at, *(speed * ahead), 0.0, heading, 0.0)
    meeting = Meeting([(-5.2, 0.0)], [(1.3, 0.0)], [car], outline=2.0 * CART, response=response)

    def before() -> bool:
        away = meeting.people[0, :2] - meeting.robots[0, :2]
        return bool(ahead[0] * away[1] - ahead[1] * away[0] > 0.0)  # to the left of its way

    meeting.run(9.0, until=lambda: not before())
    return float((meeting.people[0, :2] - meeting.robots[0, :2]) @ ahead) > 0.0


@pytest.mark.parametrize("heading", [60.0, 90.0, 120.0])
def test_people_wait_for_all_of_a_vehicle_and_not_for_a_robot(heading: float) -> None:
    at, never = math.radians(heading), replace(WAY, waiting_speed=math.inf)
    assert not any(_passes_first(v, at, 2.0, WAY) for v in (1.8, 3.0, 4.5))
    assert _passes_first(1.8, at, 2.0, never)
    assert _passes_first(1.8, at, 5.0, WAY)  # well before it
    assert _passes_first(1.2, at, 2.0, WAY)


def test_below_the_speed_of_vehicles_nothing_is_waited_for() -> None:
    def state(speed: float, response: Human) -> bytes:
        return _crossing(-0.9, speed, response, 4.0).state

    never = replace(WAY, waiting_speed=math.inf)
    assert state(1.2, WAY) == state(1.2, never)
    assert state(1.6, WAY) != state(1.6, never)


def test_a_person_far_ahead_of_a_vehicle_is_not_stopped() -> None:
    meeting = _crossing(-3.0, 3.0, WAY)
    assert meeting.people[0, s.X] > 1.5
    assert not meeting.touched


@pytest.mark.parametrize("at", [(-8.0, 0.0), (-8.0, -1.0), (0.0, -8.0)])
def test_nobody_speeds_up_by_more_than_walkers_do(at: Place) -> None:
    meeting = Meeting([(-6.0, 0.0)], [(1.3, 0.0)], [robot(*at, *(-0.6 * np.array(at) / 8.0))],
                      response=WAY)  # fmt: skip
    meeting.run(10.0)
    fastest = np.max(np.cumsum(np.array(meeting.accelerations)[:, 0, 0]) / 128.0)
    assert fastest < 0.3 * 1.3 + 0.6 / 16.0


def test_a_vehicle_from_behind_is_heard_and_a_slow_robot_is_not() -> None:
    def aside(speed: float, response: Human) -> float:
        meeting = Meeting([(0.0, 0.05)], [(1.0, 0.0)], [robot(-4.5 * (speed - 1.0), 0.0, speed)],
                          response=response)  # fmt: skip
        return _closest(meeting, 6.0)

    assert aside(3.0, WAY) > 0.5
    assert aside(3.0, response_of(GivingWay(hears=False))) < 0.0


def test_a_vehicle_is_seen_by_time_and_a_robot_by_distance() -> None:
    meeting = Meeting([(0.0, 0.0)], [(1.3, 0.0)], [robot(16.0, 0.0, -4.0)], response=WAY)
    meeting.run(1.0, until=lambda: bool(meeting.people[0, s.NOTICED] != s.UNAWARE))
    assert meeting.people[0, s.NOTICED] == 0.0
    slow = Meeting([(0.0, 0.0)], [(1.3, 0.0)], [robot(16.0, 0.0, -0.3)], response=WAY)
    slow.run(1.0)
    assert slow.people[0, s.NOTICED] == s.UNAWARE


@pytest.mark.parametrize("side", [-0.2, 0.0, 0.1, 0.4])
def test_a_parked_robot_is_never_touched(side: float) -> None:
    for attention in (0.0, 0.3, 1.0):
        meeting = Meeting([(-5.0, side)], [(1.3, 0.0)], [robot(0.0, 0.0)], response=WAY)
        agents = replace(meeting.engine.agents, attention=np.array([attention]))
        meeting.engine = CrowdEngine(agents, CrowdWorld(response=WAY), meeting.engine.policies)
        meeting.run(8.0)
        assert not meeting.touched
        assert meeting.people[0, s.X] > 1.0
