"""A scenario resolved for many worlds: its place, its robots and their sensors."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from crowdbot.core.batch.array_tables import ArrayTable
from crowdbot.core.batch.robot_tables import robot_table
from crowdbot.core.batch.scanner_tables import SeenSensor
from crowdbot.core.crowd import CrowdEngine
from crowdbot.core.environments.build import build_environment
from crowdbot.core.population.realise import realise
from crowdbot.core.registry.registry import Registry
from crowdbot.core.robots.build import build_model
from crowdbot.core.robots.link_mount import at_link
from crowdbot.core.robots.task import build_sensors, sensor_context
from crowdbot.core.scenarios.lock import population
from crowdbot.core.sim.build_crowd import build_crowd
from crowdbot.core.support.ticks import ticks
from crowdbot.core.types.environment import EnvironmentParts
from crowdbot.core.types.robot import RobotModel
from crowdbot.core.types.task import Task
from crowdbot.dsl.scenario.scenario import Scenario
from crowdbot.errors import InputError

#: Categories of sensors that batches of worlds simulate, and kinds that are called otherwise.
DISTANCES = ("lidar", "lidar3d", "ultrasound", "infrared", "camera")
_CATEGORIES = {"lidar2d": "lidar", "rgbd_camera": "camera"}


@dataclass(frozen=True, slots=True, kw_only=True)
class Blueprint:
    """Parts of a world that do not depend on the draw of people.

    Attributes:
        scenario: its scenario.
        parts: its environment.
        names, models, tasks, tables: of its robots, in order.
        sensors: those that are simulated.
        period: ticks between two commands.
    """

    scenario: Scenario
    registry: Registry = field(repr=False)
    parts: EnvironmentParts = field(repr=False)
    names: tuple[str, ...]
    models: tuple[RobotModel, ...] = field(repr=False)
    tasks: tuple[Task, ...] = field(repr=False)
    tables: tuple[ArrayTable, ...] = field(repr=False)
    sensors: tuple[SeenSensor, ...] = field(repr=False)
    period: int

    def crowd(self, root: int | None) -> CrowdEngine | None:
        """Return the people of one draw; None without a crowd.

        Args:
            root: root of the random numbers of the draw; None: the people of the scenario, from
                its suite's lock if it has one.

        Raises:
            InputError: the people do not fit, or those of the suite are hidden.
        """
        scenario = self.scenario if root is None else with_root(self.scenario, root)
        if root is None:
            people = population(scenario, self.registry).agents
        else:
            people = realise(scenario, self.parts)
        return build_crowd(scenario, people, self.parts, self.registry)


def with_root(scenario: Scenario, root: int) -> Scenario:
    """Return a scenario whose people are drawn with another root seed."""
    crowd = scenario.crowd
    if crowd is None:
        return scenario
    seed = crowd.seed.model_copy(update={"root": root})
    return scenario.model_copy(update={"crowd": crowd.model_copy(update={"seed": seed})})


def blueprint(scenario: Scenario, registry: Registry, sensors: Sequence[str]) -> Blueprint:
    """Resolve a scenario.

    Args:
        sensors: names of the sensors that are simulated, or categories: the first one of each.

    Raises:
        InputError: there is no robot, a robot lacks a sensor, or batches cannot simulate it.
        PluginError: a component cannot be built.
    """
    if not scenario.robots:
        raise InputError(f"{scenario.id} has no robot, and an environment drives robots")
    for name, robot in scenario.robots.items():
        if robot.task.person is not None:
            raise InputError(
                f"{scenario.id}: the goal of robot '{name}' is a person, which environments of "
                "many worlds do not have; crowdbot.Session steps such a run"
            )
    parts = build_environment(registry, scenario.environment)
    models, tasks, tables, seen = [], [], [], []
    for k, (called, robot) in enumerate(scenario.robots.items()):
        model = build_model(registry, robot.model)
        context = sensor_context(robot, model, parts)
        models.append(model)
        tasks.append(context.task)
        tables.append(robot_table(model, parts, np.asarray(context.task.goal_zone)))
        sensor_names = _chosen(scenario, k, robot.sensors, sensors)
        built = build_sensors(registry, robot.model_copy(update={"sensors": sensor_names}), context)
        for name, sensor in built.items():
            spec: Any = at_link(sensor_names[name], model)
            own = SeenSensor(name=name, robot=k, spec=spec, info=sensor.info(), sensor=sensor)
            _check_distances(own, f"{scenario.id}: sensor '{name}' of robot '{called}'")
            seen.append(own)
    return Blueprint(
        scenario=scenario,
        registry=registry,
        parts=parts,
        names=tuple(scenario.robots),
        models=tuple(models),
        tasks=tuple(tasks),
        tables=tuple(tables),
        sensors=tuple(seen),
        period=ticks(scenario.rates.planner),
    )


def _chosen(scenario: Scenario, k: int, own: Any, names: Sequence[str]) -> dict[str, Any]:
    """Return the specs of the sensors that are wanted, by name or category.

    Raises:
        InputError: there is no such sensor.
    """
    robot, found = list(scenario.robots)[k], {}
    for name in names:
        fitting = {n: s for n, s in own.items() if name in (n, _category(s))}
        if not fitting:
            known = ", ".join(f"'{n}' ({_category(s)})" for n, s in own.items()) or "none"
            raise InputError(
                f"{scenario.id}: robot '{robot}' has no sensor '{name}'; it has {known}"
            )
        n = name if name in fitting else next(iter(fitting))
        found[n] = fitting[n]
    return found


def _category(spec: Any) -> str:
    return _CATEGORIES.get(spec.kind, str(spec.kind))


def _check_distances(seen: SeenSensor, where: str) -> None:
    """Check that a sensor measures distances, and keeps no state between readings.

    Raises:
        InputError: it does not.
    """
    info = seen.info
    if info.category not in DISTANCES or info.memory or info.privileged:
        raise InputError(
            f"{where} is of kind '{seen.spec.kind}'; batches of worlds simulate sensors of "
            f"distances without memory only ({', '.join(DISTANCES)})"
        )
    if info.camera is not None and info.camera.colour:
        raise InputError(f"{where} takes colour images, which batches of worlds do not draw")
