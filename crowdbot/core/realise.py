"""Draws a scenario's crowd: who starts where, how fast, with which goals."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.realisation import Realisation
from crowdbot.dsl.scenario import AtGoal, Crowd, Scenario
from crowdbot.dsl.seeds import stream_seed
from crowdbot.errors import InputError

Array = NDArray[np.float64]

#: Attempts to place one person before the zone counts as full.
_ATTEMPTS = 10_000


def realise(scenario: Scenario) -> Realisation:
    """Draw the crowd from its named streams; an empty table when there is no crowd.

    Raises:
        InputError: the people do not fit into their zone.
    """
    crowd = scenario.crowd
    if crowd is None:
        return Realisation.nobody()
    zone = scenario.environment.zones[crowd.flow.area]
    count = round(crowd.flow.density * zone.area)
    seed, key = crowd.seed.root, crowd.seed.key
    spawn = np.random.default_rng(stream_seed(seed, key, "crowd.spawn"))
    pace = np.random.default_rng(stream_seed(seed, key, "crowd.speed"))
    margin = crowd.body.radius
    low = np.array([zone.x[0] + margin, zone.y[0] + margin])
    high = np.array([zone.x[1] - margin, zone.y[1] - margin])
    position = _scatter(spawn, count, low, high, 2.0 * crowd.body.radius)
    flow, body = crowd.flow, crowd.body
    portals = flow.portals if flow.direction == "in" else (flow.portals[1], flow.portals[0])
    everyone = np.ones(count)
    at_goal: AtGoal = "portal"
    return Realisation(
        id=np.arange(count, dtype=np.int64),
        x=position[:, 0],
        y=position[:, 1],
        heading=np.zeros(count),
        speed=_speeds(pace, count, crowd),
        radius=body.radius * everyone,
        mass=body.mass * everyone,
        max_speed=body.max_speed * everyone,
        max_acceleration=body.max_acceleration * everyone,
        start_time=np.zeros(count),
        group=np.full(count, -1, dtype=np.int64),
        policy=("",) * count,
        at_goal=(at_goal,) * count,
        portals=(portals,) * count,
        goals=((),) * count,
        goal_key=stream_seed(seed, key, "crowd.goal"),
    )


def _scatter(
    rng: np.random.Generator, count: int, low: Array, high: Array, spacing: float
) -> Array:
    """Random points (count, 2) of a box, no two closer than ``spacing``."""
    points = np.full((count, 2), np.inf)
    for i in range(count):
        for _ in range(_ATTEMPTS):
            point = low + (high - low) * rng.random(2)
            offset = points[:i] - point
            if not np.any(offset[:, 0] ** 2 + offset[:, 1] ** 2 < spacing * spacing):
                points[i] = point
                break
        else:
            raise InputError(f"only {i} of {count} people fit into the crowd's zone")
    return points


def _speeds(rng: np.random.Generator, count: int, crowd: Crowd) -> Array:
    """Normal, truncated at three standard deviations and at 5 % of the mean."""
    mean, std = crowd.speed.mean, crowd.speed.std
    low, high = max(mean - 3.0 * std, 0.05 * mean), mean + 3.0 * std
    speeds = np.empty(count)
    for i in range(count):
        draw = rng.normal(mean, std)
        while not low <= draw <= high:
            draw = rng.normal(mean, std)
        speeds[i] = draw
    return speeds
