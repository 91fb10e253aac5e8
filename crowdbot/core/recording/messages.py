"""ROS 2 message types of a recording: standard ones, and crowdbot's own.

Serialisation is rosbags'. Messages are plain objects of its type store; `new` makes one by name.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

from crowdbot.core.types.arrays import Array
from crowdbot.core.types.motion import Pose
from crowdbot.core.types.sensor import SensorInfo

#: Definitions of the messages that no ROS distribution has. Arrays of tables are row by row.
DEFINITIONS = {
    "Table": "uint32[] shape\nfloat64[] data",
    "Sensor": (
        "string name\nstring category\nstring frame\nfloat64[4] mount\nfloat64 rate\n"
        "uint32[] shape\nstring ros_type\ncrowdbot_msgs/Table angles\n"
        "float64 range_min\nfloat64 range_max"
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
    "RunEnd": "bool complete\nstring status\nbool arrived\nfloat64 goal_time",
    "Trip": "int64 agent\nfloat64 t0\nfloat64 t1\nbool reached",
    "Series": "string name\nfloat64[] t\nfloat64[] value",
    "Contact": (
        "std_msgs/Header header\nfloat64 t0\nfloat64 t1\nint64 agent\nfloat64 impulse\n"
        "float64 peak_force\nfloat64 relative_speed\nfloat64 bearing"
    ),
    "Pedestrians": (
        "std_msgs/Header header\nint64[] id\nfloat32[] x\nfloat32[] y\nfloat32[] vx\n"
        "float32[] vy\nfloat32[] heading\nfloat32[] radius"
    ),
}
#: Messages of live connections, which no recording holds.
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
#: Messages of formats 1 and 2, which are read and not written any more.
OLD_DEFINITIONS = {
    "RunState": "float64 t\nfloat64[] robot\nfloat64[] agents\nbool has_jump\nbool[] jump",
    "Signal": "float64 t\nstring name\nfloat64 value",
}
#: Fields that messages of format 1 end before.
_SINCE_2 = {
    "RunHeader": "\ncrowdbot_msgs/Camera[] cameras\nstring[] privileged",
    "Contact": "\nfloat64 bearing",
}
_NO_COVARIANCE = np.zeros(36)


@cache
def _store(*, oldest: bool = False) -> Any:
    store = get_typestore(Stores.ROS2_HUMBLE)
    types: dict[str, Any] = {}
    for name, text in {**DEFINITIONS, **LIVE_DEFINITIONS, **OLD_DEFINITIONS}.items():
        since = _SINCE_2.get(name, "") if oldest else ""
        types.update(get_types_from_msg(text.removesuffix(since), f"crowdbot_msgs/msg/{name}"))
    store.register(types)
    return store


def ros2_store() -> Any:
    """The types of a recording, for rosbags."""
    return _store()


@cache
def ros1_store() -> Any:
    """The types of ROS 1 noetic, and crowdbot's."""
    store = get_typestore(Stores.ROS1_NOETIC)
    types: dict[str, Any] = {}
    for name, text in {**DEFINITIONS, **OLD_DEFINITIONS}.items():
        types.update(get_types_from_msg(text, f"crowdbot_msgs/msg/{name}"))
    store.register(types)
    return store


def new(kind: str, **fields: Any) -> Any:
    """A message of type ``package/Name``."""
    return _type(kind)(**fields)


@cache
def _type(kind: str) -> Any:
    package, _, name = kind.partition("/")
    return _store().types[f"{package}/msg/{name}"]


def definition(msgtype: str) -> bytes:
    """The text of a type and of all it consists of, as MCAP's ``ros2msg`` encoding wants it."""
    return str(_store().generate_msgdef(msgtype, ros_version=2)[0]).encode()


def message_type(msgtype: str) -> Any:
    """The class of a type; both ``package/Name`` and ``package/msg/Name`` are understood.

    Raises:
        KeyError: there is no such type.
    """
    package, _, name = msgtype.replace("/msg/", "/").partition("/")
    return _store().types[f"{package}/msg/{name}"]


def field_types(msgtype: str) -> dict[str, str] | None:
    """Field -> type (``float32[]``, ``float64[36]``, ``std_msgs/Header``); None: no such type."""
    package, _, name = msgtype.replace("/msg/", "/").partition("/")
    found = _store().fielddefs.get(f"{package}/msg/{name}")
    if found is None:
        return None
    return {field: _field_type(*kind) for field, kind in found[1]}


def _field_type(node: Any, what: Any) -> str:
    if node.name == "NAME":
        return str(what).replace("/msg/", "/")
    if node.name == "BASE":
        return str(what[0])
    (inner, size) = what
    return f"{_field_type(*inner)}[{size if node.name == 'ARRAY' else ''}]"


def definition_text(msgtype: str, ros_version: int) -> str:
    """The text of a type and of all it consists of; of ROS 1 or ROS 2."""
    package, _, name = msgtype.replace("/msg/", "/").partition("/")
    full = f"{package}/msg/{name}"
    return str(_store().generate_msgdef(full, ros_version=ros_version)[0])


def type_hash(msgtype: str) -> str:
    """The hash by which ROS 2 tells versions of a type apart: ``RIHS01_`` and 64 hex digits."""
    return f"RIHS01_{_store().hash_rihs01(msgtype).removeprefix('RIHS01_')}"


def to_cdr(message: Any) -> bytes:
    """Serialise (little-endian CDR with its four byte head)."""
    return bytes(_store().serialize_cdr(message, message.__msgtype__))


def to_ros1(data: bytes, msgtype: str) -> bytes:
    """CDR as ROS 1 has the same message; ``crowdbot_msgs`` too."""
    return bytes(_store().cdr_to_ros1(data, msgtype))


def from_cdr(data: bytes, msgtype: str) -> Any:
    """Deserialise; raises whatever the decoder stumbles over.

    A message of format 1 lacks the attributes that came later.
    """
    try:
        return _store().deserialize_cdr(data, msgtype)
    except Exception:  # the decoder is generated code; anything may surface
        if msgtype.removeprefix("crowdbot_msgs/msg/") not in _SINCE_2:
            raise
    return _store(oldest=True).deserialize_cdr(data, msgtype)


def nanoseconds(t: float) -> int:
    """Simulated seconds (>= 0) as MCAP and ROS count them."""
    return round(t * 1e9)


def clock(ns: int) -> Any:
    """Simulated time."""
    return new("rosgraph_msgs/Clock", clock=_time(ns))


def header(ns: int, frame: str) -> Any:
    """Stamp and frame."""
    return new("std_msgs/Header", stamp=_time(ns), frame_id=frame)


def twist(v: float, vy: float, w: float) -> Any:
    """Body velocity, m/s and rad/s."""
    return new("geometry_msgs/Twist", linear=_vector(v, vy, 0.0), angular=_vector(0.0, 0.0, w))


def pose_stamped(ns: int, frame: str, pose: Pose) -> Any:
    """A pose in the plane."""
    return new("geometry_msgs/PoseStamped", header=header(ns, frame), pose=_pose(*pose))


def transform(ns: int, parent: str, child: str, xyz: tuple[float, float, float], yaw: float) -> Any:
    """Pose of ``child`` in ``parent``."""
    placed = new("geometry_msgs/Transform", translation=_vector(*xyz), rotation=_quaternion(yaw))
    return new(
        "geometry_msgs/TransformStamped",
        header=header(ns, parent),
        child_frame_id=child,
        transform=placed,
    )


def transforms(items: Iterable[Any]) -> Any:
    """Several transforms in one message."""
    return new("tf2_msgs/TFMessage", transforms=list(items))


def odometry(ns: int, child: str, values: Array, frame: str = "odom") -> Any:
    """What the robot believes: x, y, yaw, v, w, and perhaps vy, in its frame ``odom``."""
    x, y, yaw, v, w, *aside = values.tolist()
    vy = aside[0] if aside else 0.0
    pose = new("geometry_msgs/PoseWithCovariance", pose=_pose(x, y, yaw), covariance=_NO_COVARIANCE)
    speed = new(
        "geometry_msgs/TwistWithCovariance", twist=twist(v, vy, w), covariance=_NO_COVARIANCE
    )
    return new(
        "nav_msgs/Odometry",
        header=header(ns, frame),
        child_frame_id=child,
        pose=pose,
        twist=speed,
    )


def laser_scan(ns: int, info: SensorInfo, angles: Array, ranges: Array) -> Any:
    """A scan of evenly spaced ``angles`` (R,), rad; ``ranges`` (R,) m, inf where nothing is."""
    step = (angles[-1] - angles[0]) / max(len(angles) - 1, 1)
    return new(
        "sensor_msgs/LaserScan",
        header=header(ns, info.frame),
        angle_min=float(angles[0]),
        angle_max=float(angles[-1]),
        angle_increment=float(step),
        time_increment=0.0,
        scan_time=1.0 / info.rate,
        range_min=info.range_min,
        range_max=info.range_max,
        ranges=ranges.astype(np.float32),
        intensities=np.zeros(0, np.float32),
    )


def range_reading(ns: int, info: SensorInfo, distance: float) -> Any:
    """The reading of a sonar or an infrared sensor; ``distance`` m, inf where nothing is."""
    edges = np.zeros(2) if info.angles is None else info.angles
    cls = _type("sensor_msgs/Range")
    return cls(
        header=header(ns, info.frame),
        radiation_type=cls.INFRARED if info.category == "infrared" else cls.ULTRASOUND,
        field_of_view=float(np.ptp(edges)),
        min_range=info.range_min,
        max_range=info.range_max,
        range=distance,
    )


def point_cloud(ns: int, info: SensorInfo, points: NDArray[np.float32]) -> Any:
    """An organised cloud; ``points`` (L, C, 3) in the sensor frame, m, NaN where nothing is."""
    rows, columns, _ = points.shape
    field, number = _type("sensor_msgs/PointField"), points.itemsize
    fields = [
        new("sensor_msgs/PointField", name=n, offset=k * number, datatype=field.FLOAT32, count=1)
        for k, n in enumerate("xyz")
    ]
    return new(
        "sensor_msgs/PointCloud2",
        header=header(ns, info.frame),
        height=rows,
        width=columns,
        fields=fields,
        is_bigendian=False,
        point_step=3 * number,
        row_step=3 * number * columns,
        data=np.frombuffer(points.tobytes(), np.uint8),
        is_dense=False,
    )


def imu(ns: int, frame: str, values: Array) -> Any:
    """Angular rate (3), rad/s, and specific force (3), m/s^2; the orientation is not measured."""
    unknown = np.zeros(9)
    return new(
        "sensor_msgs/Imu",
        header=header(ns, frame),
        orientation=_quaternion(0.0),
        orientation_covariance=np.array([-1.0, *unknown[1:]]),
        angular_velocity=_vector(*values[:3].tolist()),
        angular_velocity_covariance=unknown,
        linear_acceleration=_vector(*values[3:].tolist()),
        linear_acceleration_covariance=unknown,
    )


def wrench(ns: int, frame: str, values: Array) -> Any:
    """Horizontal force x, y (N) and torque about z (N m)."""
    x, y, torque = values.tolist()
    pushed = new("geometry_msgs/Wrench", force=_vector(x, y, 0.0), torque=_vector(0.0, 0.0, torque))
    return new("geometry_msgs/WrenchStamped", header=header(ns, frame), wrench=pushed)


def numbers(values: Array) -> Any:
    """The values of a sensor of unknown category, flattened row by row."""
    dims, stride = [], values.size
    for size in values.shape:
        dims.append(new("std_msgs/MultiArrayDimension", label="", size=size, stride=stride))
        stride //= max(size, 1)
    layout = new("std_msgs/MultiArrayLayout", dim=dims, data_offset=0)
    flat = np.ascontiguousarray(values, np.float64).ravel()
    return new("std_msgs/Float64MultiArray", layout=layout, data=flat)


def polygon(ns: int, corners: Array) -> Any:
    """A polygon on the floor; (K, 2), m."""
    points = [new("geometry_msgs/Point32", x=x, y=y, z=0.0) for x, y in corners.tolist()]
    return new(
        "geometry_msgs/PolygonStamped",
        header=header(ns, "map"),
        polygon=new("geometry_msgs/Polygon", points=points),
    )


def marker(
    ns: int,
    namespace: str,
    kind: str,
    size: tuple[float, float, float],
    rgba: tuple[float, float, float, float],
    points: Array,
) -> Any:
    """A list marker in the map frame; ``points`` (K, 3), m; ``kind`` as in Marker.msg."""
    cls = _type("visualization_msgs/Marker")
    return cls(
        header=header(ns, "map"),
        ns=namespace,
        id=0,
        type=getattr(cls, kind),
        action=cls.ADD,
        pose=_pose(0.0, 0.0, 0.0),
        scale=_vector(*size),
        color=new("std_msgs/ColorRGBA", **dict(zip("rgba", rgba, strict=True))),
        lifetime=new("builtin_interfaces/Duration", sec=0, nanosec=0),
        frame_locked=False,
        points=[_point(x, y, z) for x, y, z in points.tolist()],
        colors=[],
        texture_resource="",
        texture=new(
            "sensor_msgs/CompressedImage",
            header=header(0, ""),
            format="",
            data=np.zeros(0, np.uint8),
        ),
        uv_coordinates=[],
        text="",
        mesh_resource="",
        mesh_file=new("visualization_msgs/MeshFile", filename="", data=np.zeros(0, np.uint8)),
        mesh_use_embedded_materials=False,
    )


def marker_array(markers: Iterable[Any]) -> Any:
    """Several markers in one message."""
    return new("visualization_msgs/MarkerArray", markers=list(markers))


def delete_all_markers() -> Any:
    """A marker that takes away those before it."""
    gone = marker(0, "", "CUBE", (1.0, 1.0, 1.0), (0.0, 0.0, 0.0, 0.0), np.zeros((0, 3)))
    gone.action = gone.DELETEALL
    return gone


def plane_pose(pose: Pose) -> Any:
    """A pose on the floor as ``geometry_msgs/Pose``."""
    return _pose(*pose)


def table(values: ArrayLike | None) -> Any:
    """An array of any shape with at least one axis; None becomes a table without axes."""
    if values is None:
        return new("crowdbot_msgs/Table", shape=np.zeros(0, np.uint32), data=np.zeros(0))
    array = np.ascontiguousarray(values, np.float64)
    shape = np.array(array.shape, np.uint32)
    return new("crowdbot_msgs/Table", shape=shape, data=array.ravel())


def from_table(message: Any) -> Array | None:
    """Inverse of `table`."""
    data: NDArray[np.float64] = message.data
    return data.reshape(message.shape.tolist()) if message.shape.size else None


def _time(ns: int) -> Any:
    return new("builtin_interfaces/Time", sec=ns // 10**9, nanosec=ns % 10**9)


def _vector(x: float, y: float, z: float) -> Any:
    return new("geometry_msgs/Vector3", x=x, y=y, z=z)


def _point(x: float, y: float, z: float) -> Any:
    return new("geometry_msgs/Point", x=x, y=y, z=z)


def half_turn(yaw: float) -> tuple[float, float]:
    """Last two numbers, z and w, of the quaternion of a turn about z."""
    return math.sin(0.5 * yaw), math.cos(0.5 * yaw)


def _quaternion(yaw: float) -> Any:
    z, w = half_turn(yaw)
    return new("geometry_msgs/Quaternion", x=0.0, y=0.0, z=z, w=w)


def _pose(x: float, y: float, yaw: float) -> Any:
    return new("geometry_msgs/Pose", position=_point(x, y, 0.0), orientation=_quaternion(yaw))
