"""Runs as a whole: the log's grid, arrival, and that pieces add up to the whole, bit by bit."""

from __future__ import annotations

import math

import numpy as np
import pytest

from crowdbot.core.crowd import state as s
from crowdbot.core.environments.build import build_environment
from crowdbot.core.robots.task import robot_task
from crowdbot.core.runs.outcome import Progress
from crowdbot.core.sim.runner import run
from crowdbot.dsl.scenario.scenario import Scenario
from crowdbot.plugin import Task
from tests.core.sim.sim_worlds import Drive, Rig, alone, constant, person, rig, scenario

TICK = 1.0 / 128.0
ALL = ("front_lidar", "rear_lidar", "odometry")


def _task(world: Scenario) -> Task:
    from tests.core.sim.sim_worlds import registry

    (robot,) = world.robots.values()
    return robot_task(robot, build_environment(registry(), world.environment))


def _whole(world: Scenario, planner: object, **options: object) -> tuple[Rig, object]:
    made = rig(world, planner, sensors=ALL, initialize=False)  # type: ignore[arg-type]
    given: dict[str, object] = {"stage": "run", "progress": None, "stop": lambda: False, **options}
    # `run` makes its own simulator from the diagram.
    outcome = run(made.blocks, **given)  # type: ignore[arg-type]
    return made, outcome


@pytest.mark.slow
def test_the_log_is_on_its_grid() -> None:
    made, outcome = _whole(scenario("robots.robot.task.time_limit=2"), constant(0.3))
    assert [t for t, *_ in made.memory.states] == [n / 16.0 for n in range(33)]
    assert outcome.status == "timeout"  # type: ignore[attr-defined]
    assert outcome.sim_time == 2.0  # type: ignore[attr-defined]
    for _, robot, agents, jump in made.memory.states:
        assert len(robot) == 5
        assert agents.shape == (4, 50)
        assert jump.shape == (50,)
        assert np.all(np.isfinite(robot))
    assert [t for t, _ in made.memory.commands] == [n / 16.0 for n in range(32)]
    assert len(made.memory.trips) >= 50
    assert made.memory.flushes >= 2


@pytest.mark.slow
@pytest.mark.parametrize("rate", [1.0, 64.0, 128.0])
def test_other_log_rates(rate: float) -> None:
    made, _ = _whole(alone("robots.robot.task.time_limit=1", f"rates.log={rate}"), constant(0.3))
    assert [t for t, *_ in made.memory.states] == [n / rate for n in range(int(rate) + 1)]


@pytest.mark.slow
def test_arrival_is_interpolated() -> None:
    """At 0.65 m/s into the zone at x = 45 m; the run ends on the next tick."""
    world = alone("robots.robot.task.start=[43.9, 0.5, 0]")
    made, outcome = _whole(world, constant(0.65))
    dense = dict(rig(world, constant(0.65)).track(2.5, TICK))
    times = np.array(list(dense))
    x = np.array([r.x for r in dense.values()])
    after = int(np.argmax(x > 45.0))
    expected = np.interp(45.0, x[after - 1 : after + 1], times[after - 1 : after + 1])
    assert outcome.status == "arrived"  # type: ignore[attr-defined]
    assert outcome.goal_time == pytest.approx(expected, abs=1e-9)  # type: ignore[attr-defined]
    assert outcome.sim_time == times[after]  # type: ignore[attr-defined]
    assert outcome.goal_time % TICK > 1e-6  # type: ignore[attr-defined]
    assert made.memory.states[-1][0] <= times[after]


def test_a_start_inside_the_goal_arrives_at_once() -> None:
    """The language refuses such a scenario; Python can build it."""
    world = alone()
    (robot,) = world.robots.values()
    task = robot.task.model_copy(update={"start": (46.0, 0.0, 0.0)})
    inside = {"robot": robot.model_copy(update={"task": task})}
    _, outcome = _whole(world.model_copy(update={"robots": inside}), constant(0.0))
    assert (outcome.status, outcome.goal_time) == ("arrived", 0.0)  # type: ignore[attr-defined]


@pytest.mark.slow
@pytest.mark.parametrize("limit", ["0.001", "0.33", "0.0625"])
def test_any_time_limit(limit: str) -> None:
    """The run ends on the first tick at or after it."""
    _, outcome = _whole(alone(f"robots.robot.task.time_limit={limit}"), constant(0.1))
    assert outcome.status == "timeout"  # type: ignore[attr-defined]
    assert outcome.sim_time == math.ceil(float(limit) * 128) / 128  # type: ignore[attr-defined]


@pytest.mark.slow
def test_one_advance_equals_many() -> None:
    """Bit by bit, state and log; with people, noise and contacts."""
    id_ = "counter-d0500-fast-c50-r10"
    worlds = [
        rig(scenario(id_=id_), Drive(lambda t: (0.5, 0.5 * math.sin(t))), sensors=ALL)
        for _ in range(3)
    ]
    worlds[0].advance(3.0)
    for k in range(1, 31):
        worlds[1].advance(0.1 * k if k < 30 else 3.0)
    for k in range(1, 3 * 128 + 1):
        worlds[2].advance(k * TICK)
    first, *others = worlds
    for other in others:
        assert other.everything() == first.everything()
        assert len(other.memory.states) == len(first.memory.states)
        for a, b in zip(other.memory.states, first.memory.states, strict=True):
            assert a[:2] == b[:2]
            assert a[2].tobytes() == b[2].tobytes()
        for name in ALL:
            for x, y in zip(other.memory.readings[name], first.memory.readings[name], strict=True):
                assert (x.stamp, x.values.tobytes()) == (y.stamp, y.values.tobytes())


@pytest.mark.slow
def test_trips_and_jumps_of_one_person() -> None:
    """Out at x = 0 after 2 m at 1 m/s, back in at once: one trip done, one begun."""
    made = rig(scenario("robots.robot.task.start=[25, 3, 0]"), constant(0.0), person(2.0, 0.0, 1.0))
    made.advance(3.0)
    made.log.finish(3.0, made.crowd())
    (first, second) = made.memory.trips
    assert first == (0, 0.0, pytest.approx(2.0, abs=1e-6), True)
    assert second == (0, pytest.approx(2.0, abs=2 * TICK), 3.0, False)
    jumps = [t for t, _, _, jump in made.memory.states if jump[0]]
    assert len(jumps) == 1
    assert 2.0 <= jumps[0] <= 2.0 + 1.0 / 16.0 + TICK
    positions = {t: agents[0, 0] for t, _, agents, _ in made.memory.states}
    assert positions[1.0] == pytest.approx(1.0, abs=1e-6)
    assert positions[2.5] > 49.0


@pytest.mark.slow
def test_waiting_people_are_logged_as_absent() -> None:
    """A robot in the only place where one may enter keeps a person outside."""
    engine = person(2.0, 0.0, 1.0)
    engine.world.entrance[:] = (20.0, 21.0, -0.4, 0.4)
    made = rig(scenario("robots.robot.task.start=[20.5, 0, 0]"), constant(0.0), engine)
    made.advance(3.0)
    made.log.finish(3.0, made.crowd())
    absent = [t for t, _, agents, _ in made.memory.states if np.all(np.isnan(agents[:, 0]))]
    assert absent[0] == pytest.approx(2.0, abs=1.0 / 16.0 + TICK)
    assert absent[-1] == made.memory.states[-1][0]
    assert made.memory.trips == [(0, 0.0, pytest.approx(2.0, abs=1e-6), True)]
    assert made.crowd()[s.TRIPS] == 1.0


def test_progress_and_stop() -> None:
    heard: list[Progress] = []
    world = scenario("robots.robot.task.time_limit=20")
    _, outcome = _whole(
        world, constant(0.65), progress=heard.append, stop=lambda: len(heard) >= 8
    )  # fmt: skip
    assert outcome.status == "interrupted"  # type: ignore[attr-defined]
    assert outcome.sim_time == pytest.approx(1.0)  # type: ignore[attr-defined]
    assert [p.t for p in heard] == pytest.approx([0.125 * k for k in range(1, 9)])
    assert heard[0].distance == pytest.approx(42.5, abs=0.05)
    assert heard[-1].distance < heard[0].distance  # type: ignore[operator]
    assert {p.limit for p in heard} == {20.0}


def test_the_planners_state_follows_commands() -> None:
    """What is logged is what the planner said, not what the slew made of it."""
    made, _ = _whole(alone("robots.robot.task.time_limit=0.5"), Drive(lambda t: (0.6, -0.2 * t)))
    assert [c.v for _, c in made.memory.commands] == [0.6] * 8
    assert [c.w for _, c in made.memory.commands] == pytest.approx(
        [-0.2 * n / 16 for n in range(8)]
    )
