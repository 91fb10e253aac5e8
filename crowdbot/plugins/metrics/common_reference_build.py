"""Goal distance, progress, and the shortest path at full speed, a reference for all planners.

A planner's own run without people would be another reference for each planner: one that is slow
there, too, would lose nothing in the crowd. No planner beats the shortest path at full speed.
"""

from __future__ import annotations

import numpy as np

from crowdbot.plugin import (
    Array,
    Footprint,
    RobotTrack,
    Score,
    ScoreFactory,
    Trajectories,
    truncate_at_arrival,
)
from crowdbot.plugin.for_metrics import present, robot_of
from crowdbot.plugins.metrics.declared_build import UndefinedError

#: Smaller values are rounding errors, m or J.
_NOTHING = 1e-9


def without_task(run: Trajectories) -> str:
    """Return why the robot has no goal to reach, or "" if it has one or arrived."""
    if run.robot is None:
        return "invalid_no_robot"
    has_task = run.robot.goal is not None or run.goal_zone is not None or run.person is not None
    return "" if has_task or run.robot.goal_time is not None else "invalid_no_goal"


def robot_with_task(run: Trajectories) -> RobotTrack:
    """Return the robot; raise `UndefinedError` if it is missing or has no goal to reach."""
    if reason := without_task(run):
        raise UndefinedError(reason)
    return robot_of(run)


def missed_goal(run: Trajectories) -> bool:
    """Return True if the robot has a goal and did not arrive."""
    return not without_task(run) and robot_of(run).goal_time is None


def goal_distance(run: Trajectories) -> tuple[Array, Array]:
    """Return times (K,), s, and distances of the robot's centre to its goal (K,), m.

    Distances are to the goal zone, in which the robot arrives, or to the goal point if there is no
    zone.

    Raises:
        UndefinedError: there is no robot, no goal, or no sample.
    """
    if run.robot is None:
        raise UndefinedError("invalid_no_robot")
    run = truncate_at_arrival(run)
    robot = robot_of(run)
    known = present(robot.x, robot.y)
    if not known.any():
        raise UndefinedError("too_few_samples")
    x, y = robot.x[known], robot.y[known]
    if run.goal_zone is not None:
        return run.t[known], np.maximum(Footprint(run.goal_zone, 0.0).gap(x, y), 0.0)
    if robot.goal is not None:
        return run.t[known], np.hypot(x - robot.goal[0], y - robot.goal[1])
    raise UndefinedError("invalid_no_goal")


def way_made_good(run: Trajectories) -> float:
    """Return the progress: the largest approach to the goal so far, m."""
    _, distance = goal_distance(run)
    return float(distance[0] - distance.min())


def rate_and_way(
    factory: ScoreFactory, run: Trajectories, amount: float, least: float, variant: str = "rate"
) -> tuple[Score, Score]:
    """Score ``rate`` (or another variant), a cost per metre of progress, and ``way``, the progress.

    A robot that comes nearer by less than ``least`` (m) has no rate, whatever its cost.
    """
    try:
        way = way_made_good(run)
    except UndefinedError as error:
        return factory.undefined(variant, str(error)), factory.undefined("way", str(error))
    over = factory.ok("way", max(way, least))
    if way < least - _NOTHING:
        return factory.undefined(variant, "zero_denominator"), over
    return factory.ok(variant, amount / way, {"amount": amount, "way": way}), over


def shortest_way(run: Trajectories) -> float:
    """Return the straight distance from start to goal zone or goal disc, m.

    Walls are ignored: the true shortest path is at least as long, for every planner.
    """
    _, distance = goal_distance(run)
    radius = robot_of(run).goal_radius if run.goal_zone is None else 0.0
    return max(0.0, float(distance[0]) - radius)


def shortest_time(run: Trajectories) -> float:
    """Return the time of the shortest path at the robot's top speed, s."""
    way = shortest_way(run)
    fastest = run.robot_speed_limit
    if fastest is None:
        raise UndefinedError("invalid_no_speed_limit")
    return way / fastest
