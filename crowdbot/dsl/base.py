"""The specs that plugins derive from, under the name that they had in 0.1."""

from crowdbot.dsl.component_specs import (
    CostFunctionSpec,
    CrowdPolicySpec,
    EnvironmentSpec,
    MetricSpec,
    NoiseSpec,
    PlannerSpec,
    RobotSpec,
    SensorSpec,
)
from crowdbot.dsl.spec import ComponentSpec, Mount, Range, Rectangle, Spec, TiltableMount

__all__ = [
    "ComponentSpec",
    "CostFunctionSpec",
    "CrowdPolicySpec",
    "EnvironmentSpec",
    "MetricSpec",
    "Mount",
    "NoiseSpec",
    "PlannerSpec",
    "Range",
    "Rectangle",
    "RobotSpec",
    "SensorSpec",
    "Spec",
    "TiltableMount",
]
