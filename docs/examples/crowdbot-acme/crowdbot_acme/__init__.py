"""One of everything that crowdbot can be extended with. Words only: nothing heavy is imported."""

from __future__ import annotations

from collections.abc import Sequence
from importlib.resources import files
from importlib.resources.abc import Traversable

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
    hookimpl,
)

from crowdbot_acme.cart import CART
from crowdbot_acme.drift import DRIFT
from crowdbot_acme.glider import GLIDER
from crowdbot_acme.hesitation import HESITATION
from crowdbot_acme.office import OFFICE
from crowdbot_acme.outside import OUTSIDE
from crowdbot_acme.personal_space import PERSONAL_SPACE, PERSONAL_SPACE_NUMPY
from crowdbot_acme.radar import RADAR
from crowdbot_acme.speckle import SPECKLE
from crowdbot_acme.swerve import SWERVE

CROWDBOT_API = 1

COMPONENTS = (
    CART,
    DRIFT,
    GLIDER,
    HESITATION,
    OFFICE,
    OUTSIDE,
    PERSONAL_SPACE,
    PERSONAL_SPACE_NUMPY,
    RADAR,
    SPECKLE,
    SWERVE,
)


@hookimpl
def crowdbot_environments() -> Sequence[Component[EnvironmentSpec]]:
    """Places."""
    return [OFFICE]


@hookimpl
def crowdbot_robots() -> Sequence[Component[RobotSpec]]:
    """Robots."""
    return [CART, GLIDER]


@hookimpl
def crowdbot_sensors() -> Sequence[Component[SensorSpec]]:
    """Sensors."""
    return [RADAR]


@hookimpl
def crowdbot_noise_generators() -> Sequence[Component[NoiseSpec]]:
    """Errors of sensors."""
    return [SPECKLE]


@hookimpl
def crowdbot_planners() -> Sequence[Component[PlannerSpec]]:
    """Planners."""
    return [SWERVE, OUTSIDE]


@hookimpl
def crowdbot_crowd_policies() -> Sequence[Component[CrowdPolicySpec]]:
    """Crowd policies."""
    return [DRIFT]


@hookimpl
def crowdbot_cost_functions() -> Sequence[Component[CostFunctionSpec]]:
    """Cost functions."""
    return [PERSONAL_SPACE, PERSONAL_SPACE_NUMPY]


@hookimpl
def crowdbot_metrics() -> Sequence[Component[MetricSpec]]:
    """Metrics."""
    return [HESITATION]


@hookimpl
def crowdbot_scenario_dirs() -> Sequence[Traversable]:
    """The folder with office.yaml, found as ``acme:office``."""
    return [files(__name__) / "suites"]
