"""Planners of the field: each arrives, stops for a person, drives any robot, on every rung."""

from __future__ import annotations

import importlib
import importlib.util
import math
from typing import Any

import numpy as np
import pytest

from crowdbot.core.registry.build_reference import load_build
from crowdbot.core.registry.registry import discover
from crowdbot.plugin import Command, NoValidCommand, Observation, Pose, RobotBody, RobotLimits
from crowdbot.plugins.planners.shared.rungs import RungSpec
from crowdbot.testing.drive import COURSES, Driven, sensors_for
from tests.plugins.planners.world import LIMITS, PERSON, RADIUS, World

#: Kinds that need a library which is an extra, and where it is.
EXTRAS = {"mpc": "casadi", "navground": "navground"}
KINDS: list[Any] = ["people_mpc", "crowd_prediction", "crowd_model", "mppi", "orca", "social_force"]
KINDS += ["vfh_plus", "follow_the_gap", "rpp", "social_momentum"]
KINDS += [
    pytest.param(
        kind,
        marks=pytest.mark.skipif(
            importlib.util.find_spec(needs) is None, reason=f"the library {needs} is not installed"
        ),
    )
    for kind, needs in EXTRAS.items()
]
SEEING = {"tracks": "tracker", "localisation": "corrected"}
FAST: dict[str, dict[str, Any]] = {"mppi": {"samples": 300}, "crowd_model": SEEING}


def made(kind: str, **parameters: Any) -> Any:
    module = importlib.import_module(f"crowdbot.plugins.planners.{kind}.{kind}")
    component = getattr(module, kind.upper())
    spec = component.spec(**{**FAST.get(kind, {}), **parameters})
    return Halting(load_build(component)(spec))


class Halting:
    """A planner whose robot stops without a valid command, as the host has it."""

    def __init__(self, planner: Any) -> None:
        self.planner, self.reset = planner, planner.reset

    def step(self, obs: Observation) -> Command:
        try:
            command: Command = self.planner.step(obs)
        except NoValidCommand:
            return Command(0.0, 0.0)
        return command


@pytest.mark.parametrize("kind", KINDS)
def test_it_drives_straight_to_a_free_goal(kind: str) -> None:
    world = World(goal=(7.0, 0.0))
    out = world.run(made(kind), time_limit=14.0, stop_at=6.5)
    assert out.arrived
    assert out.t < 9.0
    assert max(abs(p.y) for p in out.path) < 0.3


@pytest.mark.parametrize("kind", KINDS)
def test_it_does_not_touch_who_stands_in_its_way(kind: str) -> None:
    world = World([[5.0, 0.05, 0.0, 0.0]], goal=(9.0, 0.0))
    out = world.run(made(kind, person_radius=PERSON), time_limit=12.0, stop_at=8.0)
    assert out.contacts == []
    assert world.pose.x > 3.0


@pytest.mark.parametrize("kind", ["people_mpc", "mppi", "orca"])
def test_it_lets_a_person_pass_who_crosses(kind: str) -> None:
    world = World([[5.5, -3.6, 0.0, 0.8]], goal=(9.0, 0.0))
    out = world.run(made(kind, person_radius=PERSON), time_limit=20.0, stop_at=8.0)
    assert out.arrived
    assert out.contacts == []


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("rung", ["tracks", "localisation"])
def test_the_last_rung_is_privileged_and_the_others_are_not(kind: str, rung: str) -> None:
    module = importlib.import_module(f"crowdbot.plugins.planners.{kind}.{kind}")
    component = getattr(module, kind.upper())
    assert issubclass(component.spec, RungSpec)
    seeing = FAST.get(kind, {})
    assert component.spec(**{**seeing, rung: "truth"}).privileged is True
    assert component.spec(**seeing).privileged is False
    lower = {"tracks": "lidar", "localisation": "odometry"}[rung]
    assert component.spec(**{**seeing, rung: lower}).privileged is False


@pytest.mark.parametrize(
    "rungs", [("lidar", "odometry"), ("truth", "truth"), ("truth", "odometry")]
)
@pytest.mark.parametrize("kind", ["people_mpc", "orca"])
def test_it_drives_on_every_rung(kind: str, rungs: tuple[str, str]) -> None:
    planner = made(kind, tracks=rungs[0], localisation=rungs[1])
    privileged = "truth" in rungs
    driven = Driven(
        planner, kind, COURSES["people in a room"], sensors_for(("lidar",), discover()),
        privileged=privileged,
    )  # fmt: skip
    assert any(c.v > 0.2 for c in driven.run(40))


WHEELCHAIR = np.array([[0.6, 0.35], [-0.5, 0.35], [-0.5, -0.35], [0.6, -0.35]])
SEGMENT = np.array([[-0.2, 0.0], [0.3, 0.0]])
BODIES = {
    "outline": (RobotBody(drive="differential", radius=0.7, footprint=WHEELCHAIR, front=0.6,
                          back=0.5, half_width=0.35), 0.0),
    "capsule": (RobotBody(drive="differential", radius=0.25, footprint=SEGMENT,
                          front=0.55, back=0.45, half_width=0.25), 0.0),
    "holonomic": (RobotBody(drive="holonomic", radius=0.3, footprint=None, front=0.3, back=0.3,
                            half_width=0.3), 0.5),
}  # fmt: skip


@pytest.mark.parametrize("body", BODIES)
@pytest.mark.parametrize("kind", KINDS)
def test_it_drives_every_kind_of_robot(kind: str, body: str) -> None:
    """It goes towards a free goal within the limits, sideways only if the robot can."""
    shape, vy_max = BODIES[body]
    limits = RobotLimits(v_min=-0.2, v_max=0.6, w_max=1.5, a_max=0.8, alpha_max=1.5, vy_max=vy_max)
    world = World(goal=(9.0, 2.0))
    task = type(world.task)(
        start=world.task.start, goal=(9.0, 2.0), goal_zone=world.task.goal_zone,
        time_limit=60.0, robot=shape,
    )  # fmt: skip
    planner = made(kind)
    planner.reset(task, limits, {n: s.info() for n, s in world.sensors.items()}, 0)
    x, y, yaw, twist = 2.5, 0.0, 0.0, (0.0, 0.0, 0.0)
    for k in range(48):
        world.pose, world.tick = Pose(x, y, yaw), 8 * k
        obs = world._observe()
        seen = Observation(
            t=k / 16.0, pose=world.pose, twist=twist[:2], vy=twist[2], goal=(9.0, 2.0),
            goal_zone=obs.goal_zone, readings=obs.readings,
        )  # fmt: skip
        v, w, vy = twist = tuple(planner.step(seen))
        assert limits.v_min <= v <= limits.v_max + 1e-9
        assert abs(w) <= limits.w_max + 1e-9
        assert abs(vy) <= vy_max + 1e-9
        yaw += w / 16.0
        x += (v * math.cos(yaw) - vy * math.sin(yaw)) / 16.0
        y += (v * math.sin(yaw) + vy * math.cos(yaw)) / 16.0
    assert math.hypot(9.0 - x, 2.0 - y) < math.hypot(6.5, 2.0) - 0.6


def test_the_robot_radius_of_this_world_is_what_the_planners_assume() -> None:
    planner = made("people_mpc").planner
    assert planner._robot.tolist() == [[0.0, 0.0, RADIUS]]


def test_mppi_draws_its_noise_from_the_seed() -> None:
    def sixth(seed: int) -> Command:
        world = World([[5.0, 0.3, -0.5, 0.0]], goal=(9.0, 0.0))
        planner = made("mppi")
        planner.reset(world.task, LIMITS, {n: s.info() for n, s in world.sensors.items()}, seed)
        for _ in range(6):  # the first plans are the simple ones, whatever the noise
            command: Command = planner.step(world._observe())
            for _ in range(8):
                world._advance(command)
        return command

    assert sixth(3) == sixth(3)
    assert sixth(3) != sixth(4)


@pytest.mark.parametrize("kind", ["dwa", "stop_and_go", "goal_seek", "wall_hug", *KINDS])
def test_it_draws_what_it_thinks(kind: str) -> None:
    registry = discover()
    component = registry.find("planner", kind)
    planner: Any = load_build(component)(component.spec(**FAST.get(kind, {})))
    driven = Driven(
        planner, kind, COURSES["people in a room"], sensors_for(component.spec.needs, registry)
    )
    driven.run(12)
    last = {d.name: d.rows for d in driven.drawings if d.name != "tracks"}
    assert last
    assert any(np.hypot(*rows[-1, :2]) > 0.05 for rows in last.values() if len(rows))
