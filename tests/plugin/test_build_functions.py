"""The contracts of build functions fit crowdbot's own; mypy compares their types."""

from __future__ import annotations

import inspect

from crowdbot.dsl.spec.component_specs import CATEGORIES
from crowdbot.plugin import build_functions as builds
from crowdbot.plugins.crowd.cost_functions.goal_reaching_force import GoalReachingForceSpec
from crowdbot.plugins.crowd.cost_functions.goal_reaching_force_build import build as build_cost
from crowdbot.plugins.crowd.policies.replay import ReplaySpec
from crowdbot.plugins.crowd.policies.replay_build import build as build_policy
from crowdbot.plugins.environments.corridor import CorridorSpec
from crowdbot.plugins.environments.place_build import build as build_environment
from crowdbot.plugins.metrics.risk import RiskSpec
from crowdbot.plugins.metrics.risk_build import Risk
from crowdbot.plugins.noise.offset import OffsetSpec
from crowdbot.plugins.noise.offset_build import build as build_noise
from crowdbot.plugins.planners.dwa.dwa import DwaSpec
from crowdbot.plugins.planners.dwa.dwa_build import build as build_planner
from crowdbot.plugins.planners.probabilistic.probabilistic import ProbabilisticSpec
from crowdbot.plugins.planners.probabilistic.probabilistic_build import (
    build as build_probabilistic,
)
from crowdbot.plugins.robots.turtlebot2 import Turtlebot2Spec
from crowdbot.plugins.robots.turtlebot2_build import build as build_robot
from crowdbot.plugins.sensors.bumper import BumperSpec
from crowdbot.plugins.sensors.bumper_build import build as build_sensor
from crowdbot.plugins.sensors.ultrasound import UltrasoundSpec
from crowdbot.plugins.sensors.ultrasound_build import build as build_proximity

environment: builds.BuildEnvironment[CorridorSpec] = build_environment
robot: builds.BuildRobot[Turtlebot2Spec] = build_robot
sensor: builds.BuildSensor[BumperSpec] = build_sensor
proximity: builds.BuildRangeSensor[UltrasoundSpec] = build_proximity
noise: builds.BuildNoise[OffsetSpec] = build_noise
planner: builds.BuildPlanner[DwaSpec] = build_planner
both: builds.BuildPlannerWithHalf[ProbabilisticSpec] = build_probabilistic
policy: builds.BuildPolicy[ReplaySpec] = build_policy
cost: builds.BuildCost[GoalReachingForceSpec] = build_cost
metric: builds.BuildMetric[RiskSpec] = Risk


def test_every_category_has_a_contract_with_a_time() -> None:
    contracts = {n: c for n, c in vars(builds).items() if n.startswith("Build")}
    assert len(contracts) == len(CATEGORIES) + 2  # also of sensors with noise, planners with a half
    for name, contract in contracts.items():
        first = (inspect.getdoc(contract) or "").partition("\n")[0]
        assert "called " in first.lower() or name in ("BuildRangeSensor", "BuildPlannerWithHalf")
