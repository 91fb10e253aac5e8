"""The module that plugins import: specs and components, interfaces, value types and tools.

Specs and components describe documents; they need no numpy, and a module of specs imports nothing
else. Build functions use numpy: SI units, float64, read-only inputs, new outputs; world frame x
along the corridor, y left, z up, yaw counter-clockwise (REP-103). docs/developers/author_surface.md
describes each name. Names are imported on first use; core does not import this module.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from crowdbot.lazy import lazy_names
from crowdbot.plugin.homes import HOMES

if TYPE_CHECKING:
    from crowdbot.core.batch.imagined_crowd import ImaginedCrowd
    from crowdbot.core.crowd.agents import LOOP, PORTAL, REMOVE, STOP, Agents
    from crowdbot.core.crowd.contact.geometry import (
        nearest_on_segment,
        time_to_disc,
        time_to_segment,
    )
    from crowdbot.core.crowd.desired_acceleration import desired_acceleration
    from crowdbot.core.crowd.engine import CrowdEngine, PolicyFactory
    from crowdbot.core.crowd.from_spec import policy_of
    from crowdbot.core.crowd.policy import (
        CONTACT_STIFFNESS,
        AcceleratingPolicy,
        CrowdPolicy,
        CrowdView,
        VelocityPolicy,
    )
    from crowdbot.core.crowd.recorded import RecordedCrowd, read_record
    from crowdbot.core.crowd.velocity_search.collision import (
        first_collision,
        first_contact,
        list_approaching,
        list_obstacles,
        soonest_disc,
    )
    from crowdbot.core.crowd.velocity_search.collision_rows import CollisionHeader
    from crowdbot.core.crowd.velocity_search.cost import (
        BASE,
        EXCESS,
        GRADIENT,
        LOWER_BOUND,
        OPTIMUM,
        PREPARE,
        AgentView,
        CompiledCost,
        Neighbours,
        NumpyCost,
        Pointer,
        in_range,
        work_rows,
    )
    from crowdbot.core.crowd.velocity_search.records import (
        COST_PARAMS,
        WORK_COLUMNS,
        AgentRecord,
        CostParams,
        NeighbourRecord,
        WallRecord,
    )
    from crowdbot.core.crowd.world import CrowdWorld
    from crowdbot.core.environments.place_parts import place_parts
    from crowdbot.core.geometry.footprint import Footprint
    from crowdbot.core.geometry.rotation import rotation
    from crowdbot.core.geometry.rough_angle import rough_angle
    from crowdbot.core.planning.planner import NoValidCommand, Observation, Planner, Truth
    from crowdbot.core.planning.weights.weights_file import read_weights
    from crowdbot.core.recording.from_mcap import Trajectories
    from crowdbot.core.recording.recording import Recording, RecordingInfo
    from crowdbot.core.robots.description import Description, read_description
    from crowdbot.core.robots.published import PublishedWheel, read_published
    from crowdbot.core.scoring.metric import Metric, References
    from crowdbot.core.scoring.score_factory import ScoreFactory
    from crowdbot.core.sensing.context import SensorContext
    from crowdbot.core.sensing.mount import (
        mount_pose,
        mount_tilt,
        sensor_pose_in_world,
        sensor_rotation_in_world,
    )
    from crowdbot.core.sensing.points import LidarPoints
    from crowdbot.core.sensing.range_model import RangeModel
    from crowdbot.core.sensing.scene import Scene
    from crowdbot.core.sensing.sensor import DepthCamera, NoiseGenerator, Sensor, SensorWithMemory
    from crowdbot.core.sensing.tracking.people_tracker import PeopleTracker, Tracks
    from crowdbot.core.support.compiling.compile import (
        array_kernel,
        declared_kernel,
        inline_kernel,
        kernel,
    )
    from crowdbot.core.support.immutable import immutable
    from crowdbot.core.support.records import (
        RecordType,
        Rows,
        as_record,
        as_rows,
        record_type,
        record_values,
    )
    from crowdbot.core.support.stable_order import stable_order
    from crowdbot.core.trajectories.commands import Commands
    from crowdbot.core.trajectories.preprocess import (
        duration,
        forward_speed,
        path_length,
        time_weights,
        travel_time,
        truncate_at_arrival,
        yaw_rate,
    )
    from crowdbot.core.trajectories.questionnaires import Questionnaires
    from crowdbot.core.trajectories.trajectories import (
        AgentTracks,
        ContactEvents,
        RobotTrack,
        Trips,
    )
    from crowdbot.core.types.arrays import Array, Indices, Mask
    from crowdbot.core.types.environment import EnvironmentParts
    from crowdbot.core.types.motion import Command, Pose
    from crowdbot.core.types.person_task import PersonEstimate, PersonTask, TaskPerson
    from crowdbot.core.types.robot import (
        DifferentialDrive,
        HolonomicDrive,
        RobotBody,
        RobotLimits,
        RobotModel,
        RobotState,
    )
    from crowdbot.core.types.score import Score
    from crowdbot.core.types.sensor import CameraFrame, Pinhole, Reading, SensorInfo, SensorMessage
    from crowdbot.core.types.task import Task
    from crowdbot.dsl.spec import outlines
    from crowdbot.dsl.spec.assets import Asset
    from crowdbot.dsl.spec.component import Component
    from crowdbot.dsl.spec.component_specs import (
        Agreement,
        CostFunctionSpec,
        CrowdPolicySpec,
        DescribedPart,
        EnvironmentSpec,
        MetricSpec,
        NoiseSpec,
        ObservationSpec,
        PlannerDocument,
        PlannerRole,
        PlannerSpec,
        RewardSpec,
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
    from crowdbot.dsl.spec.spec import ComponentSpec, Mount, Range, Rectangle, Spec, TiltableMount
    from crowdbot.errors import InputError, PluginError, SimulationError, did_you_mean, nearest
    from crowdbot.hookspecs import hookimpl
    from crowdbot.plugin.build_functions import (
        BuildCost,
        BuildEnvironment,
        BuildMetric,
        BuildNoise,
        BuildObservation,
        BuildPlanner,
        BuildPlannerWithHalf,
        BuildPolicy,
        BuildRangeSensor,
        BuildReward,
        BuildRobot,
        BuildSensor,
    )

__all__ = [
    "BASE",
    "CONTACT_STIFFNESS",
    "COST_PARAMS",
    "EXCESS",
    "GRADIENT",
    "LOOP",
    "LOWER_BOUND",
    "MOST_RAYS",
    "OPTIMUM",
    "PORTAL",
    "PREPARE",
    "REMOVE",
    "STOP",
    "WORK_COLUMNS",
    "AcceleratingPolicy",
    "AgentRecord",
    "AgentTracks",
    "AgentView",
    "Agents",
    "Agreement",
    "Angle",
    "Array",
    "Asset",
    "Better",
    "BuildCost",
    "BuildEnvironment",
    "BuildMetric",
    "BuildNoise",
    "BuildObservation",
    "BuildPlanner",
    "BuildPlannerWithHalf",
    "BuildPolicy",
    "BuildRangeSensor",
    "BuildReward",
    "BuildRobot",
    "BuildSensor",
    "CameraFrame",
    "CollisionHeader",
    "Command",
    "Commands",
    "CompiledCost",
    "Component",
    "ComponentSpec",
    "ContactEvents",
    "CostFunctionSpec",
    "CostParams",
    "CrowdEngine",
    "CrowdPolicy",
    "CrowdPolicySpec",
    "CrowdView",
    "CrowdWorld",
    "DepthCamera",
    "DescribedPart",
    "Description",
    "DifferentialDrive",
    "EnvironmentParts",
    "EnvironmentSpec",
    "Face",
    "Footprint",
    "Heights",
    "HolonomicDrive",
    "ImaginedCrowd",
    "Incidence",
    "Indices",
    "InputError",
    "Length",
    "LidarPoints",
    "Mask",
    "Metric",
    "MetricComponent",
    "MetricInvariants",
    "MetricSpec",
    "MetricVariant",
    "Mount",
    "NeighbourRecord",
    "Neighbours",
    "NoValidCommand",
    "NoiseGenerator",
    "NoiseSpec",
    "NonNegativeDamping",
    "NonNegativeDuration",
    "NonNegativeLength",
    "NonNegativeSpeed",
    "NonNegativeSteeringStiffness",
    "NumpyCost",
    "Observation",
    "ObservationSpec",
    "PeopleTracker",
    "PersonEstimate",
    "PersonTask",
    "Pillar",
    "Pinhole",
    "Place",
    "Planner",
    "PlannerDocument",
    "PlannerRole",
    "PlannerSpec",
    "PluginError",
    "Pointer",
    "PolicyFactory",
    "Pose",
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
    "PublishedWheel",
    "Quantity",
    "Questionnaires",
    "Range",
    "RangeModel",
    "RangeSensorSpec",
    "Reading",
    "RecordType",
    "RecordedCrowd",
    "Recording",
    "RecordingInfo",
    "Rectangle",
    "References",
    "RewardSpec",
    "RobotBody",
    "RobotLimits",
    "RobotModel",
    "RobotSpec",
    "RobotState",
    "RobotTrack",
    "Rows",
    "Scene",
    "Score",
    "ScoreFactory",
    "Sensor",
    "SensorContext",
    "SensorInfo",
    "SensorMessage",
    "SensorSpec",
    "SensorWithMemory",
    "SimulationError",
    "Solid",
    "Spec",
    "Speed",
    "Task",
    "TaskPerson",
    "TiltableMount",
    "Tracks",
    "Trajectories",
    "Trips",
    "Truth",
    "VelocityPolicy",
    "WallRecord",
    "array_kernel",
    "as_record",
    "as_rows",
    "declare_metric",
    "declared_kernel",
    "desired_acceleration",
    "did_you_mean",
    "duration",
    "first_collision",
    "first_contact",
    "forward_speed",
    "hookimpl",
    "immutable",
    "in_range",
    "inline_kernel",
    "kernel",
    "list_approaching",
    "list_obstacles",
    "mount_pose",
    "mount_tilt",
    "nearest",
    "nearest_on_segment",
    "outlines",
    "path_length",
    "place_parts",
    "policy_of",
    "read_description",
    "read_published",
    "read_record",
    "read_weights",
    "record_type",
    "record_values",
    "rotation",
    "rough_angle",
    "sensor_pose_in_world",
    "sensor_rotation_in_world",
    "soonest_disc",
    "stable_order",
    "time_to_disc",
    "time_to_segment",
    "time_weights",
    "travel_time",
    "truncate_at_arrival",
    "work_rows",
    "yaw_rate",
]


if not TYPE_CHECKING:
    __getattr__ = lazy_names(__name__, HOMES)


def __dir__() -> list[str]:
    return sorted(__all__)
