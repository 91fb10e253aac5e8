"""Encounters drawn from shipped distributions, for comparison without recordings.

A scene has a robot that drives straight on and a person who would meet it. Speeds, angle, time and
predicted gap are drawn from the recorded distributions of a cell, independently of each other.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from crowdbot.core.geometry.footprint import Footprint
from crowdbot.core.realism.near_robots.clip import RATE
from crowdbot.core.realism.near_robots.encounters import AFTER, BODY, RobotEncounter, encounter
from crowdbot.core.realism.near_robots.features import FEATURES, features_of
from crowdbot.core.realism.near_robots.statistics import LEVELS
from crowdbot.core.types.arrays import Array

#: Scenes drawn for each cell.
COUNT = 40
#: Quantities that are drawn.
_DRAWN = ("robot_speed", "person_speed", "angle", "time", "predicted_gap")
_FIRST = list(FEATURES).index("passes_first")


@dataclass(frozen=True, slots=True, kw_only=True)
class SceneTable:
    """Distributions of the encounters of one cell.

    Attributes:
        quantiles: quantity -> (19,) quantiles; m/s, rad, s, m.
        first: share of people who would cross in front of the robot if they walked straight on.
        robots: outlines of the robots, each as often as it was recorded.
    """

    quantiles: Mapping[str, Array]
    first: float
    robots: Sequence[tuple[Footprint, float]]

    def as_json(self) -> dict[str, Any]:
        """Return data that `from_json` reads."""
        return {
            "quantiles": {n: [round(float(v), 3) for v in q] for n, q in self.quantiles.items()},
            "first": round(self.first, 3),
            "robots": [
                {"corners": f.corners.tolist(), "radius": f.radius, "share": round(share, 3)}
                for f, share in self.robots
            ],
        }

    @classmethod
    def from_json(cls, data: Mapping[str, Any]) -> SceneTable:
        """Read data from `as_json`."""
        return cls(
            quantiles={n: np.array(q, np.float64) for n, q in data["quantiles"].items()},
            first=float(data["first"]),
            robots=[
                (
                    Footprint(np.array(r["corners"], np.float64).reshape(-1, 2), r["radius"]),
                    float(r["share"]),
                )
                for r in data["robots"]
            ],
        )


def table_of(encounters: Sequence[RobotEncounter]) -> SceneTable:
    """Return the distributions of some encounters, all of one cell."""
    straight = features_of(encounters, [e.straight for e in encounters])[:, _FIRST]
    robots: dict[tuple[Any, ...], tuple[Footprint, int]] = {}
    for e in encounters:
        key = (e.footprint.radius, *e.footprint.corners.ravel().tolist())
        robots[key] = e.footprint, robots.get(key, (e.footprint, 0))[1] + 1
    known = straight[np.isfinite(straight)]
    return SceneTable(
        quantiles={
            name: np.quantile(values, LEVELS)
            for name, values in zip(
                _DRAWN, np.array([_drawn(e) for e in encounters]).T, strict=True
            )
        },
        first=float(known.mean()) if len(known) else 0.5,
        robots=[(f, n / len(encounters)) for f, n in robots.values()],
    )


def _drawn(e: RobotEncounter) -> list[float]:
    way = e.pose[e.closest, :2] - e.pose[0, :2]
    angle = math.atan2(
        way[0] * e.velocity[1] - way[1] * e.velocity[0], float(np.dot(way, e.velocity))
    )
    gap = e.gap(e.straight)
    return [
        e.robot_speed,
        math.hypot(*e.velocity),
        abs(angle),
        float(e.t[np.argmin(gap)]),
        e.predicted_gap,
    ]


def scenes_of(table: SceneTable, seed: int, count: int = COUNT) -> list[RobotEncounter]:
    """Draw scenes: each quantity is cut into slices, which are combined at random."""
    rng = np.random.default_rng([seed, 0x5CE])
    draws = {name: np.interp(_slices(rng, count), LEVELS, q) for name, q in table.quantiles.items()}
    which = np.searchsorted(np.cumsum([s for _, s in table.robots]), _slices(rng, count) * 0.999)
    first = _slices(rng, count) < table.first
    scenes = []
    for k in range(count):
        robot = table.robots[min(int(which[k]), len(table.robots) - 1)][0]
        one = _scene({n: float(v[k]) for n, v in draws.items()}, robot, bool(first[k]), k)
        if one is not None:
            scenes.append(one)
    return scenes


def _slices(rng: np.random.Generator, count: int) -> Array:
    return (rng.permutation(count) + rng.uniform(0.0, 1.0, count)) / count


def _scene(
    draw: Mapping[str, float], robot: Footprint, first: bool, k: int
) -> RobotEncounter | None:
    """Return an encounter with a robot that drives along x and is at the origin at ``time``."""
    speed, time = draw["robot_speed"], max(1.0, draw["time"])
    t = np.arange(0.0, time + AFTER, 1.0 / RATE)
    pose = np.column_stack([speed * (t - time), np.zeros(len(t)), np.zeros(len(t))])
    heading = draw["angle"] * (1.0 if k % 2 else -1.0)
    velocity = draw["person_speed"] * np.array([math.cos(heading), math.sin(heading)])
    w = velocity - [speed, 0.0]
    across = np.array([-w[1], w[0]]) / max(math.hypot(*w), 1e-9)
    if (across[0] > 0.0) != first:
        across = -across
    half = float(np.max(robot.corners @ across, initial=0.0)) + robot.radius
    offset = across * max(0.0, draw["predicted_gap"] + half + BODY)
    person = offset + (t - time)[:, np.newaxis] * velocity
    closest = min(len(t) - 2, round(time * RATE))
    return encounter(f"scene {k}", "scenes", t, pose, person, closest, robot)
