"""ROS 2 messages of a recording, from numbers: times, poses, readings, tables."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from crowdbot.core.geometry.rotation import quaternion
from crowdbot.core.recording.typestore import declare as declare
from crowdbot.core.recording.typestore import definition as definition
from crowdbot.core.recording.typestore import definition_text as definition_text
from crowdbot.core.recording.typestore import field_types as field_types
from crowdbot.core.recording.typestore import from_cdr as from_cdr
from crowdbot.core.recording.typestore import message_class as message_class
from crowdbot.core.recording.typestore import message_type as message_type
from crowdbot.core.recording.typestore import new as new
from crowdbot.core.recording.typestore import ros1_store as ros1_store
from crowdbot.core.recording.typestore import ros2_store as ros2_store
from crowdbot.core.recording.typestore import to_cdr as to_cdr
from crowdbot.core.recording.typestore import to_ros1 as to_ros1
from crowdbot.core.recording.typestore import type_hash as type_hash
from crowdbot.core.types.arrays import Array
from crowdbot.core.types.motion import Pose
from crowdbot.core.types.sensor import SensorInfo

_NO_COVARIANCE = np.zeros(36)


def nanoseconds(t: float) -> int:
    """Convert simulated seconds (>= 0) to nanoseconds, as in MCAP and ROS."""
    return round(t * 1e9)


def clock(ns: int) -> Any:
    """Return simulated time as a message."""
    return new("rosgraph_msgs/Clock", clock=_time(ns))


def header(ns: int, frame: str) -> Any:
    """Return stamp and frame."""
    return new("std_msgs/Header", stamp=_time(ns), frame_id=frame)


def twist(v: float, vy: float, w: float) -> Any:
    """Return body velocity, m/s and rad/s."""
    return new("geometry_msgs/Twist", linear=vector(v, vy, 0.0), angular=vector(0.0, 0.0, w))


def pose_stamped(ns: int, frame: str, pose: Pose) -> Any:
    """Return a pose in the plane."""
    return new("geometry_msgs/PoseStamped", header=header(ns, frame), pose=_pose(*pose))


def transform(
    ns: int,
    parent: str,
    child: str,
    xyz: tuple[float, float, float],
    yaw: float,
    tilt: tuple[float, float] = (0.0, 0.0),
) -> Any:
    """Return the pose of ``child`` in ``parent``; ``tilt`` is its roll and pitch, rad."""
    turned = _quaternion(yaw)
    if any(tilt):
        x, y, z, w = quaternion(*tilt, yaw)
        turned = new("geometry_msgs/Quaternion", x=x, y=y, z=z, w=w)
    placed = new("geometry_msgs/Transform", translation=vector(*xyz), rotation=turned)
    return new(
        "geometry_msgs/TransformStamped",
        header=header(ns, parent),
        child_frame_id=child,
        transform=placed,
    )


def transforms(items: Iterable[Any]) -> Any:
    """Return several transforms in one message."""
    return new("tf2_msgs/TFMessage", transforms=list(items))


def odometry(
    ns: int,
    child: str,
    values: Array,
    covariances: tuple[Array, Array] | None = None,
    frame: str = "odom",
) -> Any:
    """Return the robot's estimate: x, y, yaw, v, w, and perhaps vy, in its frame ``odom``.

    Args:
        covariances: covariances of pose and twist, (36,) each, as in ``nav_msgs/Odometry``; None:
            unknown.
    """
    x, y, yaw, v, w, *aside = values.tolist()
    vy = aside[0] if aside else 0.0
    of_pose, of_twist = covariances or (_NO_COVARIANCE, _NO_COVARIANCE)
    pose = new("geometry_msgs/PoseWithCovariance", pose=_pose(x, y, yaw), covariance=of_pose)
    speed = new("geometry_msgs/TwistWithCovariance", twist=twist(v, vy, w), covariance=of_twist)
    return new(
        "nav_msgs/Odometry",
        header=header(ns, frame),
        child_frame_id=child,
        pose=pose,
        twist=speed,
    )


def laser_scan(ns: int, info: SensorInfo, angles: Array, ranges: Array) -> Any:
    """Return a scan of evenly spaced ``angles`` (R,), rad; ``ranges`` (R,) m, inf for no hit."""
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
    """Return the reading of an ultrasonic or infrared sensor; ``distance`` m, inf for no hit."""
    edges = np.zeros(2) if info.angles is None else info.angles
    cls = message_class("sensor_msgs/Range")
    return cls(
        header=header(ns, info.frame),
        radiation_type=cls.INFRARED if info.category == "infrared" else cls.ULTRASOUND,
        field_of_view=float(np.ptp(edges)),
        min_range=info.range_min,
        max_range=info.range_max,
        range=distance,
    )


def point_cloud(ns: int, info: SensorInfo, points: NDArray[np.float32]) -> Any:
    """Return an organised cloud; ``points`` (L, C, 3) in the sensor frame, m, NaN for no hit."""
    rows, columns, _ = points.shape
    field, number = message_class("sensor_msgs/PointField"), points.itemsize
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


def imu(ns: int, frame: str, values: Array, deviations: Sequence[float]) -> Any:
    """Return angular rate (3), rad/s, and specific force (3), m/s^2; without orientation.

    Args:
        deviations: (6,) standard deviations of the values; 0: unknown.
    """
    unknown = np.zeros(9)
    rate, force = (np.diag(np.square(part)).ravel() for part in (deviations[:3], deviations[3:]))
    return new(
        "sensor_msgs/Imu",
        header=header(ns, frame),
        orientation=_quaternion(0.0),
        orientation_covariance=np.array([-1.0, *unknown[1:]]),
        angular_velocity=vector(*values[:3].tolist()),
        angular_velocity_covariance=rate,
        linear_acceleration=vector(*values[3:].tolist()),
        linear_acceleration_covariance=force,
    )


def wrench(ns: int, frame: str, values: Array) -> Any:
    """Return horizontal force x, y (N) and torque about z (N m)."""
    x, y, torque = values.tolist()
    pushed = new("geometry_msgs/Wrench", force=vector(x, y, 0.0), torque=vector(0.0, 0.0, torque))
    return new("geometry_msgs/WrenchStamped", header=header(ns, frame), wrench=pushed)


def numbers(values: Array) -> Any:
    """Return the values of a sensor of unknown category, flattened row by row."""
    dims, stride = [], values.size
    for size in values.shape:
        dims.append(new("std_msgs/MultiArrayDimension", label="", size=size, stride=stride))
        stride //= max(size, 1)
    layout = new("std_msgs/MultiArrayLayout", dim=dims, data_offset=0)
    flat = np.ascontiguousarray(values, np.float64).ravel()
    return new("std_msgs/Float64MultiArray", layout=layout, data=flat)


def plane_pose(pose: Pose) -> Any:
    """Return a pose on the floor as ``geometry_msgs/Pose``."""
    return _pose(*pose)


def table(values: ArrayLike | None) -> Any:
    """Return an array with at least one axis as a table; None gives a table without axes."""
    if values is None:
        return new("crowdbot_msgs/Table", shape=np.zeros(0, np.uint32), data=np.zeros(0))
    array = np.ascontiguousarray(values, np.float64)
    shape = np.array(array.shape, np.uint32)
    return new("crowdbot_msgs/Table", shape=shape, data=array.ravel())


def from_table(message: Any) -> Array | None:
    """Return the array of a `table` message."""
    data: NDArray[np.float64] = message.data
    return data.reshape(message.shape.tolist()) if message.shape.size else None


def _time(ns: int) -> Any:
    return new("builtin_interfaces/Time", sec=ns // 10**9, nanosec=ns % 10**9)


def vector(x: float, y: float, z: float) -> Any:
    """Return a ``geometry_msgs/Vector3``."""
    return new("geometry_msgs/Vector3", x=x, y=y, z=z)


def point(x: float, y: float, z: float) -> Any:
    """Return a ``geometry_msgs/Point``."""
    return new("geometry_msgs/Point", x=x, y=y, z=z)


def half_turn(yaw: float) -> tuple[float, float]:
    """Return z and w of the quaternion of a rotation about z."""
    return math.sin(0.5 * yaw), math.cos(0.5 * yaw)


def _quaternion(yaw: float) -> Any:
    z, w = half_turn(yaw)
    return new("geometry_msgs/Quaternion", x=0.0, y=0.0, z=z, w=w)


def _pose(x: float, y: float, yaw: float) -> Any:
    return new("geometry_msgs/Pose", position=point(x, y, 0.0), orientation=_quaternion(yaw))
