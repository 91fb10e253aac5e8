"""Pictures of metrics of the robot's motion, way, task and planner, and of shared control."""

from __future__ import annotations

import numpy as np

from crowdbot.core.trajectories.preprocess import wrap
from scripts.metric_pictures.figure import BAD, QUIET, ROBOT, WITHOUT, Array, Figure
from scripts.metric_pictures.registry import draws
from scripts.metric_pictures.world import ANSWERS, World


def _middles(t: Array) -> Array:
    return (t[1:] + t[:-1]) / 2


def _acceleration(t: Array, v: Array) -> Array:
    return np.diff(v) / np.diff(t)


def _jerk(t: Array, v: Array) -> tuple[Array, Array]:
    middle = _middles(t)
    return _middles(middle), np.diff(_acceleration(t, v)) / np.diff(middle)


# ------------------------------------------------------------------------- motion
@draws("speed", "Speed of the robot; its least, mean and greatest value are the scores.")
@draws("stalled_time", "Time during which the robot is slower than 0.05 m/s.")
@draws("time_not_moving", "Time during which the robot neither drives nor turns.")
def _speed(world: World, metric: str) -> Figure:
    figure = world.over_time(metric, "speed in m/s", 0.0, 1.2 * float(world.speed.max()))
    if metric == "stalled_time":
        figure.spans(world.t, world.speed < 0.05, "stalled").level(0.05, "0.05 m/s")
    if metric == "time_not_moving":
        still = (world.speed < 0.001) & (np.abs(world.robot.w) < 0.01)
        figure.spans(world.t, still, "does not move")
        figure.line(world.t, np.abs(world.robot.w), QUIET, "turning, rad/s", dashed=True)
    return figure.line(world.t, world.speed, ROBOT, "speed of the robot")


@draws("acceleration", "Change of the forward speed, step by step; the scores are its magnitude.")
def _accelerate(world: World, metric: str) -> Figure:
    each = np.abs(_acceleration(world.t, world.robot.v))
    row = (_middles(world.t), each, ROBOT, "magnitude of the acceleration")
    return world.lines(metric, "acceleration in m/s²", [row])


@draws("jerk", "Change of the acceleration, step by step; the scores are its magnitude.")
@draws("dimensionless_jerk", "Squared jerk; its area is made free of duration and speed.")
def _jerks(world: World, metric: str) -> Figure:
    at, each = _jerk(world.t, world.robot.v)
    if metric == "jerk":
        return world.lines(metric, "jerk in m/s³", [(at, np.abs(each), ROBOT, "jerk")])
    figure = world.lines(metric, "jerk² in m²/s⁶", [(at, each**2, ROBOT, "jerk²")])
    return figure.area(at, np.zeros_like(each), each**2, "is integrated")


@draws("cumulative_heading_change", "All turning so far, whichever way.")
@draws("path_irregularity", "All turning so far; what is needed is the turn from start to end.")
def _turning(world: World, metric: str) -> Figure:
    theta = world.robot.theta
    so_far = np.concatenate([[0.0], np.cumsum(np.abs(wrap(np.diff(theta))))])
    net = np.abs(wrap(theta - theta[0]))
    rows = [
        (world.t, so_far, ROBOT, "all turning"),
        (world.t, net, WITHOUT, "turn since the start"),
    ]
    return world.lines(metric, "angle in rad", rows[: 2 if metric == "path_irregularity" else 1])


# ---------------------------------------------------------------- path efficiency
@draws("ade_to_reference", "Where the robot is with people and alone, at the same times.")
@draws("fde_to_reference", "Where the robot is with people and alone, when both have ended.")
@draws("ndtw", "The path with people and the path alone: how alike are they?")
@draws("sdtw", "The path with people and the path alone, if the robot arrives.")
@draws("relative_path_length", "The path with people, and the path alone, which is shorter.")
@draws("spl", "The path with people, and the shortest way to the goal.")
@draws("path_efficiency", "The path with people, and the shortest way to the goal.")
def _paths(world: World, metric: str) -> Figure:
    robot, lone = world.robot, world.lone
    figure = world.plane(metric)
    straight = metric in ("spl", "path_efficiency")
    if straight:
        ends = np.array([robot.x[0], robot.x[-1]]), np.array([robot.y[0], robot.y[0]])
        figure.line(*ends, WITHOUT, "shortest way", dashed=True)
    else:
        figure.line(lone.x, lone.y, WITHOUT, "alone", dashed=True)
    figure.line(robot.x, robot.y, ROBOT, "with people", wide=2.0)
    if metric == "ade_to_reference":
        for k in range(0, min(len(world.t), len(world.alone.t)), 16):
            figure.line(
                np.array([robot.x[k], lone.x[k]]),
                np.array([robot.y[k], lone.y[k]]),
                BAD,
                "at the same time",
                wide=0.8,
            )
    if metric == "fde_to_reference":
        k = min(len(world.t), len(world.alone.t)) - 1
        figure.dots([robot.x[k], lone.x[k]], [robot.y[k], lone.y[k]], BAD, "when the first arrives")
    return figure


@draws("relative_jerk", "Acceleration with people and alone; jerk is how fast it changes.")
def _relative_jerk(world: World, metric: str) -> Figure:
    rows = [
        (_middles(world.t), _acceleration(world.t, world.robot.v), ROBOT, "with people"),
        (_middles(world.alone.t), _acceleration(world.alone.t, world.lone.v), WITHOUT, "alone"),
    ]
    return world.lines(metric, "acceleration in m/s²", rows)


# --------------------------------------------------------------------------- task
@draws("relative_time_to_goal", "Distance to the goal with people and alone; 0 is arrival.")
@draws("stl", "Distance to the goal with people and alone, if the robot arrives.")
@draws("final_distance_to_goal", "Distance to the goal; the last one is the score.")
@draws("min_distance_to_goal", "Distance to the goal; the least is the score.")
@draws("regress", "Distance to the goal; where it grows, the way is lost.")
@draws("failure_to_progress", "Distance to the goal, in windows of 5 s: does each bring it nearer?")
@draws("success", "Distance to the goal; the robot arrives when its centre is in the zone.")
@draws("timeout", "Distance to the goal; no arrival within the time limit is a timeout.")
@draws("safe_efficiency", "Distance to the goal, and what the fastest straight drive would take.")
def _goal(world: World, metric: str) -> Figure:
    far = world.to_zone(world.run)
    rows = [(world.t, far, ROBOT, "distance to the goal zone")]
    if metric in ("relative_time_to_goal", "stl"):
        rows.append((world.alone.t, world.to_zone(world.alone), WITHOUT, "alone"))
    if metric == "safe_efficiency":
        limit = world.run.robot_speed_limit or float(world.speed.max())
        rows.append((world.t, np.maximum(0.0, far[0] - limit * world.t), WITHOUT, "fastest"))
    figure = world.lines(metric, "distance in m", rows)
    k = int(np.argmin(far)) if metric == "min_distance_to_goal" else -1
    if metric in ("final_distance_to_goal", "min_distance_to_goal", "success", "timeout"):
        figure.dots([world.t[k]], [far[k]], BAD, "here")
    if metric == "regress":
        figure.spans(world.t[:-1], np.diff(far) > 0, "the goal recedes")
    if metric == "failure_to_progress":
        for at in np.arange(5.0, world.t[-1], 5.0):
            figure.band(float(at), float(at))
    return figure


@draws("aggregated_time", "The robot's time and all trips of people, which are added up.")
def _aggregated(world: World, metric: str) -> Figure:
    assert world.run.trips is not None
    spent = np.sort(world.run.trips.t1 - world.run.trips.t0)[::-1]
    values = [float(world.t[-1]), *map(float, spent)]
    figure = Figure(
        world.title(metric), ("robot, then each trip", -0.5, len(values) - 0.5),
        ("duration in s", 0.0, 1.1 * max(values)),
    )  # fmt: skip
    for i, value in enumerate(values):
        colour = ROBOT if i == 0 else QUIET
        figure.line(
            np.array([i, i]),
            np.array([0.0, value]),
            colour,
            ("robot" if i == 0 else "trips"),
            wide=6,
        )
    return figure


# ------------------------------------------------------- planner, users, answers
@draws("max_planner_time", "Wall time of each planner step; the longest is the score.")
@draws("mean_planner_time", "Wall time of each planner step; the mean is the score.")
def _planner(world: World, metric: str) -> Figure:
    took = world.whole.planner_step_time
    assert took is not None
    at = np.linspace(float(world.t[0]), float(world.t[-1]), len(took))
    figure = world.lines(metric, "time in ms", [(at, 1000.0 * took, ROBOT, "each step")])
    if metric == "mean_planner_time":
        return figure.level(1000.0 * float(took.mean()), "mean", BAD)
    k = int(np.argmax(took))
    return figure.dots([at[k]], [1000.0 * took[k]], BAD, "longest")


@draws("agreement", "Direction of the user's command and of the final one (a made-up user).")
@draws("user_input_entropy", "Direction of the user's command: how predictable is it? (made up)")
def _directions(world: World, metric: str) -> Figure:
    c = world.commands
    user = np.degrees(np.arctan2(c.w_user / c.w_max, c.v_user / c.v_max))
    final = np.degrees(np.arctan2(c.w_sc / c.w_max, c.v_sc / c.v_max))
    rows = [(c.t, user, BAD, "user"), (c.t, final, ROBOT, "final command")]
    return world.lines(metric, "direction in °", rows[: 2 if metric == "agreement" else 1])


@draws("fluency", "The user's commands, as shares of the largest: how smooth are they? (made up)")
def _fluency(world: World, metric: str) -> Figure:
    c = world.commands
    rows = [(c.t, c.v_user / c.v_max, ROBOT, "forward"), (c.t, c.w_user / c.w_max, BAD, "turning")]
    return world.lines(metric, "share of the largest", rows)


@draws("nasa_tlx", "Six ratings of workload from 0 to 100; their mean is the score (made up).")
def _nasa_tlx(world: World, metric: str) -> Figure:
    ratings = ANSWERS["nasa_tlx"]
    assert isinstance(ratings, dict)
    return _answers(world, metric, {k.partition("_")[0]: float(v) for k, v in ratings.items()}, 110)


@draws("use", "Mean answers from 1 to 7 in four dimensions of usability (made up).")
def _use(world: World, metric: str) -> Figure:
    found = {
        s.variant.removeprefix("ease_of_"): s.value or 0.0
        for s in world.scores
        if s.metric == metric
    }
    return _answers(world, metric, found, 7.7)


def _answers(world: World, metric: str, values: dict[str, float], high: float) -> Figure:
    figure = Figure(world.title(metric), ("", -0.5, len(values) - 0.5), ("points", 0.0, high))
    figure.bare = True
    return figure.bars(list(values), list(values.values()), [ROBOT] * len(values))
