"""The scenario language: specs, YAML, matrices, hashes, diagnostics.

Its names here are what the spec side of a plugin imports; the build side is in
`crowdbot.core.interfaces`. The language imports the standard library, pydantic, PyYAML
and ruamel.yaml only.
"""

from crowdbot.dsl.spec import outlines
from crowdbot.dsl.spec.assets import Asset
from crowdbot.dsl.spec.component import Component
from crowdbot.dsl.spec.component_specs import (
    CostFunctionSpec,
    CrowdPolicySpec,
    EnvironmentSpec,
    MetricSpec,
    NoiseSpec,
    PlannerRole,
    PlannerSpec,
    RobotSpec,
    SensorSpec,
)
from crowdbot.dsl.spec.metric_component import (
    Better,
    MetricComponent,
    MetricVariant,
    declare_metric,
)
from crowdbot.dsl.spec.metric_invariants import MetricInvariants
from crowdbot.dsl.spec.place import Face, Heights, Pillar, Place, Solid
from crowdbot.dsl.spec.quantities import (
    Angle,
    Length,
    NonNegativeDamping,
    NonNegativeDuration,
    NonNegativeLength,
    NonNegativeSpeed,
    NonNegativeSteeringStiffness,
    PositiveAcceleration,
    PositiveAngle,
    PositiveAngularAcceleration,
    PositiveAngularSpeed,
    PositiveDensity,
    PositiveDuration,
    PositiveForce,
    PositiveFrequency,
    PositiveLength,
    PositiveMass,
    PositiveSpeed,
    PositiveStiffness,
    Quantity,
    Speed,
)
from crowdbot.dsl.spec.range_sensor import MOST_RAYS, Incidence, RangeSensorSpec
from crowdbot.dsl.spec.spec import (
    ComponentSpec,
    Mount,
    Range,
    Rectangle,
    Spec,
    TiltableMount,
)

__all__ = [
    "MOST_RAYS",
    "Angle",
    "Asset",
    "Better",
    "Component",
    "ComponentSpec",
    "CostFunctionSpec",
    "CrowdPolicySpec",
    "EnvironmentSpec",
    "Face",
    "Heights",
    "Incidence",
    "Length",
    "MetricComponent",
    "MetricInvariants",
    "MetricSpec",
    "MetricVariant",
    "Mount",
    "NoiseSpec",
    "NonNegativeDamping",
    "NonNegativeDuration",
    "NonNegativeLength",
    "NonNegativeSpeed",
    "NonNegativeSteeringStiffness",
    "Pillar",
    "Place",
    "PlannerRole",
    "PlannerSpec",
    "PositiveAcceleration",
    "PositiveAngle",
    "PositiveAngularAcceleration",
    "PositiveAngularSpeed",
    "PositiveDensity",
    "PositiveDuration",
    "PositiveForce",
    "PositiveFrequency",
    "PositiveLength",
    "PositiveMass",
    "PositiveSpeed",
    "PositiveStiffness",
    "Quantity",
    "Range",
    "RangeSensorSpec",
    "Rectangle",
    "RobotSpec",
    "SensorSpec",
    "Solid",
    "Spec",
    "Speed",
    "TiltableMount",
    "declare_metric",
    "outlines",
]
