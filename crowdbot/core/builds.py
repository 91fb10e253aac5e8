"""What the build function of a component is called with, and when, one contract per category.

``Component(build="package.module:function")`` names a function, or a class, of these forms. The
registry imports it when something is simulated or scored, never before, and calls it with a
validated spec; what it raises ends the run with a message that names the component. What is built
belongs to one run: nothing is shared between runs.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Protocol, TypeVar

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
from crowdbot.dsl.proximity import ProximitySpec

if TYPE_CHECKING:
    from crowdbot.core.crowd.cost import CompiledCost, NumpyCost
    from crowdbot.core.crowd.policy import Agents, CrowdPolicy
    from crowdbot.core.interfaces import (
        EnvironmentParts,
        Metric,
        NoiseGenerator,
        Planner,
        RobotModel,
        Sensor,
        SensorWithMemory,
    )

Environment = TypeVar("Environment", bound=EnvironmentSpec, contravariant=True)
Robot = TypeVar("Robot", bound=RobotSpec, contravariant=True)
SensorWords = TypeVar("SensorWords", bound=SensorSpec, contravariant=True)
ProximityWords = TypeVar("ProximityWords", bound=ProximitySpec, contravariant=True)
Noise = TypeVar("Noise", bound=NoiseSpec, contravariant=True)
PlannerWords = TypeVar("PlannerWords", bound=PlannerSpec, contravariant=True)
Policy = TypeVar("Policy", bound=CrowdPolicySpec, contravariant=True)
Cost = TypeVar("Cost", bound=CostFunctionSpec, contravariant=True)
MetricWords = TypeVar("MetricWords", bound=MetricSpec, contravariant=True)


class BuildEnvironment(Protocol[Environment]):
    """Called when people are placed, when a picture is drawn, and once for each recording."""

    def __call__(self, spec: Environment, /) -> EnvironmentParts:
        """Plain geometry; the same spec gives the same arrays."""
        ...


class BuildRobot(Protocol[Robot]):
    """Called once for each recording, and to export a robot."""

    def __call__(self, spec: Robot, /) -> RobotModel:
        """Body, drive, limits, footprint and mass."""
        ...


class BuildSensor(Protocol[SensorWords]):
    """Called when a run is prepared, for ``info``, and once where the sensor is simulated."""

    def __call__(self, spec: SensorWords, /) -> Sensor | SensorWithMemory:
        """A sensor that has not read anything yet."""
        ...


class BuildProximity(Protocol[ProximityWords]):
    """The same for sensors of distances, whose specs derive from `ProximitySpec`."""

    def __call__(
        self, spec: ProximityWords, noise: Sequence[NoiseGenerator] = ..., /
    ) -> Sensor | SensorWithMemory:
        """``noise`` are the generators of ``spec.noise``, built, in the order of their names."""
        ...


class BuildNoise(Protocol[Noise]):
    """Called once for each sensor that names it, before the sensor."""

    def __call__(self, spec: Noise, /) -> NoiseGenerator:
        """A generator without a state."""
        ...


class BuildPlanner(Protocol[PlannerWords]):
    """Called once for each recording with a robot; it may take two minutes to load models."""

    def __call__(self, spec: PlannerWords, /) -> Planner:
        """A planner that was not reset yet."""
        ...


class BuildPolicy(Protocol[Policy]):
    """Called once for each recording with people; once for each named policy of a crowd."""

    def __call__(
        self, spec: Policy, costs: Sequence[CompiledCost | NumpyCost], agents: Agents, /
    ) -> CrowdPolicy:
        """``costs`` are the crowd's, built, in the document's order; ``agents`` are all."""
        ...


class BuildCost(Protocol[Cost]):
    """Called before the policy that is handed it."""

    def __call__(self, spec: Cost, /) -> CompiledCost | NumpyCost:
        """Compiled functions with their parameters, or one vectorised function."""
        ...


class BuildMetric(Protocol[MetricWords]):
    """Called once for each scoring, in `simulate` and in `evaluate`."""

    def __call__(self, spec: MetricWords, /) -> Metric:
        """A pure function of trajectories."""
        ...
