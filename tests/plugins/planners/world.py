"""A small test world: a kinematic robot, two real lidars, discs that walk straight on.

People do not avoid anybody; a run records contacts as (time, person) at the moment the discs
first overlap, and the least gap to people and walls.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike, NDArray

from crowdbot.core.sensing.noise import sensor_rng
from crowdbot.core.sensing.scene import Scene
from crowdbot.plugin import (
    Command,
    Observation,
    Planner,
    Pose,
    Reading,
    RobotLimits,
    RobotState,
    Task,
    TiltableMount,
    Truth,
)
from crowdbot.plugins.sensors.lidar2d import Lidar2dSpec
from crowdbot.plugins.sensors.lidar2d_build import Lidar2d

Array = NDArray[np.float64]

LIMITS = RobotLimits(v_min=-0.65, v_max=0.65, w_max=3.14, a_max=1.0, alpha_max=2.0)
RADIUS, PERSON = 0.178, 0.33
START = Pose(2.5, 0.0, 0.0)
LENGTH, HALF_WIDTH = 50.0, 5.0
CORRIDOR = np.array(
    [
        [-1.0, -HALF_WIDTH, 51.0, -HALF_WIDTH],
        [-1.0, HALF_WIDTH, 51.0, HALF_WIDTH],
        [0.0, -HALF_WIDTH, 0.0, HALF_WIDTH],
        [LENGTH, -HALF_WIDTH, LENGTH, HALF_WIDTH],
    ]
)
GOAL_ZONE = np.array([[45.0, -5.0], [50.0, -5.0], [50.0, 5.0], [45.0, 5.0]])
DT, PER_STEP = 1.0 / 128.0, 8


def lidars() -> dict[str, Lidar2d]:
    """The two of the challenge's robot."""
    return {
        "front_lidar": Lidar2d(Lidar2dSpec(mount=TiltableMount(x=0.17, z=0.24))),
        "rear_lidar": Lidar2d(Lidar2dSpec(mount=TiltableMount(x=-0.17, z=0.24, yaw=math.pi))),
    }


@dataclass
class Outcome:
    """What a run left behind."""

    arrived: bool = False
    t: float = 0.0
    path: list[Pose] = field(default_factory=list)
    commands: list[Command] = field(default_factory=list)
    contacts: list[tuple[float, int]] = field(default_factory=list)
    least_gap: float = math.inf
    least_wall_gap: float = math.inf
    logged: dict[str, list[float]] = field(default_factory=dict)


def crowd(seed: int, count: int, speeds: tuple[float, float], flow: Sequence[int]) -> Array:
    """(M, 4) people spread over x in [5, 45] without overlap, walking along x."""
    rng = np.random.default_rng(seed)
    placed: list[tuple[float, float]] = []
    while len(placed) < count:
        x, y = rng.uniform(5.0, 45.0), rng.uniform(-4.6, 4.6)
        if all(math.dist((x, y), p) > 2 * PERSON for p in placed):
            placed.append((x, y))
    way = np.array([flow[i % len(flow)] for i in range(count)], dtype=np.float64)
    vx = way * rng.uniform(*speeds, count)
    return np.column_stack([np.array(placed), vx, np.zeros(count)])


class World:
    """One robot among people (M, 4) between walls (S, 4)."""

    def __init__(
        self,
        people: ArrayLike = (),
        start: Pose = START,
        goal: tuple[float, float] = (47.5, 0.0),
        walls: Array = CORRIDOR,
        seed: int = 0,
        *,
        truth: bool = False,
    ) -> None:
        """Make the world; a planner is given the ``truth`` if it is to see people as they are."""
        self.sees_truth = truth
        self.people = np.array(people, dtype=np.float64).reshape(-1, 4)
        self.present = np.ones(len(self.people), dtype=np.bool_)
        self.scene = Scene(walls, [0.0, 2.5], np.full(len(self.people), PERSON), 1.7)
        self.pose, self.twist = start, (0.0, 0.0)
        self.task = Task(start=start, goal=goal, goal_zone=GOAL_ZONE, time_limit=180.0)
        self.sensors = lidars()
        self.seed, self.tick = seed, 0
        self.outcome = Outcome()
        self._touching: set[int] = set()

    def run(self, planner: Planner, time_limit: float = 180.0, stop_at: float = 45.0) -> Outcome:
        """Until x reaches ``stop_at`` or time is over."""
        planner.reset(self.task, LIMITS, {n: s.info() for n, s in self.sensors.items()}, 0)
        while self.outcome.t < time_limit and not self.outcome.arrived:
            command = planner.step(self._observe())
            self.outcome.commands.append(command)
            for _ in range(PER_STEP):
                self._advance(command)
            self.outcome.arrived = self.pose.x >= stop_at
        return self.outcome

    def _observe(self) -> Observation:
        t = self.tick * DT
        state = RobotState(*self.pose, 0.0, 0.0, 0.0, 0.0, 0.0102, 0.0, 0.0)
        self.scene.update(state, self.people, self.present)
        readings: Mapping[str, Reading] = {
            name: Reading(
                t,
                sensor.read(
                    self.scene, self.pose, t, sensor_rng(self.seed, "robot", name, self.tick)
                ),
            )
            for name, sensor in self.sensors.items()
        }
        return Observation(
            t=t,
            pose=self.pose,
            twist=self.twist,
            goal=self.task.goal,
            goal_zone=GOAL_ZONE,
            readings=readings,
            log=lambda name, value: self.outcome.logged.setdefault(name, []).append(value),
            truth=self._truth() if self.sees_truth else None,
        )

    def _truth(self) -> Truth:
        v, w = self.twist
        return Truth(
            pose=self.pose,
            velocity=(v * math.cos(self.pose.yaw), v * math.sin(self.pose.yaw), w),
            people=self.people[:, :2].copy(),
            people_velocity=self.people[:, 2:].copy(),
            people_radius=np.full(len(self.people), PERSON),
            people_id=np.arange(len(self.people)),
        )

    def _advance(self, command: Command) -> None:
        v, w = self.twist
        v += max(-LIMITS.a_max * DT, min(LIMITS.a_max * DT, command.v - v))
        w += max(-LIMITS.alpha_max * DT, min(LIMITS.alpha_max * DT, command.w - w))
        x, y, yaw = self.pose
        middle = yaw + w * DT / 2.0
        self.pose = Pose(x + v * DT * math.cos(middle), y + v * DT * math.sin(middle), yaw + w * DT)
        self.twist = (v, w)
        self.people[:, :2] += self.people[:, 2:] * DT
        self.people[:, 0] = np.mod(self.people[:, 0] + 1.0, LENGTH + 2.0) - 1.0
        self.tick += 1
        self._judge()

    def _judge(self) -> None:
        out, (x, y, _) = self.outcome, self.pose
        out.t = self.tick * DT
        out.path.append(self.pose)
        gap = np.hypot(self.people[:, 0] - x, self.people[:, 1] - y) - RADIUS - PERSON
        touching = set(np.flatnonzero(gap < 0.0).tolist())
        out.contacts += [(out.t, person) for person in touching - self._touching]
        self._touching = touching
        out.least_gap = min(out.least_gap, float(gap.min(initial=math.inf)))
        for x0, y0, x1, y1 in self.scene.walls:
            square = (x1 - x0) ** 2 + (y1 - y0) ** 2
            s = min(1.0, max(0.0, ((x - x0) * (x1 - x0) + (y - y0) * (y1 - y0)) / square))
            wall = math.hypot(x - x0 - s * (x1 - x0), y - y0 - s * (y1 - y0)) - RADIUS
            out.least_wall_gap = min(out.least_wall_gap, wall)
