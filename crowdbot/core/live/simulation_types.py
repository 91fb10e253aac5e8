"""Types of simulation_interfaces 2.1.0 for the services of a live run.

Source: https://github.com/ros-simulation/simulation_interfaces. Names and order of fields define
the wire format and the type hashes; constants affect neither and are left out.
"""

from __future__ import annotations

PACKAGE = "simulation_interfaces"
MESSAGES = {
    "Result": "uint8 result\nstring error_message",
    "SimulationState": "uint8 state",
    "SimulatorFeatures": "uint16[] features\nstring[] spawn_formats\nstring custom_info",
    "Resource": "string uri\nstring resource_string",
    "TagsFilter": "string[] tags\nuint8 filter_mode",
    "EntityCategory": "uint8 category",
    "Bounds": "uint8 type\ngeometry_msgs/Vector3[] points",
    "EntityFilters": (
        "string filter\nsimulation_interfaces/EntityCategory[] categories\n"
        "simulation_interfaces/TagsFilter tags\nsimulation_interfaces/Bounds bounds"
    ),
    "EntityState": (
        "std_msgs/Header header\ngeometry_msgs/Pose pose\ngeometry_msgs/Twist twist\n"
        "geometry_msgs/Accel acceleration"
    ),
    "WorldResource": (
        "string name\nsimulation_interfaces/Resource world_resource\nstring description\n"
        "string[] tags"
    ),
}
_RESULT = {"result": f"{PACKAGE}/Result"}
_STATE = {"state": f"{PACKAGE}/SimulationState"}
_WORLD = {"world": f"{PACKAGE}/WorldResource"}
#: Service -> fields of its request and response.
SERVICES: dict[str, tuple[dict[str, str], dict[str, str]]] = {
    "ResetSimulation": ({"scope": "uint8"}, _RESULT),
    "StepSimulation": ({"steps": "uint64"}, _RESULT),
    "GetSimulationState": ({}, {**_STATE, **_RESULT}),
    "SetSimulationState": (_STATE, _RESULT),
    "GetSimulatorFeatures": ({}, {"features": f"{PACKAGE}/SimulatorFeatures"}),
    "GetEntities": (
        {"filters": f"{PACKAGE}/EntityFilters"},
        {**_RESULT, "entities": "string[]"},
    ),
    "GetEntityState": (
        {"entity": "string"},
        {**_RESULT, "state": f"{PACKAGE}/EntityState"},
    ),
    "GetEntitiesStates": (
        {"filters": f"{PACKAGE}/EntityFilters"},
        {**_RESULT, "entities": "string[]", "states": f"{PACKAGE}/EntityState[]"},
    ),
    "SetEntityState": ({"entity": "string", "state": f"{PACKAGE}/EntityState"}, _RESULT),
    "DeleteEntity": ({"entity": "string"}, _RESULT),
    "UnloadWorld": ({}, _RESULT),
    "GetAvailableWorlds": (
        {"additional_sources": "string[]", "filter": f"{PACKAGE}/TagsFilter",
         "offline_only": "bool", "continue_on_error": "bool"},
        {**_RESULT, "worlds": f"{PACKAGE}/WorldResource[]"},
    ),
    "GetCurrentWorld": ({}, {**_RESULT, **_WORLD}),
    "LoadWorld": (
        {"world_resource": f"{PACKAGE}/Resource", "fail_on_unsupported_element": "bool",
         "ignore_missing_or_unsupported_assets": "bool"},
        {**_RESULT, **_WORLD},
    ),
    "SpawnEntity": (
        {"name": "string", "allow_renaming": "bool", "entity_resource": f"{PACKAGE}/Resource",
         "entity_namespace": "string", "initial_pose": "geometry_msgs/PoseStamped"},
        {**_RESULT, "entity_name": "string"},
    ),
}  # fmt: skip
