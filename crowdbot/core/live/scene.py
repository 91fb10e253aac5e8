"""Constant data of a live run: frames, map, the robot's description, goal, task."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from crowdbot.core.live.message import LiveMessage, live_message
from crowdbot.core.recording import markers, scenery
from crowdbot.core.recording import messages as ros
from crowdbot.core.recording.header import (
    RecordingHeader,
    RobotHeader,
    limit_numbers,
    sensor_message,
    with_frames,
)
from crowdbot.core.recording.topics import Topic
from crowdbot.core.robots.urdf_export import to_urdf
from crowdbot.core.types.environment import EnvironmentParts
from crowdbot.core.types.robot import RobotLimits, RobotModel
from crowdbot.core.types.sensor import SensorInfo
from crowdbot.core.types.task import Task


@dataclass(frozen=True, kw_only=True)
class LiveScene:
    """Place and robot of a live run.

    Attributes:
        name: name of the robot.
        namespace: prefix of its topics and frames; empty for the only robot.
        sensors: sensors of the planner.
    """

    scenario: str
    name: str
    parts: EnvironmentParts
    model: RobotModel
    sensors: Mapping[str, SensorInfo]
    namespace: str = ""


def latched(scene: LiveScene, task: Task, seed: int, ns: int) -> list[LiveMessage]:
    """Return all constant messages, stamped ``ns``."""
    header, description = _header(scene, task), to_urdf(scene.model, scene.sensors, scene.name)
    found = [
        (Topic.TF_STATIC, ros.transforms(scenery.static_frames(header, description))),
        (Topic.GOAL, markers.polygon(ns, task.goal_zone)),
        (Topic.GOAL_POSE, scenery.goal_pose(ns, header)),
        ("/robot_description", ros.new("std_msgs/String", data=description)),
        ("/crowdbot/task", _task(scene, task, scene.model.limits, seed)),
    ]
    walls = scene.parts.walls
    if len(walls):
        found.append((Topic.WALLS, scenery.wall_lines(walls)))
        found.append((Topic.MAP, scenery.occupancy_grid(ns, walls, goal=task.goal)))
    return [live_message(str(topic), ns, message, latched=True) for topic, message in found]


def _header(scene: LiveScene, task: Task) -> RecordingHeader:
    robot = RobotHeader.of(scene.model, task.goal)
    return with_frames(
        RecordingHeader(
            scenario=scene.scenario, robot=robot, sensors=scene.sensors, namespace=scene.namespace
        )
    )


def _task(scene: LiveScene, task: Task, limits: RobotLimits, seed: int) -> object:
    return ros.new(
        "crowdbot_msgs/Task",
        scenario=scene.scenario,
        seed=seed,
        start=np.array(task.start, np.float64),
        goal=np.array(task.goal, np.float64),
        goal_zone=ros.table(task.goal_zone),
        time_limit=task.time_limit,
        limits=ros.table(limit_numbers(limits)),
        sensors=[sensor_message(name, info) for name, info in scene.sensors.items()],
    )
