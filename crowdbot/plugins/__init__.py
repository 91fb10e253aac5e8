"""crowdbot's own components, registered through the entry point ``builtin``.

They have the same rights as anybody's: what a third party cannot do, these cannot do either.
Only what no scenario holds, metrics and planners, is imported when it is first asked for.
"""

from __future__ import annotations

from collections.abc import Sequence
from importlib.resources.abc import Traversable
from pathlib import Path

from crowdbot.hookspecs import API_VERSION, hookimpl
from crowdbot.plugin import (
    Component,
    CostFunctionSpec,
    CrowdPolicySpec,
    EnvironmentSpec,
    MetricSpec,
    NoiseSpec,
    PlannerSpec,
    RobotSpec,
    SensorSpec,
)
from crowdbot.plugins import crowd, environments, noise, robots, sensors

CROWDBOT_API = API_VERSION


@hookimpl
def crowdbot_environments() -> Sequence[Component[EnvironmentSpec]]:
    """Places."""
    return environments.COMPONENTS


@hookimpl
def crowdbot_robots() -> Sequence[Component[RobotSpec]]:
    """Robots."""
    return robots.COMPONENTS


@hookimpl
def crowdbot_sensors() -> Sequence[Component[SensorSpec]]:
    """Sensors."""
    return sensors.COMPONENTS


@hookimpl
def crowdbot_noise_generators() -> Sequence[Component[NoiseSpec]]:
    """Errors of sensors."""
    return noise.COMPONENTS


@hookimpl
def crowdbot_planners() -> Sequence[Component[PlannerSpec]]:
    """Planners."""
    from crowdbot.plugins import planners

    return planners.COMPONENTS


@hookimpl
def crowdbot_crowd_policies() -> Sequence[Component[CrowdPolicySpec]]:
    """Crowd policies."""
    return crowd.POLICIES


@hookimpl
def crowdbot_cost_functions() -> Sequence[Component[CostFunctionSpec]]:
    """Cost functions."""
    return crowd.COSTS


@hookimpl
def crowdbot_metrics() -> Sequence[Component[MetricSpec]]:
    """Metrics."""
    from crowdbot.plugins import metrics

    return metrics.COMPONENTS


@hookimpl
def crowdbot_scenario_dirs() -> Sequence[Traversable]:
    """The suites: beside the package in a checkout, inside it in a wheel."""
    package = Path(__file__).parent.parent
    installed = package / "scenario_specs"
    return [installed if installed.is_dir() else package.parent / "scenario_specs"]
