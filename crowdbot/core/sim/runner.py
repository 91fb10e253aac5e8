"""Runner: advances a diagram until all its robots have ended, or the user interrupts."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

from pydrake.systems.analysis import Simulator, SimulatorStatus

from crowdbot.core.geometry.polygon import distance_to
from crowdbot.core.runs.outcome import Outcome, Progress
from crowdbot.core.sim.diagram import Blocks, RobotBlocks
from crowdbot.core.sim.run_outcome import run_outcome
from crowdbot.core.types.ending import Ending
from crowdbot.errors import PlannerError

#: Simulated time between checks of progress and interruption, s.
LOOK = 0.125


def run(
    blocks: Blocks,
    *,
    stage: str,
    progress: Callable[[Progress], None] | None,
    stop: Callable[[], bool],
    on_begin: Callable[[Any], object] = lambda _: None,
) -> Outcome:
    """Simulate one run; everything is in the logs afterwards, whatever happened.

    Args:
        on_begin: is given the context of the diagram.

    Raises:
        PlannerHungError: a planner step never returned; what came before is in the logs.
    """
    simulator: Any = Simulator(blocks.diagram)
    context = simulator.get_mutable_context()
    for robot in blocks.robots:
        robot.base.place(context, robot.given.built.task.start)
    on_begin(context)
    begin, cpu = time.perf_counter(), time.process_time()
    try:
        ended = _has_ended(simulator.Initialize())
        while not ended and not stop():
            ended = _has_ended(simulator.AdvanceTo(context.get_time() + LOOK))
            if progress is not None:
                progress(_progress(stage, blocks, context, begin))
    except PlannerError:
        for robot in blocks.robots:
            if robot.given.ending.failure:
                t = float(context.get_time())
                robot.given.ending.end(Ending.PLANNER_FAILED, robot.given.ending.failure, t)
    finally:
        _finish(blocks, context)
        for robot in blocks.robots:
            robot.bank.close()
    return run_outcome(
        [robot.given for robot in blocks.robots],
        sim_time=float(context.get_time()),
        wall_time=time.perf_counter() - begin,
        cpu_time=time.process_time() - cpu,
    )


def _has_ended(status: SimulatorStatus) -> bool:
    """Return True if a block has ended the run."""
    return bool(status.reason() == SimulatorStatus.ReturnReason.kReachedTerminationCondition)


def _finish(blocks: Blocks, context: Any) -> None:
    """Record all ongoing contacts and trips."""
    t = float(context.get_time())
    for robot in blocks.robots:
        robot.logger.finish(robot.logger.GetMyContextFromRoot(context), t)
    if blocks.people is not None:
        blocks.people.finish(blocks.people.GetMyContextFromRoot(context), t)


def _progress(stage: str, blocks: Blocks, context: Any, begin: float) -> Progress:
    """Return the progress: the largest time limit, and the largest distance to a zone."""
    t = float(context.get_time())
    factor = t / max(time.perf_counter() - begin, 1e-9)
    limit = max(robot.given.built.task.time_limit for robot in blocks.robots)
    going_on = [robot for robot in blocks.robots if not robot.given.ending.ended]
    places = [r for r in going_on or blocks.robots if r.given.built.target is None]
    farthest = max((_distance(robot, context) for robot in places), default=None)
    return Progress(stage, t, limit, factor, farthest)


def _distance(robot: RobotBlocks, context: Any) -> float:
    """Return the robot's distance to its goal zone, m."""
    x, y, *_ = robot.base.port.Eval(robot.base.state.GetMyContextFromRoot(context))
    return distance_to(robot.given.built.task.goal_zone, x, y)
