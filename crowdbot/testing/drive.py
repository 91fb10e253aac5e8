"""A planner drives an ideal robot in a room, without a simulator.

The robot moves on exact arcs within its limits and ignores obstacles; sensors are real.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, cast
from unittest import SkipTest

import numpy as np

from crowdbot.core.planning.drawn import Drawn
from crowdbot.core.planning.host import PlannerHost
from crowdbot.core.planning.planner import Observation, Planner, Truth, named_drawing, named_signal
from crowdbot.core.registry.registry import Registry
from crowdbot.core.sensing.build import build_sensor
from crowdbot.core.sensing.noise import sensor_rng
from crowdbot.core.sensing.scene import Scene
from crowdbot.core.types.arrays import Array
from crowdbot.core.types.motion import Command, Pose
from crowdbot.core.types.robot import RobotLimits, RobotState
from crowdbot.core.types.sensor import Reading, SensorInfo
from crowdbot.core.types.task import Task
from crowdbot.dsl.spec.component_specs import SensorSpec
from crowdbot.testing.sensor_scenes import context

RATE = 16.0  # steps per second
LIMITS = RobotLimits(v_min=-0.65, v_max=0.65, w_max=3.14, a_max=1.0, alpha_max=2.0)
SLOW = RobotLimits(v_min=0.0, v_max=0.2, w_max=0.5, a_max=0.3, alpha_max=0.5)
_ORIGIN = Pose(0.0, 0.0, 0.0)
_ROOM = [[-2, -3, 10, -3], [10, -3, 10, 3], [10, 3, -2, 3], [-2, 3, -2, -3]]
_CELL = [[6, -1, 8, -1], [8, -1, 8, 1], [8, 1, 6, 1], [6, 1, 6, -1]]
_RADIUS = 0.25  # radius of people, m
#: x, y, vx, vy of people who walk through walls and robots.
_PEOPLE = np.array([[3.0, 1.0, -0.5, -0.2], [5.0, -1.5, 0.0, 0.4], [6.0, 0.4, -1.0, 0.0]])


@dataclass(frozen=True, slots=True, kw_only=True)
class Course:
    """The situation for a planner.

    Attributes:
        start: pose at t = 0.
        goal: centre of the goal zone, m.
        walls: (S, 4), m.
        people: (M, 4) x, y, vx, vy at t = 0.
        limits: the robot's limits.
    """

    start: Pose = _ORIGIN
    goal: tuple[float, float] = (7.0, 0.0)
    walls: Sequence[Sequence[float]] = ()
    people: Array = field(default_factory=lambda: _PEOPLE)
    limits: RobotLimits = LIMITS

    @property
    def task(self) -> Task:
        """Return the task: its start, and a goal zone of 1 m x 1 m."""
        x, y = self.goal
        half = 0.5
        zone = np.array([[x - half, y - half], [x + half, y - half],
                         [x + half, y + half], [x - half, y + half]])  # fmt: skip
        return Task(start=self.start, goal=self.goal, goal_zone=zone, time_limit=60.0)


COURSES: Mapping[str, Course] = {
    "people in a room": Course(walls=_ROOM),
    "an empty world": Course(people=_PEOPLE[:0]),
    "a goal behind the robot": Course(start=Pose(0.0, 0.0, math.pi), walls=_ROOM),
    "a slow robot": Course(walls=_ROOM, limits=SLOW),
}
UNREACHABLE = Course(walls=[*_ROOM, *_CELL], start=Pose(4.0, 0.0, 0.0), people=_PEOPLE[:0])
AT_GOAL = Course(start=Pose(7.0, 0.0, 1.0), walls=_ROOM, people=_PEOPLE[:0])


def sensors_for(needs: Sequence[str] | None, registry: Registry) -> dict[str, Any]:
    """Return need -> an installed sensor of this kind or category.

    If ``needs`` is None, a lidar. Odometry is left out: it is always the robot's true pose.

    Raises:
        SkipTest: no installed sensor has the kind or category of a need.
    """
    sensors = {}
    for need in ("lidar",) if needs is None else needs:
        if need == "odometry":
            continue
        made = _answering(need, registry)
        if made is None:
            raise SkipTest(f"no sensor is installed whose kind or category is '{need}'")
        sensors[need] = made
    return sensors


def _answering(need: str, registry: Registry) -> Any:
    kinds = registry.components("sensor")
    for component in sorted(kinds.values(), key=lambda c: c.kind != need):
        model = registry.spec_model("sensor", component.kind)
        spec = model.model_validate({"kind": component.kind, **component.examples[0]})
        sensor = build_sensor(registry, cast(SensorSpec, spec), context())
        if need in (component.kind, sensor.info().category):
            return sensor
    return None


class Driven:
    """A planner called by its host, on a course; a privileged planner gets the ground truth.

    Attributes:
        host: calls the planner; checks and clamps its commands, and counts them.
        commands: all commands so far.
    """

    def __init__(
        self,
        planner: Planner,
        name: str,
        course: Course,
        sensors: Mapping[str, Any],
        *,
        privileged: bool = False,
    ) -> None:
        self.host = PlannerHost(planner, name, course.limits)
        self._privileged = privileged
        self.commands: list[Command] = []
        self.signals: list[tuple[str, float]] = []
        self.drawings: list[Drawn] = []
        self._course, self._sensors = course, dict(sensors)
        count = len(course.people)
        self._scene = Scene(
            np.array(course.walls, np.float64).reshape(-1, 4), [0.0, 2.5],
            np.full(count, _RADIUS), np.full(count, 1.7),
        )  # fmt: skip

    def run(self, steps: int, seed: int = 1) -> list[Command]:
        """Reset the planner and drive this many steps.

        Raises:
            PlannerError: the planner raised, or returned an invalid command.
        """
        infos = {n: replace(s.info(), frame=n) for n, s in self._sensors.items()}
        memory = {n: np.zeros(i.memory) for n, i in infos.items()}
        self.host.reset(self._course.task, infos, seed)
        self.commands, self.signals, self.drawings = [], [], []
        pose, twist = self._course.start, Command(0.0, 0.0)
        readings: dict[str, Reading] = {}
        for k in range(steps):
            self._show(k / RATE, pose, twist)
            self._read(k, pose, infos, memory, readings)
            command = self.host.step(self._observation(k, pose, twist, readings)).command
            self.commands.append(command)
            twist = _slewed(twist, command, self._course.limits)
            pose = _after(pose, twist)
        return self.commands

    def _people(self, t: float) -> Array:
        people = self._course.people.copy()
        people[:, :2] += t * people[:, 2:]
        return people

    def _show(self, t: float, pose: Pose, twist: Command) -> None:
        people = self._people(t)
        c, s = math.cos(pose.yaw), math.sin(pose.yaw)
        robot = RobotState(
            pose.x, pose.y, pose.yaw, c * twist.v - s * twist.vy, s * twist.v + c * twist.vy,
            twist.w, 0.0, 0.0, 0.0, 0.0,
        )  # fmt: skip
        self._scene.update(robot, people, np.ones(len(people), np.bool_))

    def _read(
        self,
        k: int,
        pose: Pose,
        infos: Mapping[str, SensorInfo],
        memory: Mapping[str, Array],
        readings: dict[str, Reading],
    ) -> None:
        for name, sensor in self._sensors.items():
            if int(k * infos[name].rate / RATE) != int((k - 1) * infos[name].rate / RATE):
                rng = sensor_rng(0, "robot", name, k)
                extra = (memory[name],) if infos[name].memory else ()
                values = np.asarray(sensor.read(self._scene, pose, k / RATE, rng, *extra))
                readings[name] = Reading(k / RATE, values)

    def _observation(
        self, k: int, pose: Pose, twist: Command, readings: Mapping[str, Reading]
    ) -> Observation:
        task = self._course.task
        return Observation(
            t=k / RATE,
            pose=pose,
            twist=(twist.v, twist.w),
            vy=twist.vy,
            goal=task.goal,
            goal_zone=task.goal_zone,
            readings=dict(readings),
            log=lambda name, value: self.signals.append(named_signal(name, value)),
            draw=lambda name, rows, text=None: self.drawings.append(
                named_drawing(name, rows, text)
            ),
            truth=self._truth(k / RATE, pose, twist) if self._privileged else None,
        )

    def _truth(self, t: float, pose: Pose, twist: Command) -> Truth:
        people, (c, s) = self._people(t), (math.cos(pose.yaw), math.sin(pose.yaw))
        return Truth(
            pose=pose,
            velocity=(c * twist.v - s * twist.vy, s * twist.v + c * twist.vy, twist.w),
            people=people[:, :2],
            people_velocity=people[:, 2:],
            people_radius=np.full(len(people), _RADIUS),
            people_id=np.arange(len(people)),
        )


def _slewed(now: Command, target: Command, limits: RobotLimits) -> Command:
    def step(a: float, b: float, most: float) -> float:
        return a + min(most / RATE, max(-most / RATE, b - a))

    return Command(
        step(now.v, target.v, limits.a_max),
        step(now.w, target.w, limits.alpha_max),
        step(now.vy, target.vy, limits.a_max),
    )


def _after(pose: Pose, twist: Command) -> Pose:
    """Return the pose one step later."""
    yaw = pose.yaw + 0.5 * twist.w / RATE
    c, s = math.cos(yaw), math.sin(yaw)
    return Pose(
        pose.x + (c * twist.v - s * twist.vy) / RATE,
        pose.y + (s * twist.v + c * twist.vy) / RATE,
        math.remainder(pose.yaw + twist.w / RATE, 2.0 * math.pi),
    )
