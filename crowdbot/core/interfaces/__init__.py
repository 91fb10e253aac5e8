"""What the build side of a plugin imports: contracts, the values they speak in, and tools.

All at numpy level: SI units, float64, read-only inputs, new outputs; world frame x along the
corridor, y left, z up, yaw counter-clockwise (REP-103). Specs and components are in
`crowdbot.dsl`. docs/reference/author_surface.md has a line on each name. Nothing of core imports
this module; names are imported when they are first used.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from crowdbot.lazy import lazy_names

if TYPE_CHECKING:
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
    from crowdbot.core.crowd.velocity_search.cost import (
        AGENT_SIZE,
        ASKED_RADIUS,
        ASKED_X,
        ASKED_Y,
        AX,
        AY,
        BASE,
        BX,
        BY,
        D2,
        DESCENDS,
        EXCESS,
        FASTEST,
        FROM_SURFACE,
        GRADIENT,
        GX,
        GY,
        LOWER_BOUND,
        MAX_ACCELERATION,
        MAX_SPEED,
        NEAR_COLUMNS,
        NPX,
        NPY,
        NVX,
        NVY,
        NX,
        NY,
        OPTIMUM,
        PARITY,
        PREFERRED,
        PREPARE,
        PVX,
        PVY,
        PX,
        PY,
        RADIUS,
        RANDOM,
        RANGE,
        REACH,
        RELAXATION,
        RX,
        RY,
        STATIC,
        TIME_STEP,
        VX,
        VY,
        WALL_COLUMNS,
        WALL_D2,
        WEIGHT,
        WORK_COLUMNS,
        AgentView,
        CompiledCost,
        Neighbours,
        NumpyCost,
        Pointer,
        in_range,
        near_table,
        wall_table,
        work_rows,
        work_table,
    )
    from crowdbot.core.crowd.world import CrowdWorld
    from crowdbot.core.environments.place_parts import place_parts
    from crowdbot.core.geometry.footprint import Footprint
    from crowdbot.core.interfaces.build_functions import (
        BuildCost,
        BuildEnvironment,
        BuildMetric,
        BuildNoise,
        BuildPlanner,
        BuildPolicy,
        BuildRangeSensor,
        BuildRobot,
        BuildSensor,
    )
    from crowdbot.core.planning.planner import NoValidCommand, Observation, Planner, Task, Truth
    from crowdbot.core.recording.reader import (
        RecordingInfo,
        read_scans,
        read_trajectories,
        recording_info,
    )
    from crowdbot.core.robots.description import Description, read_description
    from crowdbot.core.robots.published import PublishedWheel, read_published
    from crowdbot.core.scoring.metric import Metric, References
    from crowdbot.core.scoring.score_factory import ScoreFactory
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
    from crowdbot.core.support.compile import declared_kernel, kernel
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
        Trajectories,
        Trips,
    )
    from crowdbot.core.types.arrays import Array, Indices, Mask
    from crowdbot.core.types.environment import EnvironmentParts
    from crowdbot.core.types.motion import Command, Pose
    from crowdbot.core.types.robot import (
        DifferentialDrive,
        HolonomicDrive,
        RobotBody,
        RobotLimits,
        RobotModel,
        RobotState,
    )
    from crowdbot.core.types.score import Score
    from crowdbot.core.types.sensor import CameraFrame, Pinhole, Reading, SensorInfo

_HOMES = {
    "crowdbot.core.crowd.agents": "LOOP PORTAL REMOVE STOP Agents",
    "crowdbot.core.crowd.contact.geometry": "nearest_on_segment time_to_disc time_to_segment",
    "crowdbot.core.crowd.desired_acceleration": "desired_acceleration",
    "crowdbot.core.crowd.engine": "CrowdEngine PolicyFactory",
    "crowdbot.core.crowd.from_spec": "policy_of",
    "crowdbot.core.crowd.policy": (
        "CONTACT_STIFFNESS AcceleratingPolicy CrowdPolicy CrowdView VelocityPolicy"
    ),
    "crowdbot.core.crowd.recorded": "RecordedCrowd read_record",
    "crowdbot.core.crowd.velocity_search.collision": (
        "first_collision first_contact list_approaching list_obstacles soonest_disc"
    ),
    "crowdbot.core.crowd.velocity_search.cost": (
        "AGENT_SIZE ASKED_RADIUS ASKED_X ASKED_Y AX AY BASE BX BY D2 DESCENDS EXCESS FASTEST "
        "FROM_SURFACE GRADIENT GX GY "
        "LOWER_BOUND MAX_ACCELERATION MAX_SPEED NEAR_COLUMNS NPX NPY NVX NVY NX NY OPTIMUM "
        "PARITY PREFERRED PREPARE PVX PVY PX PY RADIUS RANDOM RANGE REACH RELAXATION RX RY "
        "STATIC TIME_STEP VX VY WALL_COLUMNS WALL_D2 WEIGHT WORK_COLUMNS AgentView "
        "CompiledCost Neighbours NumpyCost Pointer in_range near_table wall_table work_rows "
        "work_table"
    ),
    "crowdbot.core.crowd.world": "CrowdWorld",
    "crowdbot.core.environments.place_parts": "place_parts",
    "crowdbot.core.geometry.footprint": "Footprint",
    "crowdbot.core.interfaces.build_functions": (
        "BuildCost BuildEnvironment BuildMetric BuildNoise BuildPlanner BuildPolicy "
        "BuildRangeSensor BuildRobot BuildSensor"
    ),
    "crowdbot.core.planning.planner": "NoValidCommand Observation Planner Task Truth",
    "crowdbot.core.recording.reader": "RecordingInfo read_scans read_trajectories recording_info",
    "crowdbot.core.robots.description": "Description read_description",
    "crowdbot.core.robots.published": "PublishedWheel read_published",
    "crowdbot.core.scoring.metric": "Metric References",
    "crowdbot.core.scoring.score_factory": "ScoreFactory",
    "crowdbot.core.sensing.mount": (
        "mount_pose mount_tilt sensor_pose_in_world sensor_rotation_in_world"
    ),
    "crowdbot.core.sensing.points": "LidarPoints",
    "crowdbot.core.sensing.range_model": "RangeModel",
    "crowdbot.core.sensing.scene": "Scene",
    "crowdbot.core.sensing.sensor": "DepthCamera NoiseGenerator Sensor SensorWithMemory",
    "crowdbot.core.support.compile": "declared_kernel kernel",
    "crowdbot.core.trajectories.commands": "Commands",
    "crowdbot.core.trajectories.preprocess": (
        "duration forward_speed path_length time_weights travel_time truncate_at_arrival yaw_rate"
    ),
    "crowdbot.core.trajectories.questionnaires": "Questionnaires",
    "crowdbot.core.trajectories.trajectories": (
        "AgentTracks ContactEvents RobotTrack Trajectories Trips"
    ),
    "crowdbot.core.types.arrays": "Array Indices Mask",
    "crowdbot.core.types.environment": "EnvironmentParts",
    "crowdbot.core.types.motion": "Command Pose",
    "crowdbot.core.types.robot": (
        "DifferentialDrive HolonomicDrive RobotBody RobotLimits RobotModel RobotState"
    ),
    "crowdbot.core.types.score": "Score",
    "crowdbot.core.types.sensor": "CameraFrame Pinhole Reading SensorInfo",
}

__all__ = [
    "AGENT_SIZE",
    "ASKED_RADIUS",
    "ASKED_X",
    "ASKED_Y",
    "AX",
    "AY",
    "BASE",
    "BX",
    "BY",
    "CONTACT_STIFFNESS",
    "D2",
    "DESCENDS",
    "EXCESS",
    "FASTEST",
    "FROM_SURFACE",
    "GRADIENT",
    "GX",
    "GY",
    "LOOP",
    "LOWER_BOUND",
    "MAX_ACCELERATION",
    "MAX_SPEED",
    "NEAR_COLUMNS",
    "NPX",
    "NPY",
    "NVX",
    "NVY",
    "NX",
    "NY",
    "OPTIMUM",
    "PARITY",
    "PORTAL",
    "PREFERRED",
    "PREPARE",
    "PVX",
    "PVY",
    "PX",
    "PY",
    "RADIUS",
    "RANDOM",
    "RANGE",
    "REACH",
    "RELAXATION",
    "REMOVE",
    "RX",
    "RY",
    "STATIC",
    "STOP",
    "TIME_STEP",
    "VX",
    "VY",
    "WALL_COLUMNS",
    "WALL_D2",
    "WEIGHT",
    "WORK_COLUMNS",
    "AcceleratingPolicy",
    "AgentTracks",
    "AgentView",
    "Agents",
    "Array",
    "BuildCost",
    "BuildEnvironment",
    "BuildMetric",
    "BuildNoise",
    "BuildPlanner",
    "BuildPolicy",
    "BuildRangeSensor",
    "BuildRobot",
    "BuildSensor",
    "CameraFrame",
    "Command",
    "Commands",
    "CompiledCost",
    "ContactEvents",
    "CrowdEngine",
    "CrowdPolicy",
    "CrowdView",
    "CrowdWorld",
    "DepthCamera",
    "Description",
    "DifferentialDrive",
    "EnvironmentParts",
    "Footprint",
    "HolonomicDrive",
    "Indices",
    "LidarPoints",
    "Mask",
    "Metric",
    "Neighbours",
    "NoValidCommand",
    "NoiseGenerator",
    "NumpyCost",
    "Observation",
    "Pinhole",
    "Planner",
    "Pointer",
    "PolicyFactory",
    "Pose",
    "PublishedWheel",
    "Questionnaires",
    "RangeModel",
    "Reading",
    "RecordedCrowd",
    "RecordingInfo",
    "References",
    "RobotBody",
    "RobotLimits",
    "RobotModel",
    "RobotState",
    "RobotTrack",
    "Scene",
    "Score",
    "ScoreFactory",
    "Sensor",
    "SensorInfo",
    "SensorWithMemory",
    "Task",
    "Trajectories",
    "Trips",
    "Truth",
    "VelocityPolicy",
    "declared_kernel",
    "desired_acceleration",
    "duration",
    "first_collision",
    "first_contact",
    "forward_speed",
    "in_range",
    "kernel",
    "list_approaching",
    "list_obstacles",
    "mount_pose",
    "mount_tilt",
    "near_table",
    "nearest_on_segment",
    "path_length",
    "place_parts",
    "policy_of",
    "read_description",
    "read_published",
    "read_record",
    "read_scans",
    "read_trajectories",
    "recording_info",
    "sensor_pose_in_world",
    "sensor_rotation_in_world",
    "soonest_disc",
    "time_to_disc",
    "time_to_segment",
    "time_weights",
    "travel_time",
    "truncate_at_arrival",
    "wall_table",
    "work_rows",
    "work_table",
    "yaw_rate",
]


if not TYPE_CHECKING:
    __getattr__ = lazy_names(__name__, _HOMES)


def __dir__() -> list[str]:
    return sorted(__all__)
