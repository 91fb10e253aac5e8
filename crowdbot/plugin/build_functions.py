"""What the build function of a component is called with, and when, one contract per category.

``Component(build="package.module:function")`` names a function, or a class, of these forms. The
registry imports it when something is simulated or scored, never before, and calls it with a
validated spec; what it raises ends the run with a message that names the component. What is built
belongs to one run: nothing is shared between runs.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Protocol, TypeVar

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
from crowdbot.dsl.spec.range_sensor import RangeSensorSpec

if TYPE_CHECKING:
    from crowdbot.core.crowd.policy import Agents, CrowdPolicy
    from crowdbot.core.crowd.velocity_search.cost import CompiledCost, NumpyCost
    from crowdbot.core.planning.planner import Planner
    from crowdbot.core.scoring.metric import Metric
    from crowdbot.core.sensing.context import SensorContext
    from crowdbot.core.sensing.sensor import NoiseGenerator, Sensor, SensorWithMemory
    from crowdbot.core.types.environment import EnvironmentParts
    from crowdbot.core.types.robot import RobotModel

EnvironmentSpecT = TypeVar("EnvironmentSpecT", bound=EnvironmentSpec, contravariant=True)
RobotSpecT = TypeVar("RobotSpecT", bound=RobotSpec, contravariant=True)
SensorSpecT = TypeVar("SensorSpecT", bound=SensorSpec, contravariant=True)
RangeSensorSpecT = TypeVar("RangeSensorSpecT", bound=RangeSensorSpec, contravariant=True)
NoiseSpecT = TypeVar("NoiseSpecT", bound=NoiseSpec, contravariant=True)
PlannerSpecT = TypeVar("PlannerSpecT", bound=PlannerSpec, contravariant=True)
PolicySpecT = TypeVar("PolicySpecT", bound=CrowdPolicySpec, contravariant=True)
CostSpecT = TypeVar("CostSpecT", bound=CostFunctionSpec, contravariant=True)
MetricSpecT = TypeVar("MetricSpecT", bound=MetricSpec, contravariant=True)


class BuildEnvironment(Protocol[EnvironmentSpecT]):
    """Called when people are placed, when a picture is drawn, and once for each recording."""

    def __call__(self, spec: EnvironmentSpecT, /) -> EnvironmentParts:
        """Plain geometry; the same spec gives the same arrays."""
        ...


class BuildRobot(Protocol[RobotSpecT]):
    """Called once for each recording, and to export a robot."""

    def __call__(self, spec: RobotSpecT, /) -> RobotModel:
        """Body, drive, limits, footprint and mass."""
        ...


class BuildSensor(Protocol[SensorSpecT]):
    """Called when a run is prepared, for ``info``, and once where the sensor is simulated."""

    def __call__(self, spec: SensorSpecT, context: SensorContext, /) -> Sensor | SensorWithMemory:
        """Return a sensor that has not read anything yet.

        ``context`` is the robot that carries it, and the robot's task. Functions that take the
        spec only still work until 1.0, with a DeprecationWarning.
        """
        ...


class BuildRangeSensor(Protocol[RangeSensorSpecT]):
    """As `BuildSensor`, for sensors of distances: their specs derive from `RangeSensorSpec`.

    So it is for every component whose spec says that it has parts (``parts_field``): they are
    built first and come second.
    """

    def __call__(
        self, spec: RangeSensorSpecT, noise: Sequence[NoiseGenerator], context: SensorContext, /
    ) -> Sensor | SensorWithMemory:
        """Return a sensor as `BuildSensor` does.

        ``noise`` are the generators of ``spec.noise``, built, in the order of their names.
        """
        ...


class BuildNoise(Protocol[NoiseSpecT]):
    """Called once for each sensor that names it, before the sensor."""

    def __call__(self, spec: NoiseSpecT, /) -> NoiseGenerator:
        """A generator without a state."""
        ...


class BuildPlanner(Protocol[PlannerSpecT]):
    """Called once for each recording with a robot; it may take two minutes to load models."""

    def __call__(self, spec: PlannerSpecT, /) -> Planner:
        """A planner that was not reset yet."""
        ...


class BuildPolicy(Protocol[PolicySpecT]):
    """Called once for each recording with people; once for each named policy of a crowd."""

    def __call__(
        self, spec: PolicySpecT, costs: Sequence[CompiledCost | NumpyCost], agents: Agents, /
    ) -> CrowdPolicy:
        """``costs`` are the crowd's, built, in the document's order; ``agents`` are all."""
        ...


class BuildCost(Protocol[CostSpecT]):
    """Called before the policy that uses the cost function is built."""

    def __call__(self, spec: CostSpecT, /) -> CompiledCost | NumpyCost:
        """Compiled functions with their parameters, or one vectorised function."""
        ...


class BuildMetric(Protocol[MetricSpecT]):
    """Called once for each scoring, in `simulate` and in `evaluate`."""

    def __call__(self, spec: MetricSpecT, /) -> Metric:
        """A pure function of trajectories."""
        ...
