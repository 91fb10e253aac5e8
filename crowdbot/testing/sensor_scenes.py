"""Scenes that sensors look at, a drive through them, and the robot that carries the sensors."""

from __future__ import annotations

import math

import numpy as np

from crowdbot.core.sensing.context import SensorContext
from crowdbot.core.sensing.scene import Scene
from crowdbot.core.types.motion import Pose
from crowdbot.core.types.robot import (
    DifferentialDrive,
    RobotLimits,
    RobotModel,
    RobotState,
    robot_body,
)
from crowdbot.core.types.sensor import SensorInfo
from crowdbot.core.types.task import Task

#: A robot that drives on an arc; x, y (m), yaw (rad), one per reading.
POSES = tuple(Pose(0.05 * k, 0.01 * k * k, 0.2 * k) for k in range(6))
_RADIUS, _HEIGHT = 0.25, 1.75
#: Largest distance of the centre of the person in front, m.
_FAR = 12.0

_ROBOT = RobotModel(
    description="",
    base="base",
    base_height=0.0102,
    drive=DifferentialDrive(
        left_joint="left", right_joint="right", command_radius=0.035, track=0.23
    ),
    limits=RobotLimits(v_min=0.0, v_max=1.0, w_max=1.0, a_max=1.0, alpha_max=1.0),
    footprint_radius=0.178,
    height=0.42,
    force_height=0.16,
    mass=6.3,
)
_GOAL = (8.0, 1.0)


def context() -> SensorContext:
    """Return a sensor context: a round robot with two wheels, and a task with its goal ahead."""
    corners = [[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]]
    task = Task(
        start=POSES[0],
        goal=_GOAL,
        goal_zone=np.add(corners, _GOAL),
        time_limit=60.0,
        robot=robot_body(_ROBOT),
    )
    return SensorContext(robot=_ROBOT, task=task)


def robot_at(k: int) -> RobotState:
    """Return the robot's state at reading k."""
    x, y, yaw = POSES[k]
    return RobotState(
        x=x, y=y, yaw=yaw, vx=0.4 * math.cos(yaw), vy=0.4 * math.sin(yaw), w=0.5,
        tilt=0.0, z=0.0102, left_angle=1.0 * k, right_angle=1.3 * k,
    )  # fmt: skip


def pose_of(k: int) -> Pose:
    """Return the pose of base_link at reading k."""
    return POSES[k]


def empty() -> Scene:
    """Return a scene with only the robot."""
    return _scene(np.zeros((0, 4)), np.zeros((0, 4)))


def crowded() -> Scene:
    """Return a scene with walls on all sides and people, one of them absent."""
    walls = np.array([[-4, -3, 6, -3], [6, -3, 6, 3], [6, 3, -4, 3], [-4, 3, -4, -3]], np.float64)
    people = np.array(
        [[1.5, 0.2, -0.5, 0.0], [2.5, -1.0, 0.0, 1.0], [-1.0, 1.5, 0.0, 0.0], [0.9, 0.9, 1.0, 0.0]]
    )
    return _scene(walls, people, present=np.array([True, True, True, False]))


def in_front(info: SensorInfo) -> dict[float, list[Scene]]:
    """Return scenes with one person ahead of the sensor, by distance (m): on its axis and beside.

    A narrow beam may pass between the legs; a bumper senses only contacts.
    """
    x, y, _, yaw = info.mount
    c, s = math.cos(yaw), math.sin(yaw)
    distances = np.concatenate([np.linspace(0.2, 1.0, 33), np.geomspace(1.1, _FAR, 10)])
    return {
        d: [_one(x + d * c - side * s, y + d * s + side * c) for side in (0.0, -0.12, 0.12)]
        for d in distances.tolist()
    }


def _one(x: float, y: float) -> Scene:
    return _scene(np.zeros((0, 4)), np.array([[x, y, -0.5, 0.0]]))


def _scene(
    walls: np.ndarray[tuple[int, ...], np.dtype[np.float64]],
    people: np.ndarray[tuple[int, ...], np.dtype[np.float64]],
    present: np.ndarray[tuple[int, ...], np.dtype[np.bool_]] | None = None,
) -> Scene:
    count = len(people)
    scene = Scene(walls, [0.0, 2.5], np.full(count, _RADIUS), np.full(count, _HEIGHT))
    here = np.ones(count, np.bool_) if present is None else present
    scene.update(robot_at(0), people, here)
    return scene
