"""Each robot, against closed forms: speed, odometry, slip, walls, tilt, a push."""

from __future__ import annotations

import itertools
import math
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
import pytest

from crowdbot.core.crowd import state as s
from crowdbot.core.geometry.footprint import footprint_of_model
from crowdbot.core.robots.build import build_model
from crowdbot.core.scenarios.library import open_spec, pick
from crowdbot.core.sim.build_crowd import in_series
from crowdbot.core.support.ticks import TICK
from crowdbot.dsl.scenario.scenario import Scenario
from crowdbot.plugin import Command, HolonomicDrive, Observation
from tests.core.sim.sim_worlds import Drive, constant, person, registry, rig, rows

pytestmark = pytest.mark.slow

ROBOTS = ("turtlebot2", "pepper", "qolo", "cuybot", "smart_wheelchair")
SIDEWAYS = ("pepper", "cuybot")


def world_of(kind: str, *overrides: str) -> Scenario:
    """The challenge's empty corridor with one of the robots and its own sensors."""
    document = f"""crowdbot: 1
scenario:
  id: alone
  extends: ["builtin:parts/corridor_50x10.yaml", "builtin:parts/{kind}.yaml"]
  robots.robot.task: {{start: [2.5, 0, 0], goal: {{zone: robot_goal}}, time_limit: 60 s}}
"""
    with TemporaryDirectory() as folder:
        file = Path(folder) / f"{kind}.yaml"
        file.write_text(document, encoding="utf-8")
        return pick(open_spec(str(file), registry(), overrides), "alone")


@cache
def model_of(kind: str) -> Any:
    return build_model(registry(), world_of(kind).robots["robot"].model)


@pytest.mark.parametrize("kind", ROBOTS)
def test_a_step_of_speed_is_a_ramp_and_stays_level(kind: str) -> None:
    """v(t) = a t up to v; full speed, full brake; never tips."""
    limits = model_of(kind).limits
    v, a = limits.v_max, limits.a_max
    stop, late = v / a + 1.0, 1.0 / 16.0 + 2.0 * TICK  # one step of the planner
    world = rig(
        world_of(kind, "robots.robot.task.start=[10, 0, 0]"),
        Drive(lambda t: (v, 0.0) if t < stop else (0.0, 0.0)),
    )
    track = world.track(stop + v / a + 0.5, 1.0 / 32.0)
    for t, r in track:
        due = min(v, a * t) if t <= stop else max(0.0, v - a * (t - stop))
        assert r.vx == pytest.approx(due, abs=0.03 * v + a * late), f"at {t} s"
        assert r.tilt < math.radians(1.5)
        assert abs(r.y) < 0.01
    assert max(r.vx for _, r in track) == pytest.approx(v, rel=0.02)


@pytest.mark.parametrize("kind", ROBOTS)
def test_odometry_follows_an_arc(kind: str) -> None:
    """Half speed on a circle for 6 s: odometry ends where the robot does, within 1 % of the way."""
    limits = model_of(kind).limits
    world = rig(
        world_of(kind, "robots.robot.task.start=[25, 0, 0]"),
        constant(0.5 * limits.v_max, 0.3 * limits.w_max),
    )
    world.advance(6.0)
    x, y, yaw, *_ = world.memory.readings["odometry"][-1].values
    now = world.track(6.0 + TICK, TICK)[-1][1]
    way = 3.0 * limits.v_max
    assert math.hypot(x - now.x, y - now.y) < 0.02 * way
    assert abs(math.remainder(yaw - now.yaw, math.tau)) < 0.05


@pytest.mark.parametrize("kind", ROBOTS)
def test_a_wall_stops_it_where_its_outline_is(kind: str) -> None:
    model = model_of(kind)
    body = footprint_of_model(model)
    front = body.radius + float(np.max(body.corners[:, 0], initial=0.0))
    world = rig(
        world_of(
            kind, "robots.robot.task.start=[48, 0, 0]", "robots.robot.task.goal.zone=robot_spawn"
        ),
        constant(0.4),
    )
    track = [r for _, r in world.track(6.0)]
    assert max(r.x for r in track) + front < 50.01
    assert track[-1].x + front == pytest.approx(50.0, abs=0.01)
    assert max(r.tilt for r in track) < math.radians(3.0)


FRICTION = 0.02
#: Share of the weight on what drives: a third of it on two of six wheels that are as stiff, all of
#: it where a force takes the place of wheels.
CARRIED = {"turtlebot2": (0.4, 0.7), "qolo": (0.4, 1.0), "smart_wheelchair": (0.3, 0.4)}


@pytest.mark.parametrize("kind", ROBOTS)
def test_on_a_slippery_floor_it_gains_what_friction_gives(kind: str) -> None:
    """v = mu g t times the share of the weight that the driven wheels carry, and no more."""
    world = rig(
        world_of(
            kind, "robots.robot.task.start=[25, 0, 0]", f"environment.floor.friction={FRICTION}"
        ),
        constant(0.5),
    )
    track = [(t, r) for t, r in world.track(1.5, 1.0 / 16.0) if t > 0.5]
    least, most = CARRIED.get(kind, (0.95, 1.0))
    for (t0, before), (t1, after) in itertools.pairwise(track):
        gained = (after.vx - before.vx) / ((t1 - t0) * FRICTION * 9.81)
        assert least - 0.02 < gained < most + 0.02, f"at {t1} s"
    assert track[-1][1].vx < FRICTION * 9.81 * 1.5 + 1e-6 < 0.5
    assert max(r.tilt for _, r in track) < math.radians(1.0)
    if kind not in SIDEWAYS:  # its wheels spin, and odometry believes them
        counted = world.memory.readings["odometry"][-1].values[0] - 25.0
        assert counted > track[-1][1].x - 25.0 + 0.2


class Sideways(Drive):
    """Tells the robot to go to its left."""

    def step(self, obs: Observation) -> Command:
        return Command(*super().step(obs)[:2], 0.3)


@pytest.mark.parametrize("kind", SIDEWAYS)
def test_it_goes_sideways(kind: str) -> None:
    world = rig(world_of(kind, "robots.robot.task.start=[25, -3, 0]"), Sideways(lambda _: (0, 0)))
    last = world.track(4.0)[-1][1]
    a = model_of(kind).limits.a_max
    assert last.y + 3.0 == pytest.approx(0.3 * 4.0 - 0.5 * 0.3**2 / a, abs=0.02)
    assert abs(last.x - 25.0) < 0.005


def _pushed(mass: float, brake: float, stiffness: float) -> tuple[float, float]:
    """Impulse (N s) and way (m) of a robot at rest that 75 kg meet at 1 m/s; it brakes."""
    depth, robot, other, impulse, way, dt = 1e-9, 0.0, 1.0, 0.0, 0.0, 1e-5
    while depth > 0.0 or robot > 0.0:
        rate = other - robot
        force = max(0.0, stiffness * depth * (1.0 + 0.3 * rate)) if depth > 0.0 else 0.0
        robot = max(0.0, robot + (force - brake) / mass * dt)
        other -= force / 75.0 * dt
        depth, impulse, way = depth + rate * dt, impulse + force * dt, way + robot * dt
    return impulse, way


def test_a_push_moves_a_cuybot_as_its_equation_says() -> None:
    """A person of 75 kg who walks into it at 1 m/s; its drive brakes with what it has."""
    model = model_of("cuybot")
    assert isinstance(model.drive, HolonomicDrive)
    stiffness = in_series(30000.0, model.skin_stiffness)
    assert stiffness == pytest.approx(7500.0)
    engine = person(12.0, speed=1.0)
    world = rig(world_of("cuybot", "robots.robot.task.start=[11, 0, 0]"), constant(0.0), engine,
                sensors=("skin", "odometry"))  # fmt: skip
    world.advance(0.25)
    start = world.robot().x
    world.advance(0.25 + 1.5)
    impulse, way = _pushed(model.mass, model.drive.max_force, stiffness)
    sums, (touch,) = s.contact_with(world.crowd())
    assert -sums[s.ROBOT_JX] == pytest.approx(impulse, rel=0.01)
    assert start - world.robot().x == pytest.approx(way, rel=0.02)
    assert touch[s.TOUCHES] == 1.0
    felt = np.array([r.values for r in world.memory.readings["skin"]])
    assert -felt[:, 0].sum() * TICK == pytest.approx(impulse, rel=0.03)
    assert np.all(np.abs(felt[:, 1:]) < 1e-6)


@pytest.mark.parametrize(("yaw", "side"), [(0.0, 0.0), (180.0, math.pi)], ids=["front", "rear"])
def test_pushed_from_ahead_or_behind_a_cuybot_takes_what_the_person_loses(
    yaw: float, side: float
) -> None:
    """75 kg at 1 m/s, in steps of 1/256 s: impulse within 1 % of the equation's; nothing is lost.

    The equation is solved in steps of 10 us, which are right to 1e-4.
    """
    model = model_of("cuybot")
    assert isinstance(model.drive, HolonomicDrive)
    stiffness = in_series(30000.0, model.skin_stiffness)
    engine = person(12.0, speed=1.0)
    world = rig(world_of("cuybot", f"robots.robot.task.start=[11 m, 0 m, {yaw} deg]"),
                constant(0.0), engine, tick=1.0 / 256.0)  # fmt: skip
    world.advance(0.25)
    start, before = world.robot().x, rows(world.crowd())[0, s.VX]
    world.advance(1.75)
    impulse, way = _pushed(model.mass, model.drive.max_force, stiffness)
    (walker,), (sums, (touch,)) = rows(world.crowd()), s.contact_with(world.crowd())
    assert -sums[s.ROBOT_JX] == pytest.approx(impulse, rel=0.01)
    assert sums[s.ROBOT_JX] + sums[s.PEOPLE_JX] == pytest.approx(0.0, abs=1e-9)
    assert 75.0 * (walker[s.VX] - before) == pytest.approx(sums[s.PEOPLE_JX], abs=1e-9)
    assert start - world.robot().x == pytest.approx(way, rel=0.01)
    assert abs(touch[s.TOUCH_SIDE]) == pytest.approx(side, abs=1e-3)
    assert touch[s.TOUCHES] == 1.0
