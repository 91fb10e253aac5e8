"""A hard push on its side knocks a TurtleBot2 over: when, and what is then said of the run."""

from __future__ import annotations

import math

import numpy as np
import pytest

from crowdbot.core.runs.make_record import ending
from crowdbot.core.runs.outcome import Outcome
from crowdbot.core.runs.record_parts import RobotPart
from crowdbot.core.runs.run_record import RunRecord
from crowdbot.core.sim.loggers.metric_logger import LEANS
from crowdbot.core.sim.runner import run
from crowdbot.core.support.ticks import TICK
from crowdbot.core.types.ending import Ending
from tests.core.sim.sim_worlds import Rig, alone, constant, person, rig, scenario

SIDE, FRONT = 0.5 * math.pi, 0.0
GOAL = 45.0  # where its goal zone begins, m
START = "robots.robot.task.start=[{}, 0, {}]"


def _pushed(start: float, yaw: float, force: float, pushed_ticks: int, until: float) -> Rig:
    """A robot at (start, 0), pushed in x at the height at which people push."""
    world = rig(alone(START.format(start, yaw)), constant(0.0)).advance(0.25)
    plant, layout = world.plant.plant, world.own.base.push
    context = plant.GetMyMutableContextFromRoot(world.context)
    values = np.zeros(layout.size)
    layout.write(values, force, 0.0)
    port = plant.get_applied_generalized_force_input_port()
    port.FixValue(context, values)
    world.advance(0.25 + pushed_ticks * TICK)
    port.FixValue(context, np.zeros(layout.size))
    return world.advance(until)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("yaw", "pushed_ticks", "topples"), [(SIDE, 4, False), (SIDE, 8, True), (FRONT, 8, False)]
)
def test_what_knocks_it_over(yaw: float, pushed_ticks: int, *, topples: bool) -> None:
    """300 N for 31 ms or 62 ms, 9.4 N s or 18.8 N s. Forwards it rolls, on its side it trips."""
    world = _pushed(25.0, yaw, 300.0, pushed_ticks, 1.5)
    robot = world.robot()
    assert (robot.tilt > LEANS) == topples
    assert (world.ending.toppled_time is not None) == topples
    if not topples:
        assert robot.tilt < math.radians(0.1)
        assert math.hypot(robot.vx, robot.vy) < 0.01


@pytest.mark.slow
@pytest.mark.parametrize(("yaw", "arrives"), [(FRONT, True), (SIDE, False)])
def test_what_has_toppled_does_not_arrive(yaw: float, *, arrives: bool) -> None:
    """The same push drives one into the goal zone; the other's run ends before."""
    world = _pushed(43.5, yaw, 600.0, 8, 1.0)
    assert (world.robot().x > GOAL) == arrives
    ending = world.ending
    ended = ending.goal_time if arrives else ending.toppled_time
    assert world.context.get_time() == pytest.approx(ended, abs=TICK)
    assert (ending.goal_time is not None) == arrives
    assert (ending.toppled_time is None) == arrives


@pytest.mark.slow
def test_the_run_ends_and_says_so() -> None:
    """Somebody who takes no notice walks into its side."""
    world = scenario(START.format(20.0, SIDE), "robots.robot.task.time_limit=1")
    made = rig(world, constant(0.0), person(21.0, speed=1.5), initialize=False)
    outcome = run(made.blocks, stage="run", progress=None, stop=lambda: False)
    assert outcome.status == Ending.TOPPLED
    assert outcome.toppled_time == pytest.approx(0.57, abs=0.1)
    assert outcome.sim_time == outcome.toppled_time
    assert outcome.reason == f"toppled at {outcome.toppled_time:.1f} s"
    record = ending(outcome)
    assert (record["status"], record["toppled_time"]) == (Ending.TOPPLED, outcome.toppled_time)


def test_the_record_of_what_stood_does_not_mention_it() -> None:
    stood = Outcome(
        status=Ending.TIMEOUT, reason="", goal_time=None, sim_time=1.0, wall_time=1.0, cpu_time=1.0
    )
    assert "toppled_time" not in ending(stood)
    assert RunRecord.model_fields["toppled_time"].default is None
    assert RobotPart.model_fields["toppled_time"].default is None
