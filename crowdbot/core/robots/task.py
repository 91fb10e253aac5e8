"""A robot's task and the context of its sensors, from its scenario."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from crowdbot.core.environments.build import build_environment
from crowdbot.core.registry.registry import Registry
from crowdbot.core.robots.build import build_model
from crowdbot.core.robots.link_mount import at_link
from crowdbot.core.sensing.build import build_sensor
from crowdbot.core.sensing.context import SensorContext
from crowdbot.core.sensing.sensor import Sensor, SensorWithMemory
from crowdbot.core.types.environment import EnvironmentParts
from crowdbot.core.types.motion import Pose
from crowdbot.core.types.robot import RobotModel, robot_body
from crowdbot.core.types.sensor import SensorInfo
from crowdbot.core.types.task import Task
from crowdbot.dsl.scenario.robot import Robot
from crowdbot.dsl.scenario.scenario import Scenario

#: Corners of a zone at the robot's start, m.
_HERE = np.array([(-0.1, -0.1), (0.1, -0.1), (0.1, 0.1), (-0.1, 0.1)])


def robot_task(robot: Robot, parts: EnvironmentParts) -> Task:
    """Return the robot's task with its goal zone as a polygon.

    A goal that is a person has a place only when the people are known
    (`crowdbot.core.assistance.guide.task_with_person`); until then it is the robot's start.
    """
    if robot.task.zone is None:
        zone = np.add(_HERE, robot.task.start[:2])
    else:
        zone = parts.zones[robot.task.zone]
    centre = zone.mean(axis=0)
    return Task(
        start=Pose(*robot.task.start),
        goal=(float(centre[0]), float(centre[1])),
        goal_zone=zone,
        time_limit=robot.task.time_limit,
    )


def sensor_context(robot: Robot, model: RobotModel, parts: EnvironmentParts) -> SensorContext:
    """Return the context for building a robot's sensors: the robot, and the task with its body."""
    return SensorContext(
        robot=model, task=replace(robot_task(robot, parts), robot=robot_body(model))
    )


def sensor_infos(registry: Registry, scenario: Scenario, name: str) -> dict[str, SensorInfo]:
    """Return the descriptions of a robot's sensors, by the sensors' names.

    Raises:
        PluginError: environment, robot or a sensor cannot be built.
    """
    robot, parts = scenario.robots[name], build_environment(registry, scenario.environment)
    context = sensor_context(robot, build_model(registry, robot.model), parts)
    return {n: s.info() for n, s in build_sensors(registry, robot, context).items()}


def build_sensors(
    registry: Registry, robot: Robot, context: SensorContext
) -> dict[str, Sensor | SensorWithMemory]:
    """Return a robot's sensors by name, those on links at the places of their links.

    Raises:
        InputError: a link or an error does not fit its sensor.
        PluginError: a sensor cannot be built, or there is no such link.
    """
    return {
        name: build_sensor(registry, at_link(spec, context.robot), context)
        for name, spec in robot.sensors.items()
    }
