"""BuiltRun: the objects of a robot's run, built once per recording."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Literal

from crowdbot.core.assistance.target import Target, lidars_of
from crowdbot.core.environments.build import build_environment
from crowdbot.core.planning.resolve import PlannerChoice, select_sensors
from crowdbot.core.recording.writer import EXACT
from crowdbot.core.registry.registry import Registry
from crowdbot.core.robots.build import build_robot
from crowdbot.core.robots.task import build_sensors, sensor_context
from crowdbot.core.robots.urdf_export import check_frames
from crowdbot.core.sensing.sensor import Sensor, SensorWithMemory
from crowdbot.core.types.environment import EnvironmentParts
from crowdbot.core.types.robot import RobotModel
from crowdbot.core.types.sensor import SensorInfo
from crowdbot.core.types.task import Task
from crowdbot.dsl.scenario.robot import Robot
from crowdbot.dsl.scenario.scenario import Scenario


@dataclass(frozen=True, slots=True, kw_only=True)
class BuiltRun:
    """Environment, robot and sensors of one recording.

    It belongs to that recording: sensors of plugins may keep state between readings, so a
    calibration run of the same scenario is built separately.

    Attributes:
        scenario: the scenario; ``name`` is that of its robot, ``robot`` its spec.
        parts: the environment.
        task: the robot's task, with its goal zone as a polygon.
        sensors: simulated sensors, by name. Their readings are independent of each other.
        infos: their descriptions, with their names as frames, except odometry.
        visible: names of the planner's sensors, in the robot's order.
        target: the person that the task is about, once the people are known; usually None.
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
    target: Target | None = None


def build_runs(
    scenario: Scenario,
    registry: Registry,
    choice: PlannerChoice,
    record: Literal["all", "used", "none"],
) -> dict[str, BuiltRun]:
    """Build the runs of all robots of a scenario, by name, with one environment.

    Args:
        scenario: with one robot or several.
        registry: the installed components.
        choice: the planners, one per robot.
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
    """Build the run of one robot of a scenario.

    Args:
        scenario: with one robot or several.
        registry: the installed components.
        choice: the planner, with the sensors that it needs.
        record: ``all`` simulates every sensor; otherwise the planner's, odometry and the
            driver's joystick.
        name: name of the robot; optional if there is only one.
        parts: the environment, if already built.

    Raises:
        InputError: the robot lacks a sensor that the planner needs, its control mode does not fit
            its drive, or a sensor has the name of another frame.
        PluginError: environment, robot or a sensor cannot be built.
    """
    if name is None:
        (name,) = scenario.robots
    robot = scenario.robots[name]
    parts = parts or build_environment(registry, scenario.environment)
    model = build_robot(registry, robot)
    context = sensor_context(robot, model, parts)
    sensors = build_sensors(registry, robot, context)
    infos = {n: _with_frame(n, sensor.info()) for n, sensor in sensors.items()}
    check_frames(model, infos)
    visible = select_sensors(choice.needs, infos, choice.name, privileged=choice.privileged)
    follows = robot.task.person is not None and robot.task.person.knows == "tracked"
    needed = {*visible, *(lidars_of(infos) if follows else ())}
    chosen = [
        n for n, info in infos.items() if record == "all" or n in needed or info.category in EXACT
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
    """Set a sensor's frame to its name, which the sensor does not know."""
    return info if info.category == "odometry" else replace(info, frame=name)
