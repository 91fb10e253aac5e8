"""Serialised messages with replaceable bytes.

rosbags serialises a message field by field, which takes about 20 us. A message of fixed size is
serialised once, with recognisable numbers in the variable places; after that only these places are
written.
"""

from __future__ import annotations

from collections.abc import Sequence
from struct import Struct
from typing import Any

import numpy as np

import crowdbot.core.recording.messages as ros
from crowdbot.core.types.arrays import Array
from crowdbot.core.types.motion import Pose
from crowdbot.core.types.sensor import SensorInfo

_STAMP = Struct("<iI")
_ONE, _TWO = Struct("<d"), Struct("<2d")
#: A recognisable time (ns), and recognisable numbers.
ANY_TIME = 0x11223344 * 10**9 + 0x12345678
_A, _B, _C, _D, _E, _F = 1.0625, 2.125, 3.1875, 4.25, 5.3125, 6.375

one, two = _ONE.pack, _TWO.pack
#: Person, start, end (s) and goal reached, as in a trip.
whole_trip = Struct("<q2d?").pack


def stamp(ns: int) -> bytes:
    """Return a ROS time; 0, which tf2 treats as "the latest", becomes a nanosecond."""
    return _STAMP.pack(ns // 10**9, ns % 10**9 if ns else 1)


def turn(yaw: float) -> bytes:
    """Return z and w of the quaternion of a rotation about z."""
    return two(*ros.half_turn(yaw))


#: Unknown covariances of pose and twist.
NO_COVARIANCE = bytes(288), bytes(288)
#: `ANY_TIME` as serialised.
ANY_STAMP = stamp(ANY_TIME)


class Template:
    """One serialised message and its variable places.

    Attributes:
        msgtype: ``package/msg/Name``.
    """

    def __init__(self, message: Any, *marks: bytes) -> None:
        """Find the places.

        Args:
            message: one message with the right size and constants.
            marks: bytes of ``message`` in the variable places, in order.
        """
        self.msgtype = str(message.__msgtype__)
        data = ros.to_cdr(message)
        self._size = end = len(data)
        pieces = list[bytes | memoryview]()
        for mark in reversed(marks):
            begin = data.rindex(mark, 0, end)
            pieces += [data[begin + len(mark) : end], mark]
            end = begin
        self._pieces = [*reversed([*pieces, data[:end]])]

    def fill(self, *parts: bytes | memoryview) -> bytes:
        """Return the message with other bytes in its places.

        Raises:
            ValueError: number or total length of the parts is wrong.
        """
        self._pieces[1::2] = parts
        data = b"".join(self._pieces)
        self._check(len(data))
        return data

    def pieces(self, *parts: bytes | memoryview) -> list[bytes | memoryview]:
        """Return the message as `fill`, in parts of bytes. Valid until the next message."""
        self._pieces[1::2] = parts
        self._check(sum(map(len, self._pieces)))
        return self._pieces

    def _check(self, size: int) -> None:
        if size != self._size:
            raise ValueError(f"{self.msgtype} of {size} bytes instead of {self._size}")


def clock() -> Template:
    """Return a clock. Place: stamp."""
    return Template(ros.clock(ANY_TIME), ANY_STAMP)


def trip() -> Template:
    """Return a trip. Place: `whole_trip`."""
    message = ros.new("crowdbot_msgs/Trip", agent=1, t0=_A, t1=_B, reached=True)
    return Template(message, whole_trip(1, _A, _B, True))


def twist() -> Template:
    """Return a twist. Places: v and vy; w."""
    return Template(ros.twist(_A, _B, _C), two(_A, _B), one(_C))


def pose_stamped(frame: str) -> Template:
    """Return a pose. Places: stamp; x and y; turn."""
    message = ros.pose_stamped(ANY_TIME, frame, Pose(_A, _B, _C))
    return Template(message, ANY_STAMP, two(_A, _B), turn(_C))


def transform(parent: str, child: str) -> Template:
    """Return one transform on the floor. Places: stamp; x and y; turn."""
    message = ros.transforms([ros.transform(ANY_TIME, parent, child, (_A, _B, 0.0), _C)])
    return Template(message, ANY_STAMP, two(_A, _B), turn(_C))


def odometry(child: str, frame: str = "odom") -> Template:
    """Return odometry. Places: stamp; x, y; turn; pose covariance; v, vy; w; twist covariance."""
    pose, speed = np.full(36, _A), np.full(36, _B)
    message = ros.odometry(
        ANY_TIME, child, np.array([_A, _B, _C, _D, _E, _F]), (pose, speed), frame
    )
    marks = two(_A, _B), turn(_C), pose.tobytes(), two(_D, _F), one(_E), speed.tobytes()
    return Template(message, ANY_STAMP, *marks)


def laser_scan(info: SensorInfo, angles: Array) -> Template:
    """Return a scan. Places: stamp; ranges as float32."""
    ranges = np.full(len(angles), _A)
    mark = ranges.astype(np.float32).tobytes()
    return Template(ros.laser_scan(ANY_TIME, info, angles, ranges), ANY_STAMP, mark)


def range_reading(info: SensorInfo) -> Template:
    """Return a range. Places: stamp; range as float32."""
    return Template(ros.range_reading(ANY_TIME, info, _A), ANY_STAMP, np.float32(_A).tobytes())


def point_cloud(info: SensorInfo) -> Template:
    """Return a point cloud. Places: stamp; x, y, z of every point as float32."""
    points = np.full((*info.shape, 3), _A, np.float32)
    return Template(ros.point_cloud(ANY_TIME, info, points), ANY_STAMP, points.tobytes())


def imu(frame: str, deviations: Sequence[float]) -> Template:
    """Return an IMU message. Places: stamp; angular rate; specific force; three float64 each."""
    values = np.array([_A, _B, _C, _C, _D, _E])
    marks = values[:3].tobytes(), values[3:].tobytes()
    return Template(ros.imu(ANY_TIME, frame, values, deviations), ANY_STAMP, *marks)


def wrench(frame: str) -> Template:
    """Return a wrench. Places: stamp; force x, y; torque about z; float64 each."""
    values = np.array([_A, _B, _C])
    marks = values[:2].tobytes(), values[2:].tobytes()
    return Template(ros.wrench(ANY_TIME, frame, values), ANY_STAMP, *marks)


def numbers(shape: tuple[int, ...]) -> Template:
    """Return an array of numbers. Place: values."""
    values = np.full(shape, _A)
    return Template(ros.numbers(values), values.tobytes())


def pedestrians(count: int) -> Template:
    """Return pedestrians. Places: stamp; id (int64); x, y, vx, vy, heading, radius (float32)."""
    names = ("x", "y", "vx", "vy", "heading", "radius")
    columns = {n: np.full(count, k, np.float32) for k, n in enumerate(names, 1)}
    ids = np.full(count, 0x1122334455667788, np.int64)
    head = ros.header(ANY_TIME, "map")
    message = ros.new("crowdbot_msgs/Pedestrians", header=head, id=ids, **columns)
    marks = [c.tobytes() for c in columns.values()]
    return Template(message, ANY_STAMP, ids.tobytes(), *marks)
