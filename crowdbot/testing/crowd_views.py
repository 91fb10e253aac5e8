"""Crowds at one decision, and transformed copies of them."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import fields, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.crowd import Agents, CrowdView
from crowdbot.core.types.arrays import Array
from crowdbot.testing.around import RECORDED

#: Views used by every check of crowds.
SEEDS = range(4)
_MOST = RECORDED


def random_view(seed: int, *, dt: float = 1.0 / 16.0, count: int = 8) -> CrowdView:
    """Return walking people near a robot, two walls and a pillar, without overlaps."""
    assert count <= _MOST
    rng = np.random.default_rng([seed, count])
    places = np.stack(np.meshgrid(np.arange(4.0), np.arange(3.0)), -1).reshape(-1, 2) * 1.4
    position = rng.permutation(places)[:count] + rng.uniform(-0.3, 0.3, (count, 2))
    goal = position + rng.uniform(-8.0, 8.0, (count, 2))
    velocity = rng.uniform(-1.0, 1.0, (count, 2))
    agents = Agents.of(
        x=position[:, 0],
        y=position[:, 1],
        id=rng.permutation(_MOST)[:count],
        preferred_speed=rng.uniform(0.8, 1.6, count),
        radius=rng.uniform(0.2, 0.3, count),
        routes=[[tuple(point)] for point in goal.tolist()],
    )
    return CrowdView(
        agents=agents,
        position=position,
        velocity=velocity,
        goal=goal,
        present=np.ones(count, np.bool_),
        robot=np.array([[-1.4, 1.2, 0.5, 0.1, 0.43]]),
        walls=np.array([[-3.0, -1.2, 8.0, -1.2], [8.0, 4.6, -3.0, 4.6]]),
        dt=dt,
        pillars=np.array([[5.9, 1.0, 0.3]]),
    )


def odd_views() -> dict[str, CrowdView]:
    """Return name -> valid but rare crowd, such as one without people."""
    view = random_view(0)
    still = np.zeros_like(view.velocity)
    close = view.position.copy()
    close[1] = close[0] + [0.1, 0.0]
    absent = view.present.copy()
    absent[::2] = False
    alone: dict[str, Any] = {
        "robot": view.robot[:0],
        "walls": view.walls[:0],
        "pillars": view.pillars[:0],
    }
    return {
        "nobody": random_view(0, count=0),
        "one person": random_view(0, count=1),
        "one person on an empty floor": replace(random_view(0, count=1), **alone),
        "everybody absent": replace(view, present=np.zeros(len(view.present), np.bool_)),
        "every other one absent": replace(view, present=absent),
        "everybody standing": replace(view, velocity=still),
        "two overlap": replace(view, position=close),
        "everybody at the goal": replace(view, goal=view.position.copy(), velocity=still),
        "one touches a wall": replace(view, position=np.where(
            np.arange(len(close))[:, None] == 0, [2.0, -1.0], view.position + np.array([0.0, 0.4])
        )),
    }  # fmt: skip


def arrays_of(view: CrowdView) -> dict[str, bytes]:
    """Return name and content of every array of a view and of its agents."""
    pairs = [(f"agents.{f.name}", getattr(view.agents, f.name)) for f in fields(view.agents)]
    pairs += [(f.name, getattr(view, f.name)) for f in fields(view)]
    return {name: value.tobytes() for name, value in pairs if isinstance(value, np.ndarray)}


def permuted(view: CrowdView, order: NDArray[np.int64]) -> CrowdView:
    """Return the same people in another order."""
    a = view.agents
    routes = [a.route[a.first[i] : a.first[i + 1]].tolist() for i in order]
    names = ("x", "y", "preferred_speed", "id", "radius", "max_speed", "max_acceleration", "mass",
             "start_time", "at_goal", "flow", "policy", "ignores_robot", "late")  # fmt: skip
    agents = Agents.of(**{n: getattr(a, n)[order] for n in names}, routes=routes)
    rows = {n: getattr(view, n)[order] for n in ("position", "velocity", "goal", "present")}
    return replace(view, agents=agents, **rows)


def moved(view: CrowdView, by: Array) -> CrowdView:
    """Return the view with everything moved by (2,), m."""
    return _mapped(view, lambda p: p + by, lambda v: v)


def turned(view: CrowdView, angle: float) -> CrowdView:
    """Return the view with everything rotated about the origin; rad, counter-clockwise."""
    return _mapped(view, lambda p: turn(p, angle), lambda v: turn(v, angle))


def turn(vectors: Array, angle: float) -> Array:
    """Return vectors (..., 2) rotated counter-clockwise by an angle, rad."""
    c, s = math.cos(angle), math.sin(angle)
    return np.asarray(vectors @ np.array([[c, s], [-s, c]]))


def _mapped(
    view: CrowdView, place: Callable[[Array], Array], way: Callable[[Array], Array]
) -> CrowdView:
    a, robot, pillars = view.agents, view.robot.copy(), view.pillars.copy()
    start = place(np.column_stack([a.x, a.y]))
    robot[:, :2], robot[:, 2:4] = place(robot[:, :2]), way(robot[:, 2:4])
    pillars[:, :2] = place(pillars[:, :2])
    return replace(
        view,
        agents=replace(
            a,
            x=np.ascontiguousarray(start[:, 0]),
            y=np.ascontiguousarray(start[:, 1]),
            route=place(a.route),
        ),
        position=place(view.position),
        velocity=way(view.velocity),
        goal=place(view.goal),
        robot=robot,
        walls=np.column_stack([place(view.walls[:, :2]), place(view.walls[:, 2:])]),
        pillars=pillars,
    )
