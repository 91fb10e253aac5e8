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

    from crowdbot.core.component import Component
    from crowdbot.dsl.base import (
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
    """Return the environments this package provides."""


@hookspec
def crowdbot_robots() -> Sequence[Component[RobotSpec]]:  # type: ignore[empty-body]
    """Return the robots this package provides."""


@hookspec
def crowdbot_sensors() -> Sequence[Component[SensorSpec]]:  # type: ignore[empty-body]
    """Return the sensors this package provides."""


@hookspec
def crowdbot_noise_generators() -> Sequence[Component[NoiseSpec]]:  # type: ignore[empty-body]
    """Return the noise generators of sensors this package provides."""


@hookspec
def crowdbot_planners() -> Sequence[Component[PlannerSpec]]:  # type: ignore[empty-body]
    """Return the planners this package provides."""


@hookspec
def crowdbot_crowd_policies() -> Sequence[Component[CrowdPolicySpec]]:  # type: ignore[empty-body]
    """Return the crowd policies this package provides."""


@hookspec
def crowdbot_cost_functions() -> Sequence[Component[CostFunctionSpec]]:  # type: ignore[empty-body]
    """Return the cost functions this package provides."""


@hookspec
def crowdbot_metrics() -> Sequence[Component[MetricSpec]]:  # type: ignore[empty-body]
    """Return the metrics this package provides."""


@hookspec
def crowdbot_scenario_dirs() -> Sequence[Traversable]:  # type: ignore[empty-body]
    """Return folders with suites, found as ``plugin:suite``."""
