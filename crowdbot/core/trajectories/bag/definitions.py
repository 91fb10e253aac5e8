"""Definitions of message types for people that no ROS distribution contains.

A bag of ROS 2 Humble or older in sqlite3 has no definitions of its messages. These are those of the
packages' .msg files: fields only, since constants are not serialised.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from typing import Any

from rosbags.typesys import Stores, get_types_from_msg, get_typestore

_TRACKED = (
    "uint64 track_id\nbool is_occluded\nbool is_matched\nuint64 detection_id\n"
    "builtin_interfaces/Duration age\ngeometry_msgs/PoseWithCovariance pose\n"
    "geometry_msgs/TwistWithCovariance twist"
)
_FORCES = (
    "desired_force", "obstacle_force", "social_force", "group_coherence_force",
    "group_gaze_force", "group_repulsion_force", "random_force",
)  # fmt: skip
#: ``package/Name`` -> its fields.
_FIELDS: Mapping[str, str] = {
    "people_msgs/Person": (
        "string name\ngeometry_msgs/Point position\ngeometry_msgs/Point velocity\n"
        "float64 reliability\nstring[] tagnames\nstring[] tags"
    ),
    "people_msgs/People": "std_msgs/Header header\npeople_msgs/Person[] people",
    "people_msgs/PersonStamped": "std_msgs/Header header\npeople_msgs/Person person",
    "people_msgs/PositionMeasurement": (
        "std_msgs/Header header\nstring name\nstring object_id\ngeometry_msgs/Point pos\n"
        "float64 reliability\nfloat64[9] covariance\nbyte initialization"
    ),
    "people_msgs/PositionMeasurementArray": (
        "std_msgs/Header header\npeople_msgs/PositionMeasurement[] people\nfloat32[] cooccurrence"
    ),
    "pedsim_msgs/AgentForce": "\n".join(f"geometry_msgs/Vector3 {name}" for name in _FORCES),
    "pedsim_msgs/AgentState": (
        "std_msgs/Header header\nuint64 id\nuint16 type\nstring social_state\n"
        "geometry_msgs/Pose pose\ngeometry_msgs/Twist twist\npedsim_msgs/AgentForce forces"
    ),
    "pedsim_msgs/AgentStates": "std_msgs/Header header\npedsim_msgs/AgentState[] agent_states",
    "pedsim_msgs/TrackedPerson": _TRACKED,
    "pedsim_msgs/TrackedPersons": "std_msgs/Header header\npedsim_msgs/TrackedPerson[] tracks",
    "spencer_tracking_msgs/TrackedPerson": _TRACKED,
    "spencer_tracking_msgs/TrackedPersons": (
        "std_msgs/Header header\nspencer_tracking_msgs/TrackedPerson[] tracks"
    ),
    "hunav_msgs/Agent": (
        "int32 id\nuint8 type\nuint8 skin\nuint8 behavior\nstring name\nuint8 behavior_state\n"
        "int8 group_id\ngeometry_msgs/Pose position\nfloat32 yaw\ngeometry_msgs/Twist velocity\n"
        "float32 desired_velocity\nfloat32 radius\nfloat32 linear_vel\nfloat32 angular_vel\n"
        "geometry_msgs/Pose[] goals\nbool cyclic_goals\nfloat32 goal_radius\n"
        "geometry_msgs/Point[] closest_obs"
    ),
    "hunav_msgs/Agents": "std_msgs/Header header\nhunav_msgs/Agent[] agents",
    "derived_object_msgs/Object": (
        "std_msgs/Header header\nuint32 id\nuint8 detection_level\nbool object_classified\n"
        "geometry_msgs/Pose pose\ngeometry_msgs/Twist twist\ngeometry_msgs/Accel accel\n"
        "geometry_msgs/Polygon polygon\nshape_msgs/SolidPrimitive shape\nuint8 classification\n"
        "uint8 classification_certainty\nuint32 classification_age"
    ),
    "derived_object_msgs/ObjectArray": (
        "std_msgs/Header header\nderived_object_msgs/Object[] objects"
    ),
    "turtlesim/Pose": (
        "float32 x\nfloat32 y\nfloat32 theta\nfloat32 linear_velocity\nfloat32 angular_velocity"
    ),
}


@cache
def known_types() -> Any:
    """Return rosbags' types of ROS 2 Humble and those of this file."""
    store = get_typestore(Stores.ROS2_HUMBLE)
    types: dict[str, Any] = {}
    for name, text in _FIELDS.items():
        types.update(get_types_from_msg(text, name.replace("/", "/msg/")))
    store.register({name: fields for name, fields in types.items() if name not in store.fielddefs})
    return store
