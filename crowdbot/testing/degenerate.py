"""Edge cases of runs: almost empty, or exactly on a threshold."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np

from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.core.types.arrays import Array
from crowdbot.testing.symmetries import with_people
from crowdbot.testing.worlds import World, random_world


@cache
def worlds() -> Mapping[str, World]:
    """Return name -> world without something that metrics often assume, such as people."""
    world = random_world(7)
    run = world.run
    robot, agents = run.robot, run.agents
    assert robot is not None
    assert agents is not None
    nowhere = np.full_like(agents.x, np.nan)
    absent = replace(agents, x=nowhere, y=nowhere, vx=nowhere, vy=nowhere)
    speechless = replace(agents, vx=nowhere, vy=nowhere)
    lost = np.full_like(robot.x, np.nan)
    runs: dict[str, Trajectories] = {
        "no people": replace(run, agents=None, trips=None),
        "an empty table": with_people(run, []),
        "no robot": replace(run, robot=None, contacts=None),
        "neither robot nor people": replace(run, robot=None, agents=None, trips=None),
        "one sample": first(run, 1),
        "two samples": first(run, 2),
        "everybody absent": replace(run, agents=absent),
        "no velocities": replace(run, agents=speechless),
        "the robot has no pose": replace(run, robot=replace(robot, x=lost, y=lost, theta=lost)),
        "no trips": replace(run, trips=None),
        "never arrived": replace(run, robot=replace(robot, goal_time=None)),
        "no goal": replace(run, robot=replace(robot, goal=None)),
        "no events": replace(run, contacts=None, walls=None, planner_step_time=None),
        "no planner steps": replace(run, planner_step_time=np.zeros(0), walls=np.zeros((0, 4))),
        "arrived at once": replace(run, robot=replace(robot, goal_time=float(run.t[0]))),
        "nothing moves": standing(),
    }
    return {
        **{name: replace(world, run=changed) for name, changed in runs.items()},
        **{f"{name}, as reference": _references(run, changed) for name, changed in runs.items()},
        "no reference": World(run=run),
    }


@cache
def on_thresholds() -> Mapping[str, World]:
    """Return name -> world exactly on a threshold, where a rounding error could decide."""
    t = np.arange(101) / 16.0
    still = np.zeros(101)
    trembling = 0.43 + 0.05 * (np.arange(101) % 2).astype(np.float64)
    runs = {
        "a touch": _meeting(t, still, np.full(101, 0.43), still),
        "a graze": _meeting(t, t, 10.0 - t, np.full(101, 0.43)),
        "release and touch": _meeting(t, still, trembling, still),
        "on the edge of the neighbourhood": _meeting(t, still, np.full(101, 3.0), still),
        "side by side": _meeting(t, t, t, np.full(101, 1.0)),
        "just too fast": _meeting(t, 10.0 * t, 10.0 * t, np.full(101, 5.0)),
        "nothing moves": standing(),
    }
    return {name: World(run=r, robot_alone=r, crowd_alone=r) for name, r in runs.items()}


def standing() -> Trajectories:
    """Return a run with a standing robot and a standing person who do not touch."""
    t = np.arange(33) / 16.0
    return _meeting(t, np.zeros(33), np.full(33, 2.0), np.full(33, 1.0))


def first(run: Trajectories, count: int) -> Trajectories:
    """Return a run cut to its first ``count`` samples."""
    robot, agents = run.robot, run.agents
    if robot is not None:
        rows: dict[str, Any] = {n: getattr(robot, n)[:count] for n in ("x", "y", "theta", "v", "w")}
        robot = replace(robot, goal_time=None, **rows)
    if agents is not None:
        rows = {n: getattr(agents, n)[:count] for n in ("x", "y", "vx", "vy")}
        jump = None if agents.jump is None else agents.jump[: count - 1]
        agents = replace(agents, jump=jump, **rows)
    return replace(run, t=run.t[:count], robot=robot, agents=agents)


def _references(run: Trajectories, changed: Trajectories) -> World:
    return World(run=run, robot_alone=changed, crowd_alone=changed)


def _meeting(t: Array, robot_x: Array, x: Array, y: Array) -> Trajectories:
    """Return a run of a robot (radius 0.18 m) on the x axis and one person (radius 0.25 m).

    Velocities follow from the positions.
    """
    v = np.gradient(robot_x, t)
    return Trajectories.from_arrays(
        t=t,
        robot_x=robot_x,
        robot_y=0.0 * t,
        robot_theta=0.0 * t,
        robot_v=v,
        robot_w=0.0 * t,
        robot_radius=0.18,
        robot_mass=6.3,
        robot_goal_time=float(t[-1]),
        robot_goal=(float(robot_x[-1]), 0.0),
        agent_x=x[:, None],
        agent_y=y[:, None],
        agent_radius=0.25,
        agent_mass=70.0,
        trip_agent=[0],
        trip_t0=[t[0]],
        trip_t1=[t[-1]],
        trip_reached=[True],
    )
