"""Random worlds for testing metrics: a robot, people, and each of them alone.

Everything follows from a seed, so a failing example is one number.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise
from typing import Any

import numpy as np

from crowdbot.core.trajectories.commands import Commands
from crowdbot.core.trajectories.questionnaires import TLX_SCALES, USE_ITEMS, Questionnaires
from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.core.types.arrays import Array

_RATE = 16.0
_GOAL = (3.0, 0.5)


@dataclass(frozen=True, slots=True, kw_only=True)
class World:
    """A run, its references, and its user's commands and answers."""

    run: Trajectories
    robot_alone: Trajectories | None = None
    crowd_alone: Trajectories | None = None
    commands: Commands | None = None
    commands_baseline: Commands | None = None
    questionnaires: Questionnaires | None = None

    def score_arguments(self) -> dict[str, Any]:
        """Return arguments of `crowdbot.core.scoring.evaluate.score`."""
        return {
            "crowded": self.run,
            "robot_alone": self.robot_alone,
            "crowd_alone": self.crowd_alone,
            "commands": self.commands,
            "commands_baseline": self.commands_baseline,
            "questionnaires": self.questionnaires,
        }


@lru_cache(maxsize=64)  # read-only arrays; derived quantities are cached with them
def random_world(seed: int) -> World:
    """Return a robot among up to five people who come and go, with both calibration runs."""
    rng = np.random.default_rng(seed)
    people = _people(rng, int(rng.integers(1, 6)))
    even = bool(rng.random() < 0.7)

    def times() -> Array:
        count = int(rng.integers(3, 48))
        steps = np.full(count, 1.0 / _RATE) if even else rng.uniform(0.04, 0.1, count)
        t: Array = np.cumsum(steps) - steps[0]
        return t

    t, alone, crowd = times(), times(), times()
    return World(
        run=Trajectories.from_arrays(
            t=t, **_robot(rng, t), **_crowd(rng, t, people), **_events(rng, t, people)
        ),
        robot_alone=Trajectories.from_arrays(t=alone, **_robot(rng, alone)),
        crowd_alone=Trajectories.from_arrays(t=crowd, **_crowd(rng, crowd, people)),
        commands=_commands(rng, t),
        commands_baseline=_commands(rng, t) if rng.random() < 0.5 else None,
        questionnaires=_answers(rng),
    )


@lru_cache(maxsize=64)
def straight_world(seed: int, rate: float) -> World:
    """Return a world of constant velocities for 8 s, with the robot passing through the people.

    Args:
        seed: seed of all starts and directions.
        rate: samples per second, Hz.
    """
    rng = np.random.default_rng(seed)
    t = np.linspace(0.0, 8.0, round(8.0 * rate) + 1, dtype=np.float64)
    starts = rng.uniform((-1.0, -0.3), (3.0, 0.3), (4, 2))
    velocities = rng.uniform(-0.25, 0.25, (4, 2))
    x, y = (starts[:, i] + velocities[:, i] * t[:, None] for i in (0, 1))
    robot: dict[str, Any] = {
        "robot_x": -1.5 + 0.5 * t,
        "robot_y": 0.05 * t,
        "robot_theta": np.full(len(t), np.arctan2(0.05, 0.5)),
        "robot_v": np.full(len(t), np.hypot(0.5, 0.05)),
        "robot_w": np.zeros(len(t)),
        "robot_radius": 0.2,
        "robot_mass": 6.3,
        "robot_goal_time": 8.0,
        "robot_goal": (2.5, 0.4),
        "robot_goal_radius": 0.1,
        "robot_speed_limit": 0.6,
    }
    crowd: dict[str, Any] = {
        "agent_x": x,
        "agent_y": y,
        "agent_vx": np.broadcast_to(velocities[:, 0], x.shape),
        "agent_vy": np.broadcast_to(velocities[:, 1], x.shape),
        "agent_radius": np.full(4, 0.25),
        "agent_mass": np.full(4, 70.0),
        "trip_agent": np.arange(4),
        "trip_t0": np.zeros(4),
        "trip_t1": 4.0 + np.arange(4.0),
        "trip_reached": np.ones(4, bool),
    }
    return World(
        run=Trajectories.from_arrays(t=t, **robot, **crowd),
        robot_alone=Trajectories.from_arrays(t=t, **robot),
        crowd_alone=Trajectories.from_arrays(t=t, **crowd),
    )


def portal_world(seed: int, *, through: bool) -> World:
    """Return a world with one person near the robot and three who walk a kilometre away.

    ``through``: the three pass a portal halfway: they jump 40 m, flagged as a teleport, and begin
    another trip. No velocities are recorded. A metric that counts a teleport as motion
    distinguishes the two worlds.
    """
    rng = np.random.default_rng(seed)
    t = np.arange(0.0, 6.0, 1.0 / _RATE)
    half = len(t) // 2
    speed = np.append(rng.uniform(0.5, 1.5, 3), 0.2)
    x = np.append(1000.0 + 10.0 * np.arange(3), 1.5) + speed * t[:, None]
    y = np.broadcast_to(np.append(rng.uniform(-50.0, 50.0, 3), 1.5), x.shape)
    jump = np.zeros((len(t) - 1, 4), bool)
    if through:
        x = x - np.outer(np.arange(len(t)) >= half, [40.0, 40.0, 40.0, 0.0])
        jump[half - 1, :3] = True
    crowd: dict[str, Any] = {
        "agent_x": x,
        "agent_y": y,
        "agent_radius": np.full(4, 0.25),
        "agent_mass": np.full(4, 70.0),
        "agent_jump": jump,
        "trip_agent": np.tile(np.arange(4), 2),
        "trip_t0": np.repeat([t[0], t[half]], 4),
        "trip_t1": np.repeat([t[half - 1], t[-1]], 4),
        "trip_reached": np.ones(8, bool),
    }
    robot = _robot(rng, t)
    return World(
        run=Trajectories.from_arrays(t=t, **robot, **crowd),
        robot_alone=Trajectories.from_arrays(t=t, **robot),
        crowd_alone=Trajectories.from_arrays(t=t, **crowd),
    )


# ------------------------------------------------------------------------ bodies
@dataclass(frozen=True, slots=True)
class _People:
    """Constant properties of M random people, (M,) each."""

    start: Array
    heading: Array
    speed: Array
    radius: Array
    mass: Array


def _people(rng: np.random.Generator, count: int) -> _People:
    return _People(
        start=rng.uniform(-2.0, 3.0, (count, 2)),
        heading=rng.uniform(-np.pi, np.pi, count),
        speed=rng.uniform(0.3, 1.5, count),
        radius=rng.uniform(0.2, 0.4, count),
        mass=rng.uniform(50.0, 90.0, count),
    )


def _robot(rng: np.random.Generator, t: Array) -> dict[str, Any]:
    """Return a robot that accelerates, turns and may arrive."""
    steps = np.diff(t, prepend=t[0])
    v = np.clip(0.5 + np.cumsum(rng.normal(0.0, 0.1, len(t))), -0.2, 1.2)
    w = np.clip(np.cumsum(rng.normal(0.0, 0.3, len(t))), -2.0, 2.0)
    theta = rng.uniform(-3.0, 3.0) + np.cumsum(w * steps)
    arrived = rng.random() < 0.75
    return {
        "robot_x": rng.uniform(-1, 1) + np.cumsum(v * np.cos(theta) * steps),
        "robot_y": rng.uniform(-1, 1) + np.cumsum(v * np.sin(theta) * steps),
        "robot_theta": theta,
        "robot_v": v,
        "robot_w": w,
        "robot_radius": 0.2,
        "robot_mass": 6.3,
        "robot_goal_time": float(rng.uniform(t[len(t) // 2], t[-1] + 0.05)) if arrived else None,
        "robot_goal": _GOAL,
        "robot_goal_radius": 0.5,
        "robot_speed_limit": 1.2,
    }


def _crowd(rng: np.random.Generator, t: Array, people: _People) -> dict[str, Any]:
    """Return people who sway, and may jump once, come late or leave early."""
    n, m = len(t), len(people.speed)
    heading = people.heading + np.cumsum(rng.normal(0.0, 0.1, (n, m)), axis=0)
    speed = people.speed * rng.uniform(0.8, 1.2, (n, m))
    vx, vy = speed * np.cos(heading), speed * np.sin(heading)
    steps = np.diff(t, prepend=t[0])[:, None]
    x, y = (people.start[:, i] + np.cumsum(u * steps, axis=0) for i, u in ((0, vx), (1, vy)))
    jump = np.zeros((n - 1, m), bool)
    trips = []
    for i in range(m):
        first, last = (0, n) if rng.random() < 0.6 else sorted(rng.integers(0, n, 2).tolist())
        x[:first, i] = x[last:, i] = np.nan
        cut = int(rng.integers(first, last + 1)) if rng.random() < 0.4 else last
        if first < cut < last:
            x[cut:, i] -= 2.0
            jump[cut - 1, i] = True
        ends = [k for k in (first, cut, last) if first <= k <= last]
        trips += [(i, a, b) for a, b in pairwise(ends) if b > a]
    here = np.isfinite(x)
    known = rng.random() < 0.7
    rows = {"x": x, "y": y, "vx": vx if known else vx * np.nan, "vy": vy if known else vy * np.nan}
    return {
        **{f"agent_{k}": np.where(here, v, np.nan) for k, v in rows.items()},
        "agent_id": np.arange(m) * 3 + 7,
        "agent_radius": people.radius,
        "agent_mass": people.mass,
        "agent_jump": jump,
        "trip_agent": np.array([i * 3 + 7 for i, _, _ in trips], np.int64),
        "trip_t0": np.array([t[a] for _, a, _ in trips]),
        "trip_t1": np.array([t[b - 1] + (0.01 if b < n else 0.0) for _, _, b in trips]),
        "trip_reached": np.array([b < n or rng.random() < 0.3 for _, _, b in trips], bool),
    }


def _events(rng: np.random.Generator, t: Array, people: _People) -> dict[str, Any]:
    """Return data that only the crowded run has: contacts, walls, planner times."""
    k = int(rng.integers(0, 3))
    t0 = np.sort(rng.uniform(t[0], t[-1], k))
    agent = np.array([rng.choice([-1, *(7 + 3 * np.arange(len(people.mass)))]) for _ in range(k)])
    contacts = {
        "t0": t0,
        "t1": t0 + rng.uniform(0.01, 0.3, k),
        "agent": agent.astype(np.int64),
        "impulse": rng.uniform(0.1, 5.0, k),
        "peak_force": rng.uniform(1.0, 200.0, k),
        "relative_speed": rng.uniform(0.05, 2.0, k),
        "bearing": rng.uniform(-np.pi, np.pi, k),
    }
    return {
        "contacts": contacts,
        "walls": [[-8.0, -3.0, 8.0, -3.0], [8.0, 3.0, -8.0, 3.0]],
        "planner_step_time": rng.uniform(0.001, 0.2, len(t)),
    }


def _commands(rng: np.random.Generator, t: Array) -> Commands:
    """Return commands of a hesitant user, and of a controller that mostly agrees."""
    v, w = (np.cumsum(rng.normal(0.0, 0.3, len(t))) for _ in range(2))
    idle = rng.random(len(t)) < 0.1
    return Commands.from_arrays(
        t=t,
        v_user=np.where(idle, 0.0, np.clip(v, -1.0, 1.0)),
        w_user=np.where(idle, 0.0, np.clip(w, -2.0, 2.0)),
        v_sc=np.clip(v + rng.normal(0.0, 0.2, len(t)), -1.0, 1.0),
        w_sc=np.clip(w + rng.normal(0.0, 0.5, len(t)), -2.0, 2.0),
        v_max=1.0,
        w_max=2.0,
        t_end=float(t[-1]) + 0.1,
    )


def _answers(rng: np.random.Generator) -> Questionnaires:
    """Return answers to the questionnaires; one item of each USE scale is not answered."""
    weights = rng.permutation([5.0, 4.0, 3.0, 2.0, 1.0, 0.0]).tolist()
    use = {name: rng.integers(1, 8, count).astype(float) for name, count in USE_ITEMS.items()}
    return Questionnaires(
        tlx_ratings=dict(zip(TLX_SCALES, rng.uniform(0.0, 100.0, 6).tolist(), strict=True)),
        tlx_weights=dict(zip(TLX_SCALES, weights, strict=True)),
        use={name: (None, *values.tolist()[1:]) for name, values in use.items()},
    )
