"""DWA in the test world."""

import math

import numpy as np
import pytest
from numpy.typing import ArrayLike, NDArray

from crowdbot.core.registry.build_reference import load_build
from crowdbot.plugin import Pose
from crowdbot.plugins.planners.dwa.dwa import DWA, DwaSpec
from crowdbot.plugins.planners.dwa.dwa_build import build
from crowdbot.plugins.planners.goal_seek import GoalSeekSpec
from crowdbot.plugins.planners.goal_seek_build import build as build_goal_seek
from tests.plugins.planners.world import CORRIDOR, LIMITS, Outcome, World, crowd

Array = NDArray[np.float64]


def standing(*where: tuple[float, float]) -> list[list[float]]:
    return [[x, y, 0.0, 0.0] for x, y in where]


def run(people: ArrayLike = (), walls: Array = CORRIDOR, seed: int = 0) -> Outcome:
    return World(people, walls=walls, seed=seed).run(build(DwaSpec()))


def longest_stand(out: Outcome) -> float:
    """Longest time within 0.1 m of one place, s."""
    path = np.array([p[:2] for p in out.path[::16]])
    longest = anchor = 0
    for k in range(len(path)):
        if math.dist(path[k], path[anchor]) > 0.1:
            anchor = k
        longest = max(longest, k - anchor)
    return longest / 8.0


def test_component() -> None:
    assert load_build(DWA) is build
    assert DwaSpec.needs == ("lidar",)


@pytest.mark.slow
def test_alone_it_drives_dead_straight() -> None:
    out = run()
    assert out.arrived
    assert max(abs(p.y) for p in out.path) == 0.0
    assert max(abs(c.w) for c in out.commands) == 0.0
    assert out.t < 66.5


@pytest.mark.parametrize("yaw", [1.0, -2.0, math.pi])
def test_starts_in_any_direction(yaw: float) -> None:
    out = World(start=Pose(2.5, 0.0, yaw)).run(build(DwaSpec()), stop_at=15.0)
    assert out.arrived
    assert out.t < 26.0
    assert min(p.x for p in out.path) > 2.0


STATIC = {
    "one": standing((20, 0)),
    "one aside": standing((20, 0.3)),
    "row": standing(*((20, y) for y in np.linspace(-1.2, 1.2, 5))),
    "gate": standing(*((20, y) for y in np.arange(-4.6, 4.7, 0.66) if abs(y - 1.3) > 0.75)),
    "slalom": standing(*((8 + 4 * k, 0.5 * (-1) ** k) for k in range(9))),
    "cup": standing(
        *((20, y) for y in np.linspace(-1.5, 1.5, 6)),
        *((x, y) for x in (19.4, 18.8) for y in (-1.5, 1.5)),
    ),
}


@pytest.mark.slow
@pytest.mark.parametrize("people", STATIC.values(), ids=STATIC)
def test_static_obstacles_without_any_contact(people: list[list[float]]) -> None:
    out = run(people)
    assert out.arrived
    assert out.least_gap > 0.03
    assert out.least_wall_gap > 0.03
    assert out.t < 95.0


@pytest.mark.slow
@pytest.mark.parametrize("count", [50, 100])
@pytest.mark.parametrize("seed", [0, 1, 2])
def test_standing_crowd(seed: int, count: int) -> None:
    """0.125 and 0.25 p/m^2 of the crowd zone."""
    out = run(crowd(seed, count, (0.0, 0.0), (1,)), seed=seed)
    assert out.arrived
    assert not out.contacts
    assert out.least_wall_gap > 0.03
    assert out.t < 130.0  # seed 1 with 100 people has a dead end in its middle


@pytest.mark.slow
def test_a_door_in_a_wall() -> None:
    door = np.array([[20.0, -5.0, 20.0, 1.0], [20.0, 1.9, 20.0, 5.0]])
    out = run(walls=np.vstack([CORRIDOR, door]))
    assert out.arrived
    assert out.least_wall_gap > 0.05


@pytest.mark.slow
def test_gets_out_of_the_way_of_somebody_who_does_not() -> None:
    out = run([[20.0, 0.0, -1.4, 0.0]])
    assert out.arrived
    assert not out.contacts


@pytest.mark.slow
def test_lets_somebody_cross() -> None:
    for start in np.linspace(-9.0, -3.0, 7):
        world = World([[10.0, start, 0.0, 0.6]], walls=np.empty((0, 4)))
        out = world.run(build(DwaSpec()), stop_at=15.0)
        assert out.arrived
        assert not out.contacts


@pytest.mark.slow
@pytest.mark.parametrize("seed", [0, 1, 2])
def test_through_fifty_who_avoid_nobody(seed: int) -> None:
    """Both flows, 0.8 to 1.6 m/s; a robot of 0.65 m/s cannot evade all of them."""
    people = crowd(seed, 50, (0.8, 1.6), (1, -1))
    out = run(people, seed=seed)
    assert out.arrived
    assert out.t < 100.0
    assert len(out.contacts) <= 9
    assert longest_stand(out) < 8.0
    assert out.least_wall_gap > 0.0


@pytest.mark.slow
def test_fewer_contacts_than_blind_driving() -> None:
    contacts = {"dwa": 0, "blind": 0}
    for seed in range(4):
        people = crowd(seed, 50, (0.8, 1.6), (1, -1))
        contacts["dwa"] += len(run(people, seed=seed).contacts)
        blind = World(people, seed=seed).run(build_goal_seek(GoalSeekSpec()))
        contacts["blind"] += len(blind.contacts)
    assert contacts["dwa"] < 0.7 * contacts["blind"]


@pytest.mark.slow
def test_a_dense_crowd_does_not_freeze_it() -> None:
    out = run(crowd(7, 100, (0.8, 1.6), (1, -1)), seed=7)
    assert out.arrived
    assert longest_stand(out) < 10.0


def share_away(out: Outcome) -> float:
    """Share of the time in which it moves away from the goal at more than 0.05 m/s."""
    speed = np.diff([p.x for p in out.path[::16]]) * 8.0
    return float(np.mean(speed < -0.05))


@pytest.mark.slow
@pytest.mark.parametrize("seed", [0, 1, 2])
def test_it_does_not_flee_from_those_who_come_towards_it(seed: int) -> None:
    """0.3 p/m^2 who avoid nobody, all of them against it."""
    out = run(crowd(seed, 120, (0.8, 1.4), (-1,)), seed=seed)
    assert share_away(out) < 0.05
    assert out.arrived


def test_boxed_in_it_stands_and_touches_nobody() -> None:
    ring = [(5 + 0.75 * math.cos(a), 0.75 * math.sin(a)) for a in np.arange(8) * math.pi / 4]
    world = World(standing(*ring), start=Pose(5.0, 0.0, 0.0))
    out = world.run(build(DwaSpec()), time_limit=20.0)
    assert not out.contacts
    assert math.dist(world.pose[:2], (5.0, 0.0)) < 0.3


@pytest.mark.slow
def test_touched_it_moves_away() -> None:
    """Somebody stands against its front: it backs out or turns away, and arrives."""
    out = run(standing((2.5 + 0.178 + 0.33 + 0.01, 0.0)))
    assert out.arrived
    assert not out.contacts


def test_same_run_twice() -> None:
    people = crowd(3, 50, (0.8, 1.6), (1, -1))
    first = World(people, seed=3).run(build(DwaSpec()), time_limit=20.0)
    planner = build(DwaSpec())
    World(people, seed=4).run(planner, time_limit=5.0)  # reset forgets all of it
    again = World(people, seed=3).run(planner, time_limit=20.0)
    assert first.commands == again.commands


@pytest.mark.slow
def test_commands_keep_to_the_limits() -> None:
    out = run(crowd(5, 100, (0.8, 1.6), (1, -1)), seed=5)
    assert all(-0.2 <= c.v <= LIMITS.v_max and abs(c.w) <= LIMITS.w_max for c in out.commands)


def test_stops_at_the_goal() -> None:
    world = World(goal=(8.0, 1.0))
    world.run(build(DwaSpec()), time_limit=25.0)
    assert math.dist(world.pose[:2], (8.0, 1.0)) < 0.15
    assert world.twist == (0.0, 0.0)
