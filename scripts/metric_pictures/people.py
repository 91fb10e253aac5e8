"""Pictures of metrics of what the robot costs people, and of how alike they move."""

from __future__ import annotations

import numpy as np

from crowdbot.core.trajectories.encounters import people, people_speeds
from crowdbot.core.trajectories.evasion import evasion
from crowdbot.core.trajectories.headway import share_below
from crowdbot.core.trajectories.preprocess import truncate
from crowdbot.core.trajectories.trips import meets_robot
from scripts.metric_pictures.figure import BAD, PERSON, QUIET, ROBOT, WITHOUT, Figure
from scripts.metric_pictures.registry import draws
from scripts.metric_pictures.world import JUMP, World, mean_of


def _most_moved(world: World) -> tuple[int, int, int]:
    """Who is moved farthest while the robot is near: column, first and last sample."""
    agents, crowd = world.agents, people(world.crowd)
    count = min(len(world.t), len(world.crowd.t))
    off = np.hypot(agents.x[:count] - crowd.x[:count], agents.y[:count] - crowd.y[:count])
    best, found = -1.0, (0, 0, 1)
    for j in range(off.shape[1]):
        near = np.flatnonzero(world.near[:count, j])
        if not len(near):
            continue
        first = int(near[0])
        last = first
        while last + 1 < count and world.near[last + 1, j]:
            last += 1
        last = min(last + 16, count - 1)
        known = off[first : last + 1, j]
        jumps = np.hypot(
            np.diff(agents.x[first : last + 1, j]), np.diff(agents.y[first : last + 1, j])
        )
        if off[first, j] > 0.1 or not np.isfinite(known).all() or (jumps > 1).any():
            continue
        if known.max() > best:
            best, found = float(known.max()), (j, first, last)
    return found


@draws("displacement", "The way of the person who is moved farthest, with the robot and without.")
def _displacement(world: World, metric: str) -> Figure:
    j, a, b = _most_moved(world)
    agents, crowd, robot = world.agents, people(world.crowd), world.robot
    figure = world.plane(metric).line(robot.x[a:b], robot.y[a:b], ROBOT, "robot", wide=2.0)
    figure.line(crowd.x[a:b, j], crowd.y[a:b, j], WITHOUT, "without the robot", dashed=True)
    figure.line(agents.x[a:b, j], agents.y[a:b, j], PERSON, "with the robot", wide=2.0)
    for k in range(a, b, 6):
        ends = np.array([[agents.x[k, j], agents.y[k, j]], [crowd.x[k, j], crowd.y[k, j]]])
        figure.line(ends[:, 0], ends[:, 1], BAD, "at the same time", wide=0.8)
    return figure


@draws("delay", "How far the person who is moved farthest has come, with the robot and without.")
def _delay(world: World, metric: str) -> Figure:
    j, a, b = _most_moved(world)
    agents, crowd = world.agents, people(world.crowd)
    way = [np.abs(of.x[a : b + 1, j] - of.x[a, j]) for of in (agents, crowd)]
    t = world.t[a : b + 1]
    figure = Figure(
        world.title(metric), ("time in s", float(t[0]), float(t[-1])),
        ("way in m", 0.0, 1.1 * max(float(w.max()) for w in way)),
    )  # fmt: skip
    figure.line(t, way[0], PERSON, "with the robot")
    return figure.line(t, way[1], WITHOUT, "without the robot", dashed=True)


@draws(
    "crowd_deviation",
    "How far people are from where they would be without the robot; some re-enter elsewhere.",
)
def _crowd_deviation(world: World, metric: str) -> Figure:
    count = min(len(world.t), len(world.crowd.t))
    agents, crowd = world.agents, people(world.crowd)
    off = np.hypot(agents.x[:count] - crowd.x[:count], agents.y[:count] - crowd.y[:count])
    some = range(0, off.shape[1], max(1, off.shape[1] // 5))
    rows = [(world.t[:count], off[:, j], QUIET, "some of them") for j in some]
    figure = world.lines(metric, "distance in m", rows)
    return figure.line(world.t[:count], mean_of(off), PERSON, "mean of all", wide=2.2)


@draws("evasive_acceleration", "The largest acceleration of people within 2 m of the robot.")
def _evasive(world: World, metric: str) -> Figure:
    found = evasion(world.run, 2.0, JUMP)
    size = np.where(found.near, found.size, 0.0)
    t = (world.t[1:] + world.t[:-1]) / 2
    rows = [(t, size.max(axis=1), PERSON, "the largest at each time")]
    figure = world.lines(metric, "acceleration in m/s²", rows)
    return figure.level(world.scores.find(metric).value or 0.0, "score", BAD)


@draws("push_work", "The robot's advance at people times their acceleration away from it.")
def _push_work(world: World, metric: str) -> Figure:
    found = evasion(world.run, 2.0, JUMP)
    each = found.approach * found.away * world.agents.mass
    forced = (each * share_below(world.run, 0.5, JUMP)).sum(axis=1)
    t = (world.t[1:] + world.t[:-1]) / 2
    rows = [(t, each.sum(axis=1), QUIET, "all people within 2 m")]
    figure = world.lines(metric, "power in W", rows)
    figure.area(t, np.zeros_like(forced), forced, "whom it would reach in 0.5 s: work", "#e8bccf")
    return figure.line(t, forced, BAD)


# ---------------------------------------------------------------- effect on crowd
@draws("effect_on_velocity", "Mean walking speed with the robot and without.")
def _effect_on_velocity(world: World, metric: str) -> Figure:
    crowd = truncate(world.crowd, float(world.t[-1]))
    rows = [
        (world.t, mean_of(world.walking), PERSON, "with the robot"),
        (crowd.t, mean_of(people_speeds(crowd, JUMP)), WITHOUT, "without the robot"),
    ]
    return world.lines(metric, "walking speed in m/s", rows)


@draws("neighbours_velocity", "Mean walking speed of those within 3 m of the robot, and of all.")
def _neighbours_velocity(world: World, metric: str) -> Figure:
    rows = [
        (world.t, mean_of(np.where(world.near, world.walking, np.nan)), PERSON, "near the robot"),
        (world.t, mean_of(world.walking), WITHOUT, "all"),
    ]
    return world.lines(metric, "walking speed in m/s", rows)


@draws("effect_on_time", "Mean durations of people's trips so far, with the robot and without.")
@draws(
    "neighbours_time_to_goal", "Mean durations of trips: of people who meet the robot, and of all."
)
@draws(
    "time_to_goal_similarity", "Time of the robot, and mean time of people, per metre of progress."
)
@draws(
    "path_length_similarity", "Path of the robot, and mean path of people, per metre of progress."
)
def _two_bars(world: World, metric: str) -> Figure:
    if metric.endswith("similarity"):
        names, values, label = _per_metre(world, metric)
    else:
        names, values, label = (_met_times if metric.startswith("n") else _trip_times)(world)
    figure = Figure(world.title(metric), ("", -0.8, 1.8), (label, 0.0, 1.25 * max(values)))
    figure.bare = True
    first = ROBOT if names[0] == "robot" else PERSON
    return figure.bars(names, values, [first, WITHOUT])


_Bars = tuple[list[str], list[float], str]


def _trip_times(world: World) -> _Bars:
    crowd = truncate(world.crowd, float(world.t[-1]))
    assert world.run.trips is not None
    assert crowd.trips is not None
    means = [float((t.t1 - t.t0).mean()) for t in (world.run.trips, crowd.trips)]
    return ["with the robot", "without"], means, "duration in s"


def _met_times(world: World) -> _Bars:
    assert world.run.trips is not None
    took = world.run.trips.t1 - world.run.trips.t0
    met = meets_robot(world.run, 3.0)
    return ["meet the robot", "all"], [float(took[met].mean()), float(took.mean())], "duration in s"


def _per_metre(world: World, metric: str) -> _Bars:
    extras = world.scores.find(metric).extras
    label = "s per m" if metric == "time_to_goal_similarity" else "m per m"
    return ["robot", "people"], [extras["robot"], extras["agents"]], label


# --------------------------------------------------------------------- similarity
@draws("velocity_similarity", "Speed of the robot, and mean walking speed of people.")
@draws("neighbour_velocity_similarity", "Speed of the robot, and mean speed of those within 3 m.")
def _speeds(world: World, metric: str) -> Figure:
    near = metric.startswith("neighbour")
    others = np.where(world.near, world.walking, np.nan) if near else world.walking
    name = "people within 3 m" if near else "people"
    rows = [(world.t, world.speed, ROBOT, "robot"), (world.t, mean_of(others), PERSON, name)]
    return world.lines(metric, "speed in m/s", rows)


@draws("heading_similarity", "Turning rate of the robot, and mean turning rate of people.")
def _heading(world: World, metric: str) -> Figure:
    agents, dt = world.agents, np.diff(world.t)[:, None]
    heading = np.where(world.walking > 0.1, np.arctan2(agents.vy, agents.vx), np.nan)
    turn = np.abs(np.angle(np.exp(1j * np.diff(heading, axis=0)))) / dt
    t = (world.t[1:] + world.t[:-1]) / 2
    robot = np.abs(np.angle(np.exp(1j * np.diff(world.robot.theta)))) / dt[:, 0]
    rows = [(t, robot, ROBOT, "robot"), (t, mean_of(turn), PERSON, "mean of people")]
    return world.lines(metric, "turning in rad/s", rows)


@draws("overtaking_count", "How far each person is ahead of the robot: who falls behind is passed.")
def _overtaking(world: World, metric: str) -> Figure:
    theta = world.robot.theta[:, None]
    ahead = world.pair.px * np.cos(theta) + world.pair.py * np.sin(theta)
    same = np.cos(np.arctan2(world.agents.vy, world.agents.vx) - theta) > 0.5
    figure = world.over_time(metric, "ahead of the robot in m", -4.0, 4.0).level(
        0.0, "level with the robot"
    )
    beside = np.where(same & (np.abs(ahead) < 4) & (np.abs(world.pair.py) < 1.5), ahead, np.nan)
    for j in range(ahead.shape[1]):
        figure.line(world.t, beside[:, j], PERSON, "those who go its way", wide=1.2)
    return figure
