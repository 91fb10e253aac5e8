"""Runner: advances a diagram to arrival, toppling, time limit, planner failure, interruption."""

from __future__ import annotations

import time
from collections.abc import Callable

from pydrake.systems.analysis import Simulator, SimulatorStatus

from crowdbot.core.geometry.polygon import distance_to
from crowdbot.core.recording.run_log import RunLog
from crowdbot.core.runs.outcome import (
    ARRIVED,
    INTERRUPTED,
    PLANNER_FAILED,
    TIMEOUT,
    Outcome,
    Progress,
)
from crowdbot.core.sim import ports
from crowdbot.core.sim.diagram import Blocks
from crowdbot.core.types.arrays import Array
from crowdbot.core.types.robot import RobotState
from crowdbot.core.types.task import Task
from crowdbot.errors import PlannerError

#: Simulated time between checks of progress and interruption, s.
LOOK = 0.125


def run(
    blocks: Blocks,
    task: Task,
    log: RunLog,
    *,
    stage: str,
    progress: Callable[[Progress], None] | None,
    stop: Callable[[], bool],
) -> Outcome:
    """Simulate one run; afterwards everything is in the log, even after an error.

    Raises:
        PlannerHungError: a planner step never returned; earlier data is in the log.
    """
    simulator = Simulator(blocks.diagram)
    context = simulator.get_mutable_context()
    blocks.robot.place(context, task.start)
    begin, cpu = time.perf_counter(), time.process_time()
    status, reason = TIMEOUT, ""
    try:
        ended = has_ended(simulator.Initialize())
        while not ended:
            if stop():
                status, reason = INTERRUPTED, "interrupted by the user"
                break
            answer = simulator.AdvanceTo(context.get_time() + LOOK)
            ended = has_ended(answer)
            if progress is not None:
                _report(progress, stage, blocks, task, context, begin)
    except PlannerError as error:
        status, reason = PLANNER_FAILED, str(error)
    finally:
        _finish(blocks, log, context)
    if blocks.logger.goal_time is not None:
        status, reason = ARRIVED, "centre inside the goal zone"
    if status == TIMEOUT:
        status, reason = blocks.logger.fate_without_arrival()
    return Outcome(
        status=status,
        reason=reason,
        goal_time=blocks.logger.goal_time,
        toppled_time=blocks.logger.toppled_time,
        sim_time=float(context.get_time()),
        wall_time=time.perf_counter() - begin,
        cpu_time=time.process_time() - cpu,
        clamped=log.clamped,
        planner_step_time=log.step_times(),
    )


def has_ended(status: SimulatorStatus) -> bool:
    """Return True if a block has ended the run."""
    return bool(status.reason() == SimulatorStatus.ReturnReason.kReachedTerminationCondition)


def _crowd(blocks: Blocks, context: object) -> Array | None:
    if blocks.crowd is None:
        return None
    mine = blocks.crowd.GetMyContextFromRoot(context)
    flat: Array = blocks.crowd.GetOutputPort(ports.CROWD_STATE).Eval(mine)
    return flat


def _finish(blocks: Blocks, log: RunLog, context: object) -> None:
    blocks.logger.walls.finish()
    log.finish(float(context.get_time()), _crowd(blocks, context))  # type: ignore[attr-defined]


def _report(
    progress: Callable[[Progress], None],
    stage: str,
    blocks: Blocks,
    task: Task,
    context: object,
    begin: float,
) -> None:
    state = blocks.robot.state
    mine = state.GetMyContextFromRoot(context)
    robot = RobotState(*state.GetOutputPort(ports.ROBOT_STATE).Eval(mine))
    t = float(context.get_time())  # type: ignore[attr-defined]
    factor = t / max(time.perf_counter() - begin, 1e-9)
    distance = distance_to(task.goal_zone, robot.x, robot.y)
    progress(Progress(stage, t, task.time_limit, factor, distance))
