"""The outcome of a run, from how its robots have ended."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from crowdbot.core.runs.outcome import Outcome
from crowdbot.core.sim.diagram import RunRobot
from crowdbot.core.sim.robot_ending import RobotEnding
from crowdbot.core.types.ending import Ending, of_several

_INTERRUPTED_BY = "interrupted by the user"


def run_outcome(
    robots: Sequence[RunRobot], *, sim_time: float, wall_time: float, cpu_time: float
) -> Outcome:
    """Return the outcome of a run with one robot or several; times are those of the run, s."""
    found = {robot.built.name: _robot_outcome(robot) for robot in robots}
    whole = next(iter(found.values())) if len(found) == 1 else _together(robots, found)
    return replace(whole, sim_time=sim_time, wall_time=wall_time, cpu_time=cpu_time)


def status_of(ending: RobotEnding) -> str:
    """Return the status of a robot whose run is over."""
    return ending.status or Ending.INTERRUPTED


def last_arrival(endings: Sequence[RobotEnding]) -> float | None:
    """Return the arrival time of the last robot, s; None if one did not arrive."""
    known = [ending.goal_time for ending in endings if ending.goal_time is not None]
    return max(known) if len(known) == len(endings) else None


def _robot_outcome(robot: RunRobot) -> Outcome:
    """Return the outcome of one robot; its computing times are those of the run."""
    ending = robot.ending
    return Outcome(
        status=status_of(ending),
        reason=ending.reason or _INTERRUPTED_BY,
        goal_time=ending.goal_time,
        toppled_time=ending.toppled_time,
        sim_time=ending.until,
        wall_time=0.0,
        cpu_time=0.0,
        clamped=robot.log.clamped,
        planner_step_time=robot.log.step_times(),
    )


def _together(robots: Sequence[RunRobot], found: Mapping[str, Outcome]) -> Outcome:
    """Return the outcome of several robots; the caller fills in computing times."""
    outcomes = found.values()
    status = of_several(outcome.status for outcome in outcomes)
    reason = "; ".join(f"{name}: {robots[k].ending.reason}" for k, name in enumerate(found))
    return Outcome(
        status=status,
        reason=_INTERRUPTED_BY if status == Ending.INTERRUPTED else reason,
        goal_time=last_arrival([robot.ending for robot in robots]),
        sim_time=0.0,
        wall_time=0.0,
        cpu_time=0.0,
        clamped=sum(outcome.clamped for outcome in outcomes),
        planner_step_time={
            "mean": round(float(np.mean([o.planner_step_time["mean"] for o in outcomes])), 6),
            "max": max(outcome.planner_step_time["max"] for outcome in outcomes),
        },
        robots=dict(found),
    )
