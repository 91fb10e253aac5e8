"""The source module of each name in `crowdbot.plugin`."""

from __future__ import annotations

HOMES = {
    "crowdbot.core.batch.imagined_crowd": "ImaginedCrowd",
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
    "crowdbot.core.crowd.velocity_search.collision_rows": "CollisionHeader",
    "crowdbot.core.crowd.velocity_search.cost": (
        "BASE EXCESS GRADIENT LOWER_BOUND OPTIMUM PREPARE AgentView CompiledCost Neighbours "
        "NumpyCost Pointer in_range work_rows"
    ),
    "crowdbot.core.crowd.velocity_search.records": (
        "COST_PARAMS WORK_COLUMNS AgentRecord CostParams NeighbourRecord WallRecord"
    ),
    "crowdbot.core.crowd.world": "CrowdWorld",
    "crowdbot.core.environments.place_parts": "place_parts",
    "crowdbot.core.geometry.footprint": "Footprint",
    "crowdbot.core.geometry.rotation": "rotation",
    "crowdbot.core.geometry.rough_angle": "rough_angle",
    "crowdbot.core.planning.planner": "NoValidCommand Observation Planner Truth",
    "crowdbot.core.planning.weights.weights_file": "read_weights",
    "crowdbot.core.recording.from_mcap": "Trajectories",
    "crowdbot.core.recording.recording": "Recording RecordingInfo",
    "crowdbot.core.robots.description": "Description read_description",
    "crowdbot.core.robots.published": "PublishedWheel read_published",
    "crowdbot.core.scoring.metric": "Metric References",
    "crowdbot.core.scoring.score_factory": "ScoreFactory",
    "crowdbot.core.sensing.context": "SensorContext",
    "crowdbot.core.sensing.mount": (
        "mount_pose mount_tilt sensor_pose_in_world sensor_rotation_in_world"
    ),
    "crowdbot.core.sensing.points": "LidarPoints",
    "crowdbot.core.sensing.tracking.people_tracker": "PeopleTracker Tracks",
    "crowdbot.core.sensing.range_model": "RangeModel",
    "crowdbot.core.sensing.scene": "Scene",
    "crowdbot.core.sensing.sensor": "DepthCamera NoiseGenerator Sensor SensorWithMemory",
    "crowdbot.core.support.compiling.compile": "array_kernel declared_kernel inline_kernel kernel",
    "crowdbot.core.support.immutable": "immutable",
    "crowdbot.core.support.records": "RecordType Rows as_record as_rows record_type record_values",
    "crowdbot.core.support.stable_order": "stable_order",
    "crowdbot.core.trajectories.commands": "Commands",
    "crowdbot.core.trajectories.preprocess": (
        "duration forward_speed path_length time_weights travel_time truncate_at_arrival yaw_rate"
    ),
    "crowdbot.core.trajectories.questionnaires": "Questionnaires",
    "crowdbot.core.trajectories.trajectories": "AgentTracks ContactEvents RobotTrack Trips",
    "crowdbot.core.types.arrays": "Array Indices Mask",
    "crowdbot.core.types.environment": "EnvironmentParts",
    "crowdbot.core.types.motion": "Command Pose",
    "crowdbot.core.types.person_task": "PersonEstimate PersonTask TaskPerson",
    "crowdbot.core.types.robot": (
        "DifferentialDrive HolonomicDrive RobotBody RobotLimits RobotModel RobotState"
    ),
    "crowdbot.core.types.score": "Score",
    "crowdbot.core.types.sensor": "CameraFrame Pinhole Reading SensorInfo SensorMessage",
    "crowdbot.core.types.task": "Task",
    "crowdbot.dsl.spec": "outlines",
    "crowdbot.dsl.spec.assets": "Asset",
    "crowdbot.dsl.spec.component": "Component",
    "crowdbot.dsl.spec.component_specs": (
        "Agreement CostFunctionSpec CrowdPolicySpec DescribedPart EnvironmentSpec MetricSpec "
        "NoiseSpec ObservationSpec PlannerDocument PlannerRole PlannerSpec RewardSpec RobotSpec "
        "SensorSpec"
    ),
    "crowdbot.dsl.spec.metric_component": "Better MetricComponent MetricVariant declare_metric",
    "crowdbot.dsl.spec.metric_invariants": "MetricInvariants",
    "crowdbot.dsl.spec.place": "Face Heights Pillar Place Solid",
    "crowdbot.dsl.spec.quantities": (
        "Angle Length NonNegativeDamping NonNegativeDuration NonNegativeLength NonNegativeSpeed "
        "NonNegativeSteeringStiffness PositiveAcceleration PositiveAngle "
        "PositiveAngularAcceleration PositiveAngularSpeed PositiveDensity PositiveDuration "
        "PositiveForce PositiveFrequency PositiveLength PositiveMass PositiveSpeed "
        "PositiveStiffness Quantity Speed"
    ),
    "crowdbot.dsl.spec.range_sensor": "MOST_RAYS Incidence RangeSensorSpec",
    "crowdbot.dsl.spec.spec": "ComponentSpec Mount Range Rectangle Spec TiltableMount",
    "crowdbot.errors": "InputError PluginError SimulationError did_you_mean nearest",
    "crowdbot.hookspecs": "hookimpl",
    "crowdbot.plugin.build_functions": (
        "BuildCost BuildEnvironment BuildMetric BuildNoise BuildObservation BuildPlanner "
        "BuildPlannerWithHalf BuildPolicy BuildRangeSensor BuildReward BuildRobot BuildSensor"
    ),
}
