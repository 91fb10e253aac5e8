"""Times all metrics of a long run in a dense crowd, with both references.

Usage: python benchmarks/scoring.py [PEOPLE] [SECONDS]
"""

from __future__ import annotations

import dataclasses
import sys
import time

import numpy as np
from numpy.typing import NDArray

from crowdbot.api import registry
from crowdbot.core.scoring.evaluate import score
from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.core.types.arrays import Array

RATE = 16.0
LENGTH, WIDTH = 45.0, 8.0


def main(people: int, seconds: float) -> None:
    crowded = corridor(people, seconds, seed=1)
    alone = dataclasses.replace(corridor(people, seconds, seed=2), agents=None, trips=None)
    crowd = dataclasses.replace(corridor(people, seconds, seed=3), robot=None)
    installed = registry()
    known = installed.components("metric")
    for kind in known:  # imports are not what is measured
        score(installed, Trajectories(t=np.zeros(1)), metrics=kind)
    for what, metrics in (("all", ["*"]), ("all, and experimental ones", list(known))):
        run, robot, people_alone = (dataclasses.replace(r) for r in (crowded, alone, crowd))
        start, cpu = time.perf_counter(), time.process_time()
        found = score(installed, run, robot, people_alone, metrics=metrics)
        took, cpu = time.perf_counter() - start, time.process_time() - cpu
        size = f"{people} people, {len(crowded.t)} samples"
        print(f"{what}: {took:.2f} s ({cpu:.2f} s of CPU), {len(found)} scores, {size}")
    if "-v" in sys.argv:
        for kind in known:
            run, robot, people_alone = (dataclasses.replace(r) for r in (crowded, alone, crowd))
            start = time.perf_counter()
            score(installed, run, robot, people_alone, metrics=kind)
            print(f"{time.perf_counter() - start:7.3f} s  {kind} alone")


def corridor(people: int, seconds: float, seed: int) -> Trajectories:
    """People up and down a corridor with portals at its ends, and a robot that drives through."""
    rng = np.random.default_rng(seed)
    n = round(seconds * RATE) + 1
    t = np.arange(n) / RATE
    vx = rng.choice([-1.0, 1.0], people) * rng.uniform(0.6, 1.6, people)
    drift = np.cumsum(rng.normal(0, 0.02, (n, people)), axis=0)
    far = rng.uniform(0, LENGTH, people) + t[:, None] * vx + drift
    x, lap = far % LENGTH, np.floor(far / LENGTH)
    y = rng.uniform(0, WIDTH, people) + np.cumsum(rng.normal(0, 0.01, (n, people)), axis=0)
    jump = np.diff(lap, axis=0) != 0
    trips = [_laps(t, jump[:, i]) for i in range(people)]
    agent = np.repeat(np.arange(people), [len(a) for a in trips])
    t0, t1, reached = np.concatenate(trips).T
    theta = 0.3 * np.sin(t / 3.0)
    return Trajectories.from_arrays(
        t=t,
        robot_x=LENGTH * t / seconds,
        robot_y=WIDTH / 2 + 0 * t,
        robot_theta=theta,
        robot_v=LENGTH / seconds + 0.01 * rng.normal(size=n),
        robot_w=np.gradient(theta, t),
        robot_radius=0.4,
        robot_mass=29.0,
        robot_goal_time=seconds,
        robot_goal=(LENGTH, WIDTH / 2),
        robot_goal_radius=0.5,
        agent_x=x,
        agent_y=y,
        agent_vx=np.broadcast_to(vx, x.shape),
        agent_vy=np.zeros(x.shape),
        agent_radius=0.25,
        agent_mass=70.0,
        agent_jump=jump,
        trip_agent=agent,
        trip_t0=t0,
        trip_t1=t1,
        trip_reached=reached != 0,
        walls=[[0, 0, LENGTH, 0], [LENGTH, WIDTH, 0, WIDTH]],
        planner_step_time=np.full(n, 0.01),
    )


def _laps(t: Array, jump: NDArray[np.bool_]) -> Array:
    """Rows of start, end, reached."""
    edges = np.concatenate([[0], np.flatnonzero(jump) + 1, [len(t) - 1]])
    reached = np.ones(len(edges) - 1)
    reached[-1] = 0
    return np.column_stack([t[edges[:-1]], t[edges[1:]], reached])


if __name__ == "__main__":
    given = [float(a) for a in sys.argv[1:] if a != "-v"]
    main(int(given[0]) if given else 200, given[1] if len(given) > 1 else 150.0)
