"""Definitions of crowdbot's own messages, in the ROS interface language."""

from __future__ import annotations

#: Definitions of messages that no ROS distribution contains. Tables are stored row by row.
DEFINITIONS = {
    "Table": "uint32[] shape\nfloat64[] data",
    "Sensor": (
        "string name\nstring category\nstring frame\nfloat64[4] mount\nfloat64 rate\n"
        "uint32[] shape\nstring ros_type\ncrowdbot_msgs/Table angles\n"
        "float64 range_min\nfloat64 range_max"
    ),
    "SensorTilts": "string[] sensor\nfloat64[] roll\nfloat64[] pitch",
    "PersonTask": (
        "string task\nint64[] person\nfloat64[] facing\nfloat64 distance\nfloat64 tolerance\n"
        "float64 angle\nfloat64 hold\nbool in_a_row\nstring knows\nstring side\n"
        "float64 radius"
    ),
    "RobotInfo": (
        "float64 radius\nfloat64 mass\ncrowdbot_msgs/Table goal\nfloat64 goal_radius\n"
        "float64 base_height\ncrowdbot_msgs/Table limits\ncrowdbot_msgs/Table footprint"
    ),
    "AgentsInfo": "int64[] id\nfloat64[] radius\nfloat64[] mass",
    "RunHeader": (
        "uint32 version\nstring scenario\nstring[] hash_names\nstring[] hashes\n"
        "crowdbot_msgs/RobotInfo[] robot\ncrowdbot_msgs/AgentsInfo[] agents\n"
        "crowdbot_msgs/Sensor[] sensors\ncrowdbot_msgs/Table walls\n"
        "crowdbot_msgs/Table goal_zone\ncrowdbot_msgs/Camera[] cameras\nstring[] privileged"
    ),
    "Camera": "string sensor\nuint32 width\nuint32 height\nfloat64 focal\nbool colour",
    "RunStates": (
        "uint32 first\nfloat64[] t\nfloat64[] robot\nbool[] has_jump\nuint8[] jump\n"
        "float64 gain\nuint8[] agents"
    ),
    "VelocityCandidates": (
        "crowdbot_msgs/Table unit\nfloat64 relaxation_time\nuint32[] person\n"
        "float64[] preferred_speed\nfloat64[] radius\nfloat64[] max_acceleration"
    ),
    "PersonGoals": "uint32[] sample\nuint32[] person\nfloat64[] x\nfloat64[] y",
    "RunEnd": "bool complete\nstring status\nbool arrived\nfloat64 goal_time",
    "Trip": "int64 agent\nfloat64 t0\nfloat64 t1\nbool reached",
    "Series": "string name\nfloat64[] t\nfloat64[] value",
    "Drawing": "std_msgs/Header header\nstring name\nuint32 columns\nfloat32[] data",
    "DrawnTexts": (
        "std_msgs/Header header\nstring name\nuint32 columns\nfloat32[] data\nstring[] texts"
    ),
    "Contact": (
        "std_msgs/Header header\nfloat64 t0\nfloat64 t1\nint64 agent\nfloat64 impulse\n"
        "float64 peak_force\nfloat64 relative_speed\nfloat64 bearing"
    ),
    "Pedestrians": (
        "std_msgs/Header header\nint64[] id\nfloat32[] x\nfloat32[] y\nfloat32[] vx\n"
        "float32[] vy\nfloat32[] heading\nfloat32[] radius"
    ),
}
#: Messages of live connections, which recordings do not contain.
LIVE_DEFINITIONS = {
    "Reading": "string sensor\nfloat64 stamp\ncrowdbot_msgs/Table values",
    "Observation": (
        "std_msgs/Header header\nfloat64 t\nfloat64[3] pose\nfloat64[3] twist\n"
        "crowdbot_msgs/Reading[] readings"
    ),
    "Task": (
        "string scenario\nint64 seed\nfloat64[3] start\nfloat64[2] goal\n"
        "crowdbot_msgs/Table goal_zone\nfloat64 time_limit\ncrowdbot_msgs/Table limits\n"
        "crowdbot_msgs/Sensor[] sensors"
    ),
    "LiveStatus": (
        "string scenario\nuint32 run\nint64 seed\nstring state\nfloat64 t\nfloat64 lag\n"
        "uint32 steps\nuint32 missed"
    ),
}
