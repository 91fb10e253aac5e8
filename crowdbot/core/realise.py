"""Realisation: a scenario's crowd, drawn: who starts where, how fast, with which goals."""

from __future__ import annotations

import csv
import hashlib
import io
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from crowdbot.dsl.scenario import Crowd, Scenario
from crowdbot.dsl.seeds import stream_seed
from crowdbot.errors import InputError

Array = NDArray[np.float64]

#: Attempts to place one person before the zone counts as full.
_ATTEMPTS = 10_000


@dataclass(frozen=True, slots=True, kw_only=True)
class Realisation:
    """The table of agents. x, y (m) and speed (m/s) are (N,); ``goal_key`` keys their goals."""

    id: NDArray[np.int64]
    x: Array
    y: Array
    speed: Array
    goal_key: int

    def to_csv(self) -> str:
        """The table as text, decimals that read back exactly."""
        text = io.StringIO()
        rows = csv.writer(text, lineterminator="\n")
        rows.writerow(["id", "x", "y", "speed", "goal_key"])
        for i, x, y, s in zip(self.id, self.x, self.y, self.speed, strict=True):
            rows.writerow([int(i), repr(float(x)), repr(float(y)), repr(float(s)), self.goal_key])
        return text.getvalue()

    @property
    def hash(self) -> str:
        """Content hash of the table."""
        return f"cb1-sha256:{hashlib.sha256(self.to_csv().encode()).hexdigest()}"


def realise(scenario: Scenario) -> Realisation:
    """Draw the crowd from its named streams; an empty table when there is no crowd.

    Raises:
        InputError: the people do not fit into their zone.
    """
    crowd = scenario.crowd
    if crowd is None:
        none = np.zeros(0)
        return Realisation(id=np.zeros(0, np.int64), x=none, y=none, speed=none, goal_key=0)
    zone = scenario.environment.zones[crowd.flow.area]
    count = round(crowd.flow.density * zone.area)
    seed, key = crowd.seed.root, crowd.seed.key
    spawn = np.random.default_rng(stream_seed(seed, key, "crowd.spawn"))
    pace = np.random.default_rng(stream_seed(seed, key, "crowd.speed"))
    margin = crowd.body.radius
    low = np.array([zone.x[0] + margin, zone.y[0] + margin])
    high = np.array([zone.x[1] - margin, zone.y[1] - margin])
    position = _scatter(spawn, count, low, high, 2.0 * crowd.body.radius)
    return Realisation(
        id=np.arange(count, dtype=np.int64),
        x=position[:, 0],
        y=position[:, 1],
        speed=_speeds(pace, count, crowd),
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
