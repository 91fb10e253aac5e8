"""Sensors built as the simulation builds them, and scenes for them to look at."""

from __future__ import annotations

import math
from typing import Any, cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from crowdbot.core.registry.registry import discover
from crowdbot.core.sensing.build import build_sensor
from crowdbot.core.sensing.noise import sensor_rng
from crowdbot.core.sensing.scene import Scene
from crowdbot.dsl.spec.component_specs import SensorSpec
from crowdbot.plugin import Pose, RobotState, Sensor
from crowdbot.testing.sensor_scenes import context

Array = NDArray[np.float64]
REGISTRY = discover(allow=())
ORIGIN = Pose(0.0, 0.0, 0.0)
BASE = 0.0102
NO_WALLS = np.empty((0, 4))
EVERYBODY = 1.7


def sensor(kind: str, **fields: Any) -> Sensor:
    """A sensor from what a document would say."""
    spec = REGISTRY.spec_model("sensor", kind).model_validate({"kind": kind, **fields})
    return cast(Sensor, build_sensor(REGISTRY, cast(SensorSpec, spec), context()))


def scene_of(
    people: ArrayLike = (),
    walls: ArrayLike = NO_WALLS,
    *,
    pillars: ArrayLike = (),
    height: float = EVERYBODY,
    pillar_heights: ArrayLike = (0.0, 2.5),
    facing: float = 0.0,
    robot_z: float | None = BASE,
) -> Scene:
    """People (M, 2) who stand and face one way, walls (S, 4), pillars (P, 3)."""
    where = np.reshape(np.asarray(people, np.float64), (-1, 2))
    scene = Scene(walls, [0.0, 2.5], np.full(len(where), 0.33), height, pillars, pillar_heights)
    robot = None if robot_z is None else RobotState(0, 0, 0, 0, 0, 0, 0, robot_z, 0, 0)
    direction = np.tile([math.cos(facing), math.sin(facing)], (len(where), 1))
    xyv = np.column_stack([where, np.zeros_like(where)])
    scene.update(robot, xyv, np.ones(len(where), np.bool_), direction, np.zeros(len(where)))
    return scene


def read(one: Sensor, scene: Scene, pose: Pose = ORIGIN, tick: int = 0, seed: int = 0) -> Array:
    """One reading with the random numbers that the simulation would hand over."""
    return one.read(scene, pose, tick / 128, sensor_rng(seed, "robot", "it", tick))


def scalar(one: Sensor, scene: Scene, pose: Pose = ORIGIN, tick: int = 0) -> float:
    """The reading of a sensor of one number."""
    (value,) = read(one, scene, pose, tick).tolist()
    return float(value)


def cylinders(
    xyv: Array, direction: Array, walked: Array, height: float, radius: float
) -> list[tuple[float, float, float, float, float, int]]:
    """x, y, radius, bottom, top, owner of everybody's legs and trunk, by complex numbers."""
    found = []
    scale = min(1.0, radius / 0.33)
    for i, (x, y, vx, vy) in enumerate(xyv.tolist()):
        ahead, here = complex(*direction[i]), complex(x, y)
        stride = 0.19 * scale * min(1.0, abs(complex(vx, vy)) / 0.6)
        step = stride * math.sin(walked[i] / (0.83 * height) * math.tau)
        foot = step * ahead + 0.5 * 0.9 * 0.191 * height * scale * 1j * ahead
        legs = (here + foot, here - foot)
        found += [(leg.real, leg.imag, 0.07 * scale, 0.0, 0.53 * height, i) for leg in legs]
        found.append((x, y, 0.259 / 2 * height * scale, 0.53 * height, height, i))
    return found


def crowd_of(seed: int, count: int) -> tuple[Array, Array, Array]:
    """(M, 4) people who walk, their directions (M, 2) and the way walked (M,)."""
    rng = np.random.default_rng(seed)
    turn = rng.uniform(-np.pi, np.pi, count)
    direction = np.column_stack([np.cos(turn), np.sin(turn)])
    velocity = direction * rng.uniform(0.0, 1.5, (count, 1))
    xyv = np.column_stack([rng.uniform(-8, 8, (count, 2)), velocity])
    return xyv, direction, rng.uniform(0.0, 50.0, count)


def walls_of(rng: np.random.Generator, count: int) -> tuple[Array, Array]:
    """(S, 4) and (S, 2): segments anywhere, at heights anywhere."""
    return rng.uniform(-8, 8, (count, 4)), np.sort(rng.uniform(0.0, 2.5, (count, 2)), axis=1)


def world(seed: int) -> Scene:
    """People, walls and pillars in 16 m x 16 m."""
    rng = np.random.default_rng(seed)
    count = int(rng.integers(0, 15))
    pillars = rng.uniform((-8, -8, 0.05), (8, 8, 0.8), (int(rng.integers(0, 5)), 3))
    heights = np.sort(rng.uniform(0.0, 2.5, (len(pillars), 2)), axis=1)
    walls, wall_heights = walls_of(rng, int(rng.integers(0, 6)))
    radius, height = rng.uniform(0.1, 0.5, count), rng.uniform(0.5, 2.0, count)
    scene = Scene(walls, wall_heights, radius, height, pillars, heights)
    xyv, direction, walked = crowd_of(seed, count)
    scene.update(None, xyv, rng.random(count) < 0.8, direction, walked)
    return scene
