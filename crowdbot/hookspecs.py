"""The hooks of crowdbot, nothing else.

Each is called once, while the registry is built, before any scenario is read. Keep them cheap:
import spec modules only and name the build function as text. An exception disables the plugin
that raised it, no other, and is shown by ``crowdbot plugins``.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import pluggy

if TYPE_CHECKING:
    from importlib.resources.abc import Traversable

    from crowdbot.dsl.spec.component import Component
    from crowdbot.dsl.spec.component_specs import (
        CostFunctionSpec,
        CrowdPolicySpec,
        EnvironmentSpec,
        MetricSpec,
        NoiseSpec,
        PlannerSpec,
        RobotSpec,
        SensorSpec,
    )

#: Version of this file. A plugin module says ``CROWDBOT_API = 1``.
API_VERSION = 1
#: The oldest version that this crowdbot still speaks.
OLDEST_API = 1

hookspec = pluggy.HookspecMarker("crowdbot")
hookimpl = pluggy.HookimplMarker("crowdbot")


@hookspec
def crowdbot_environments() -> Sequence[Component[EnvironmentSpec]]:  # type: ignore[empty-body]
    """Return the places this package provides.

    Places: floors with walls, blocks, pillars, zones, portals, borders.

    Called once, while the registry is built, before any document is read. The components are
    built later, once for each recording:
    `crowdbot.plugin.BuildEnvironment`.

    Returns:
        A list or tuple; each ``spec.kind`` is ``"NAME.something"``, NAME being that of the entry
        point. An exception, or anything else, disables this plugin alone.

    Example::

        @hookimpl
        def crowdbot_environments():
            return [AISLES]
    """


@hookspec
def crowdbot_robots() -> Sequence[Component[RobotSpec]]:  # type: ignore[empty-body]
    """Return the robots this package provides.

    Bodies, drives and limits.

    Called once, while the registry is built, before any document is read. The components are
    built later, once for each recording:
    `crowdbot.plugin.BuildRobot`.

    Returns:
        A list or tuple; each ``spec.kind`` is ``"NAME.something"``, NAME being that of the entry
        point. An exception, or anything else, disables this plugin alone.

    Example::

        @hookimpl
        def crowdbot_robots():
            return [OMNI]
    """


@hookspec
def crowdbot_sensors() -> Sequence[Component[SensorSpec]]:  # type: ignore[empty-body]
    """Return the sensors this package provides.

    What robots carry to see, feel and count their wheels.

    Called once, while the registry is built, before any document is read. The components are
    built later, when a run is prepared, and where they are simulated:
    `crowdbot.plugin.BuildSensor`.

    Returns:
        A list or tuple; each ``spec.kind`` is ``"NAME.something"``, NAME being that of the entry
        point. An exception, or anything else, disables this plugin alone.

    Example::

        @hookimpl
        def crowdbot_sensors():
            return [SONAR]
    """


@hookspec
def crowdbot_noise_generators() -> Sequence[Component[NoiseSpec]]:  # type: ignore[empty-body]
    """Return the noise generators this package provides.

    Errors of sensors, for the map ``noise`` of every sensor that measures distances.

    Called once, while the registry is built, before any document is read. The components are
    built later, before their sensor, in the order of their names:
    `crowdbot.plugin.BuildNoise`.

    Returns:
        A list or tuple; each ``spec.kind`` is ``"NAME.something"``, NAME being that of the entry
        point. An exception, or anything else, disables this plugin alone.

    Example::

        @hookimpl
        def crowdbot_noise_generators():
            return [DRIFT]
    """


@hookspec
def crowdbot_planners() -> Sequence[Component[PlannerSpec]]:  # type: ignore[empty-body]
    """Return the planners this package provides.

    The things under test. Never part of a scenario.

    Called once, while the registry is built, before any document is read. The components are
    built later, once for each recording with a robot, also for the one without people:
    `crowdbot.plugin.BuildPlanner`.

    Returns:
        A list or tuple; each ``spec.kind`` is ``"NAME.something"``, NAME being that of the entry
        point. An exception, or anything else, disables this plugin alone.

    Example::

        @hookimpl
        def crowdbot_planners():
            return [SWERVE]
    """


@hookspec
def crowdbot_crowd_policies() -> Sequence[Component[CrowdPolicySpec]]:  # type: ignore[empty-body]
    """Return the crowd policies this package provides.

    How people decide where to walk.

    Called once, while the registry is built, before any document is read. The components are
    built later, once for each recording with people:
    `crowdbot.plugin.BuildPolicy`.

    Returns:
        A list or tuple; each ``spec.kind`` is ``"NAME.something"``, NAME being that of the entry
        point. An exception, or anything else, disables this plugin alone.

    Example::

        @hookimpl
        def crowdbot_crowd_policies():
            return [SWARM]
    """


@hookspec
def crowdbot_cost_functions() -> Sequence[Component[CostFunctionSpec]]:  # type: ignore[empty-body]
    """Return the cost functions this package provides.

    Costs over velocities, which a velocity-space policy minimises.

    Called once, while the registry is built, before any document is read. The components are
    built later, before the policy that minimises them:
    `crowdbot.plugin.BuildCost`.

    Returns:
        A list or tuple; each ``spec.kind`` is ``"NAME.something"``, NAME being that of the entry
        point. An exception, or anything else, disables this plugin alone.

    Example::

        @hookimpl
        def crowdbot_cost_functions():
            return [PATIENCE]
    """


@hookspec
def crowdbot_metrics() -> Sequence[Component[MetricSpec]]:  # type: ignore[empty-body]
    """Return the metrics this package provides.

    Functions of what was recorded; each is made by ``declare_metric`` and has a card.

    Called once, while the registry is built, before any document is read. The components are
    built later, once for each scoring:
    `crowdbot.plugin.BuildMetric`.

    Returns:
        A list or tuple; each ``spec.kind`` is ``"NAME.something"``, NAME being that of the entry
        point. An exception, or anything else, disables this plugin alone.

    Example::

        @hookimpl
        def crowdbot_metrics():
            return [COMFORT]
    """


@hookspec
def crowdbot_scenario_dirs() -> Sequence[Traversable]:  # type: ignore[empty-body]
    """Return folders with suites: ``office.yaml`` of the plugin ``acme`` is ``acme:office``.

    Called once, while the registry is built. Folders are looked into when a document is named
    that is not a path, or extends ``NAME:...``; they may lie in an archive.

    Returns:
        A list or tuple of folders. Parts that others extend go into a folder inside.

    Example::

        @hookimpl
        def crowdbot_scenario_dirs():
            return [importlib.resources.files(__name__) / "suites"]
    """
