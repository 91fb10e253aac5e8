"""BuiltRun: what the registry makes of a robot's run, built once for each recording."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Literal

from crowdbot.core.environments.build import build_environment
from crowdbot.core.planning.resolve import PlannerChoice, select_sensors
from crowdbot.core.registry.registry import Registry
from crowdbot.core.robots import build_robot
from crowdbot.core.robots.task import sensor_context
from crowdbot.core.robots.urdf_export import check_frames
from crowdbot.core.sensing.build import build_sensor
from crowdbot.core.sensing.sensor import Sensor, SensorWithMemory
from crowdbot.core.types.environment import EnvironmentParts
from crowdbot.core.types.robot import RobotModel
from crowdbot.core.types.sensor import SensorInfo
from crowdbot.core.types.task import Task
from crowdbot.dsl.scenario.scenario import Robot, Scenario


@dataclass(frozen=True, slots=True, kw_only=True)
class BuiltRun:
    """Environment, robot and sensors of one recording.

    It belongs to that recording: sensors of plugins may keep something between readings, and so a
    calibration run of the same scenario is built for itself.

    Attributes:
        scenario: what is run; ``name`` is that of its robot, ``robot`` its spec.
        parts: the environment.
        task: the robot's, with its goal zone as a polygon.
        sensors: those that are simulated, by name. Readings do not depend on which others are.
        infos: what they say of themselves, each with its own name as frame but odometry.
        visible: names of the sensors that the planner gets, in the robot's order.
    """

    scenario: Scenario
    name: str
    robot: Robot
    parts: EnvironmentParts
    model: RobotModel
    task: Task
    sensors: Mapping[str, Sensor | SensorWithMemory]
    infos: Mapping[str, SensorInfo]
    visible: tuple[str, ...]


def build_runs(
    scenario: Scenario,
    registry: Registry,
    choice: PlannerChoice,
    record: Literal["all", "used", "none"],
) -> dict[str, BuiltRun]:
    """Build what a recording of all robots of a scenario needs, by name; one environment for all.

    Args:
        scenario: with one robot or several.
        registry: the installed components.
        choice: the planners, one of each robot.
        record: as for `build_run`.

    Raises:
        InputError: as `build_run`.
        PluginError: as `build_run`.
    """
    parts = build_environment(registry, scenario.environment)
    return {
        name: build_run(scenario, registry, choice.of(name), record, name, parts)
        for name in scenario.robots
    }


def build_run(
    scenario: Scenario,
    registry: Registry,
    choice: PlannerChoice,
    record: Literal["all", "used", "none"],
    name: str | None = None,
    parts: EnvironmentParts | None = None,
) -> BuiltRun:
    """Build what a recording of a scenario's robot needs.

    Args:
        scenario: with one robot or several.
        registry: the installed components.
        choice: the planner, which says what sensors it needs.
        record: ``all`` simulates every sensor; otherwise those that the planner gets, and odometry.
        name: of the robot; may be left out where there is one only.
        parts: the environment, where it is built already.

    Raises:
        InputError: the robot lacks a sensor that the planner needs, its control mode does not fit
            its drive, or a sensor has the name of a frame that is not its own.
        PluginError: environment, robot or a sensor cannot be built.
    """
    if name is None:
        (name,) = scenario.robots
    robot = scenario.robots[name]
    parts = parts or build_environment(registry, scenario.environment)
    model = build_robot(registry, robot)
    context = sensor_context(robot, model, parts)
    sensors = {n: build_sensor(registry, x, context) for n, x in robot.sensors.items()}
    infos = {n: _with_frame(n, sensor.info()) for n, sensor in sensors.items()}
    check_frames(model, infos)
    visible = select_sensors(choice.needs, infos, choice.name, privileged=choice.privileged)
    chosen = [
        n
        for n, info in infos.items()
        if record == "all" or n in visible or info.category == "odometry"
    ]
    return BuiltRun(
        scenario=scenario,
        name=name,
        robot=robot,
        parts=parts,
        model=model,
        task=context.task,
        sensors={n: sensors[n] for n in chosen},
        infos={n: infos[n] for n in chosen},
        visible=visible,
    )


def _with_frame(name: str, info: SensorInfo) -> SensorInfo:
    """A sensor does not know its own name; its frame is called by it."""
    return info if info.category == "odometry" else replace(info, frame=name)
