"""Interfaces of build functions, one per category, and when they are called.

``Component(build="package.module:function")`` names a function or class with one of these
signatures. The registry imports it when it is first simulated or scored, and calls it with a
validated spec; an exception ends the run with a message that names the component. The result
belongs to one run and is not shared.
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
    ObservationSpec,
    PlannerSpec,
    RewardSpec,
    RobotSpec,
    SensorSpec,
)
from crowdbot.dsl.spec.range_sensor import RangeSensorSpec

if TYPE_CHECKING:
    from crowdbot.core.crowd.agents import Agents
    from crowdbot.core.crowd.policy import CrowdPolicy
    from crowdbot.core.crowd.velocity_search.cost import CompiledCost, NumpyCost
    from crowdbot.core.learning.build import Observer, Reward
    from crowdbot.core.learning.seen import LearningContext
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
ObservationSpecT = TypeVar("ObservationSpecT", bound=ObservationSpec, contravariant=True)
RewardSpecT = TypeVar("RewardSpecT", bound=RewardSpec, contravariant=True)
MetricSpecT = TypeVar("MetricSpecT", bound=MetricSpec, contravariant=True)


class BuildEnvironment(Protocol[EnvironmentSpecT]):
    """Builds an environment: called to place people, to draw, and once per recording."""

    def __call__(self, spec: EnvironmentSpecT, /) -> EnvironmentParts:
        """Return plain geometry; the same spec gives the same arrays."""
        ...


class BuildRobot(Protocol[RobotSpecT]):
    """Builds a robot: called once per recording, and to export a robot."""

    def __call__(self, spec: RobotSpecT, /) -> RobotModel:
        """Return body, drive, limits, footprint and mass."""
        ...


class BuildSensor(Protocol[SensorSpecT]):
    """Builds a sensor: called when a run is prepared, for ``info``, and once for the simulation."""

    def __call__(self, spec: SensorSpecT, context: SensorContext, /) -> Sensor | SensorWithMemory:
        """Return a sensor that has not read anything yet.

        ``context`` is the robot that carries it, and the robot's task. Functions that take the
        spec only still work until 1.0, with a DeprecationWarning.
        """
        ...


class BuildRangeSensor(Protocol[RangeSensorSpecT]):
    """Builds a range sensor; like `BuildSensor`, for specs derived from `RangeSensorSpec`.

    Every component whose spec has parts (``parts_field``) works the same way: the parts are built
    first and passed as second argument.
    """

    def __call__(
        self, spec: RangeSensorSpecT, noise: Sequence[NoiseGenerator], context: SensorContext, /
    ) -> Sensor | SensorWithMemory:
        """Return a sensor as `BuildSensor` does.

        ``noise`` are the generators of ``spec.noise``, built, in the order of their names.
        """
        ...


class BuildNoise(Protocol[NoiseSpecT]):
    """Builds a noise generator: called once per sensor that names it, before the sensor."""

    def __call__(self, spec: NoiseSpecT, /) -> NoiseGenerator:
        """Return a stateless generator."""
        ...


class BuildPlanner(Protocol[PlannerSpecT]):
    """Builds a planner: called once per recording with a robot.

    It may take two minutes to load models.
    """

    def __call__(self, spec: PlannerSpecT, /) -> Planner:
        """Return a planner that was not reset yet."""
        ...


class BuildPlannerWithHalf(Protocol[PlannerSpecT]):
    """Builds a planner that calls another one, see ``PlannerSpec.half``; like `BuildPlanner`."""

    def __call__(self, spec: PlannerSpecT, half: Planner, /) -> Planner:
        """Return a planner that was not reset yet.

        ``half`` is the built inner planner: reset it in ``reset``, call it in ``step``. Pass it the
        outer planner's observation, of which it gets only the sensors that it needs; its commands
        are within the limits.
        """
        ...


class BuildPolicy(Protocol[PolicySpecT]):
    """Builds a crowd policy: called once per recording with people, and once per named policy."""

    def __call__(
        self, spec: PolicySpecT, costs: Sequence[CompiledCost | NumpyCost], agents: Agents, /
    ) -> CrowdPolicy:
        """Return a crowd policy.

        ``costs`` are the built cost functions, in the document's order; ``agents`` are all agents
        of the crowd.
        """
        ...


class BuildCost(Protocol[CostSpecT]):
    """Builds a cost function: called before the policy that uses it."""

    def __call__(self, spec: CostSpecT, /) -> CompiledCost | NumpyCost:
        """Return compiled functions with their parameters, or one vectorised function."""
        ...


class BuildMetric(Protocol[MetricSpecT]):
    """Builds a metric: called once per scoring, in `simulate` and in `evaluate`."""

    def __call__(self, spec: MetricSpecT, /) -> Metric:
        """Return a pure function of trajectories."""
        ...


class BuildObservation(Protocol[ObservationSpecT]):
    """Builds an observer: called once per environment, and once per run of a policy."""

    def __call__(self, spec: ObservationSpecT, context: LearningContext, /) -> Observer:
        """Return an observer that has seen nothing yet."""
        ...


class BuildReward(Protocol[RewardSpecT]):
    """Builds a reward: called once per environment."""

    def __call__(self, spec: RewardSpecT, context: LearningContext, /) -> Reward:
        """Return a stateless reward."""
        ...
