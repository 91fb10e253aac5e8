"""Robot against people: impulses balance, and are the right ones."""

from __future__ import annotations

import math

import numpy as np
import pytest

from crowdbot.core.crowd import state as s
from crowdbot.core.population.realise import realise
from crowdbot.plugins.planners.goal_seek import GoalSeekSpec
from crowdbot.plugins.planners.goal_seek_build import build as build_goal_seek
from tests.core.sim.sim_worlds import constant, person, rig, rows, scenario

pytestmark = pytest.mark.slow

TICK = 1.0 / 128.0
ROBOT, PERSON = 6.3, 75.0
START = "robots.robot.task.start=[10, 0, 0]"


def _point_masses(closing: float, drive: float) -> float:
    """Impulse (N s) of one head-on contact; ``drive`` is a constant push on the robot, N."""
    depth, vr, vp, impulse, dt = 1e-9, closing, 0.0, 0.0, 1e-5
    while depth > 0.0:
        rate = vr - vp
        force = max(0.0, 30000.0 * depth * (1.0 + 0.3 * rate))
        vr += (drive - force) / ROBOT * dt
        vp += force / PERSON * dt
        depth += (vr - vp) * dt
        impulse += force * dt
    return impulse


def test_head_on_impulses_balance() -> None:
    """0.65 m/s against 1.2 m/s. What the plant is given is what the person loses."""
    world = rig(scenario(START), constant(0.65), person(12.5))
    crowd = world.blocks.crowd
    assert crowd is not None
    on_robot = np.zeros(2)
    start = world.plant.plant.GetBodyByName("base_link").floating_velocities_start_in_v()
    before = rows(world.crowd())[0, s.VX : s.VY + 1].copy()
    for tick in range(1, 3 * 128):
        world.advance(tick * TICK)
        force = crowd.force_on(0).Eval(crowd.GetMyContextFromRoot(world.context))
        on_robot += force[start + 3 : start + 5] * TICK
    (walker,), (felt, _) = rows(world.crowd()), s.contact_with(world.crowd())
    on_person = PERSON * (walker[s.VX : s.VY + 1] - before)
    assert on_robot[0] < -10.0
    assert on_robot == pytest.approx(-on_person, abs=1e-9)
    assert felt[s.ROBOT_JX] + felt[s.PEOPLE_JX] == pytest.approx(0.0, abs=1e-9)
    assert felt[s.ROBOT_JX : s.ROBOT_JY + 1] == pytest.approx(on_robot, abs=1e-9)


def test_the_first_impulse_is_that_of_point_masses() -> None:
    """The wheels push with at most 1 N m each, which the point masses feel as well."""
    world = rig(scenario(START), constant(0.65), person(12.5))
    speed, largest, impulse = 0.0, 0.0, 0.0
    while s.contact_with(world.crowd())[1][0, s.TOUCHING] == 0.0:
        speed = world.robot().vx
        world.advance(world.context.get_time() + TICK)
    while True:
        felt, _ = s.contact_with(world.crowd())
        force = math.hypot(felt[s.ROBOT_FX], felt[s.ROBOT_FY])
        if impulse > 0.0 and force == 0.0:
            break
        largest, impulse = max(largest, force), impulse + force * TICK
        world.advance(world.context.get_time() + TICK)
    bounds = [_point_masses(0.65 + 1.2, drive) for drive in (0.0, 2.0 / 0.0352)]
    print(f"impulse {impulse:.2f} N s, point masses {bounds}, peak {largest:.0f} N")
    assert speed == pytest.approx(0.65, rel=0.02)
    assert 0.97 * bounds[0] <= impulse <= 1.03 * bounds[1]
    assert largest == pytest.approx(731.0, rel=0.15)  # few ticks on the peak
    changed = ROBOT * (world.robot().vx - 0.65)
    assert -impulse <= changed <= -0.8 * impulse  # the rest went into wheels and floor


def test_a_blind_robot_hits_a_standing_person() -> None:
    world = rig(
        scenario("robots.robot.task.start=[2.5, 0, 0]"),
        build_goal_seek(GoalSeekSpec()), person(5.0, speed=1e-9),
    )  # fmt: skip
    world.advance(6.0)
    world.log.finish(6.0, world.crowd())
    assert world.log.contacts >= 1
    first = world.memory.contacts[0]
    assert first["relative_speed"] == pytest.approx(0.65, rel=0.02)
    assert first["impulse"] > 1.0
    assert first["t0"] == pytest.approx((5.0 - 2.5 - 0.33 - 0.178) / 0.65 + 0.5 * 0.65, abs=0.1)


def _free_place(world: object) -> tuple[float, float]:
    """Where in the middle of the corridor nobody stands at the start."""
    drawn = realise(world)  # type: ignore[arg-type]
    grid = [(x, y) for x in np.arange(20.0, 30.0, 0.5) for y in np.arange(-3.0, 3.1, 0.5)]

    def room(p: tuple[float, float]) -> float:
        return float(np.min(np.hypot(drawn.x - p[0], drawn.y - p[1])))

    return max(grid, key=room)


def test_a_parked_robot_is_not_touched() -> None:
    """A standing robot in the middle of the 0.25 p/m^2 counter-flow."""
    id_ = "counter-d0250-dispersed-c20-r05"
    x, y = _free_place(scenario(id_=id_))
    world = rig(scenario(f"robots.robot.task.start=[{x}, {y}, 0]", id_=id_), constant(0.0))
    passed = np.zeros(100, np.bool_)
    for second in range(1, 25):
        world.advance(float(second))
        people = rows(world.crowd())
        near = np.hypot(people[:, s.X] - x, people[:, s.Y] - y) < 1.5
        passed = passed | near
    felt, touches = s.contact_with(world.crowd())
    assert np.sum(passed) >= 3  # people do come by
    assert felt[s.CONTACTS] == 0.0
    assert not np.any(touches[:, s.TOUCHING])
    robot = world.robot()
    assert math.hypot(robot.x - x, robot.y - y) < 1e-3


@pytest.mark.parametrize(
    ("y", "walker", "trips", "contacts"), [(0.35, 11.5, 0, 1), (3.0, 1.0, 1, 0)]
)
def test_what_ends_is_recorded_at_its_tick(
    y: float, walker: float, trips: int, contacts: int
) -> None:
    """A person brushes past a robot that stands; another one arrives."""
    world = rig(scenario(f"robots.robot.task.start=[10, {y}, 0]"), constant(0.0), person(walker))
    for tick in range(1, 3 * 128):
        world.advance(tick * TICK)
        flat = world.crowd()
        felt, _ = s.contact_with(flat)
        assert (world.log.trips, world.log.contacts) == (flat[s.TRIPS], felt[s.CONTACTS])
    assert (len(world.memory.trips), len(world.memory.contacts)) == (trips, contacts)
