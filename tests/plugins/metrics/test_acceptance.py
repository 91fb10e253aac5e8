"""acceptance: planted drives, each fault lowers it, and what the card says that one costs."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from crowdbot.core.trajectories.trajectories import Trajectories
from tests.plugins.metrics.scenes import (
    AGENT_RADIUS,
    REACH,
    Array,
    Body,
    grid,
    line,
    scene,
    scores_of,
    value_of,
    why,
)

T = grid(10, 1 / 16)
STANDS = line(T, (0, 0), (0, 0))


def acceptance(run: Trajectories, **fields: Any) -> float:
    return value_of(scores_of("acceptance", run, **fields))


def passing(beside: float, speed: float = 0.5, **more: Any) -> Trajectories:
    """Past somebody who stands in the middle of the way, at this gap."""
    robot = line(T, (-2.5, beside + REACH), (speed, 0))
    return scene(T, robot, [STANDS], **more)


def following(gap: float) -> Trajectories:
    return scene(T, line(T, (0, 0), (0.5, 0)), [line(T, (REACH + gap, 0), (0.5, 0))])


def stopping(gap: float) -> Trajectories:
    """Up to somebody's chest at 0.5 m/s, where the robot stays."""
    x = np.minimum(-2.0 + 0.5 * T, -REACH - gap)
    v = np.where(x < -REACH - gap, 0.5, 0.0)
    return scene(T, Body(x, 0 * T, v, 0 * T), [STANDS])


def cutting_in(speed: float = 0.5, ahead: float = 0.3) -> Trajectories:
    """Across the way of a walker, who has to stop at this gap."""
    robot = line(T, (0.0, -speed * 5.0), (0, speed))
    x = -REACH - ahead - 1.2 * np.maximum(0.0, 5.0 - T)
    return scene(T, robot, [Body(x, 0 * T, np.where(T < 5.0, 1.2, 0.0), 0 * T)])


def forcing_aside() -> Trajectories:
    """A walker who comes head-on steps aside in the last second, by as much as it takes."""
    aside = (REACH + 0.03) * np.clip((T - 4.0) / 1.0, 0.0, 1.0)
    walker = Body(1.2 * (5.0 - T), aside, -1.2 + 0 * T, np.gradient(aside, T))
    return scene(T, line(T, (-2.5, 0), (0.5, 0)), [walker])


@pytest.mark.parametrize(
    ("run", "most"),
    [
        (following(0.5), 0.9),
        (stopping(0.3), 0.75),
        (cutting_in(), 0.7),
        (forcing_aside(), 0.65),
        (passing(-0.1), 0.5),
    ],
)
def test_planted_faults_cost_what_the_card_says(run: Trajectories, most: float) -> None:
    assert acceptance(run) <= most


def moving(t: Array, x: Array, y: Array) -> Body:
    """Along these points."""
    still = 0.0 * t
    return Body(x + still, y + still, np.gradient(x + still, t), np.gradient(y + still, t))


def behind(gap: float, speed: float, seconds: float) -> Trajectories:
    """Behind a walker, at this gap."""
    t = grid(seconds, 1 / 16)
    return scene(t, moving(t, speed * t - REACH - gap, 0 * t), [line(t, (0, 0), (speed, 0))])


def before_a_chest(gap: float, speed: float, comes: float) -> Trajectories:
    """Up to this gap from a person, who stands or comes nearer; both stop at the same time."""
    left = np.maximum(0.0, 5.0 - T)
    robot, person = moving(T, -speed * left, 0 * T), moving(T, REACH + gap + comes * left, 0 * T)
    return scene(T, robot, [person])


def across(ahead: float, speed: float, walks: float, degrees: float) -> Trajectories:
    """Across the way of a walker who stops at this gap, and walks on behind the robot."""
    way = np.array([np.cos(np.radians(degrees)), np.sin(np.radians(degrees))])
    later = np.maximum(0.0, T - 5.3 - 1.2 / speed)
    x = -REACH - ahead + walks * (later - np.maximum(0.0, 5.0 - T))
    return scene(T, line(T, tuple(-5.0 * speed * way), tuple(speed * way)), [moving(T, x, 0 * T)])


def aside(room: float, seconds: float, speed: float, walks: float) -> Trajectories:
    """Towards a person who stands or walks, and steps aside by this room in so many seconds."""
    y = (REACH + room) * np.clip((T - 5.0 + seconds) / seconds, 0.0, 1.0)
    return scene(T, line(T, (-5.0 * speed, 0), (speed, 0)), [moving(T, walks * (5.0 - T), y)])


SLOW_TO_FAST = (0.2, 0.5, 1.2)


@pytest.mark.parametrize("speed", SLOW_TO_FAST)
def test_planted_faults_cost_at_all_speeds_and_angles(speed: float) -> None:
    """Each is compared with its polite sibling."""
    for seconds in (6.0, 30.0):
        polite = acceptance(behind(2.0, speed, seconds))
        assert acceptance(behind(0.5, speed, seconds)) < polite - 0.08
    for comes in (0.0, 0.6, 1.3):
        polite = acceptance(before_a_chest(1.5, speed, comes))
        assert acceptance(before_a_chest(0.3, speed, comes)) < polite - 0.1
    for walks, degrees in ((0.6, 60.0), (1.3, 90.0), (1.0, 120.0)):
        polite = acceptance(across(2.5, speed, walks, degrees))
        assert acceptance(across(0.3, speed, walks, degrees)) < polite - 0.15
    for walks, seconds in ((0.0, 0.5), (0.6, 1.0), (1.3, 0.5)):
        polite = acceptance(aside(1.2, 5.0, speed, walks))
        assert acceptance(aside(0.1, seconds, speed, walks)) < polite - 0.3


def test_a_polite_pass_costs_little_and_each_fault_is_named() -> None:
    polite = acceptance(passing(2.0))
    assert 0.95 <= polite <= 1.0
    faults = scores_of("acceptance", forcing_aside())["corrected"].extras
    assert faults["forcing"] > 0.5
    assert faults["fast"] > 0.1
    assert faults["touched"] == faults["wall"] == faults["not_arrived"] == 0.0


def test_arrival_and_walls_count() -> None:
    run: dict[str, Any] = {"goal_time": 9.0, "robot_goal": (2.0, 0.0)}
    there, missed = passing(2.0, **run), passing(2.0, robot_goal=(9.0, 0.0))
    assert acceptance(missed) / acceptance(there) == pytest.approx(np.exp(-1.0), rel=0.01)
    wall = np.array([[-3.0, 2.0 + REACH, 9.0, 2.0 + REACH]])
    scraped = passing(2.0, walls=wall, **run)
    assert acceptance(scraped) / acceptance(there) == pytest.approx(np.exp(-0.3), rel=0.01)


@given(near=st.floats(-0.1, 1.5), more=st.floats(0.0, 1.0))
@settings(max_examples=30, deadline=None)
def test_more_room_is_never_worse(near: float, more: float) -> None:
    assert acceptance(passing(near + more)) >= acceptance(passing(near)) - 1e-9


@given(slow=st.floats(0.1, 0.5), more=st.floats(1.0, 2.0), beside=st.floats(0.05, 0.6))
@settings(max_examples=30, deadline=None)
def test_at_the_same_gap_and_for_the_same_time_faster_is_never_better(
    slow: float, more: float, beside: float
) -> None:
    fields = {"crowding": 0.0}  # a share of time, which is shorter for who is fast
    assert acceptance(passing(beside, slow * more), **fields) <= (
        acceptance(passing(beside, slow), **fields) + 0.02
    )


def test_failures() -> None:
    assert why(scores_of("acceptance", scene(T, None, [STANDS]))) == {
        ("undefined", "invalid_no_robot")
    }
    assert why(scores_of("acceptance", scene(T, line(T, (0, 0), (1, 0))))) == {
        ("undefined", "no_agents")
    }
    assert AGENT_RADIUS < REACH
