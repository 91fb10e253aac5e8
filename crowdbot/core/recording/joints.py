"""Driven wheels in a recording: their joint states, and the frames that turn with them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, NamedTuple
from xml.etree import ElementTree as Xml

import numpy as np

import crowdbot.core.recording.messages as ros
from crowdbot.core.geometry.rotation import quaternion
from crowdbot.core.recording.namespace import in_namespace

Vector = tuple[float, float, float]
Quaternion = tuple[float, float, float, float]


class _Wheel(NamedTuple):
    """A joint of the robot's description: frames, place (m), turn at angle 0, axis."""

    joint: str
    parent: str
    child: str
    at: Vector
    turn: Quaternion
    axis: Vector


class WheelMessages:
    """Messages about the driven wheels, left and right, by their angles.

    Args:
        description: the robot's URDF.
        joints: names of the joints of the left and the right wheel.
        namespace: of the robot's frames.
    """

    def __init__(self, description: str, joints: Sequence[str], namespace: str) -> None:
        self._wheels = [_wheel(description, name, namespace) for name in joints]
        self._before: tuple[int, Sequence[float]] | None = None

    def states(self, ns: int, angles: Sequence[float]) -> Any:
        """Return ``sensor_msgs/JointState``: angles, rad, and mean rates since the last ones."""
        rates = [0.0] * len(self._wheels)
        if self._before is not None and ns > self._before[0]:
            dt = (ns - self._before[0]) / 1e9
            rates = [(b - a) / dt for a, b in zip(self._before[1], angles, strict=True)]
        self._before = ns, tuple(angles)
        return ros.new(
            "sensor_msgs/JointState",
            header=ros.header(ns, ""),
            name=[wheel.joint for wheel in self._wheels],
            position=np.array(angles, np.float64),
            velocity=np.array(rates, np.float64),
            effort=np.zeros(0),
        )

    def frames(self, ns: int, angles: Sequence[float]) -> Any:
        """Return ``tf2_msgs/TFMessage`` with the frame of each wheel."""
        pairs = zip(self._wheels, angles, strict=True)
        return ros.transforms([_frame(ns, wheel, angle) for wheel, angle in pairs])


def _wheel(description: str, name: str, namespace: str) -> _Wheel:
    root = Xml.fromstring(description)  # noqa: S314 - written by crowdbot itself
    joint = next(j for j in root.iter("joint") if j.get("name") == name)
    origin, axis = joint.find("origin"), joint.find("axis")
    rpy = _three(origin, "rpy", "0 0 0")
    return _Wheel(
        joint=name,
        parent=in_namespace(namespace, _link(joint, "parent")),
        child=in_namespace(namespace, _link(joint, "child")),
        at=_three(origin, "xyz", "0 0 0"),
        turn=quaternion(*rpy),
        axis=_three(axis, "xyz", "1 0 0"),
    )


def _link(joint: Xml.Element, end: str) -> str:
    found = joint.find(end)
    return "" if found is None else found.get("link", "")


def _three(element: Xml.Element | None, key: str, default: str) -> Vector:
    text = default if element is None else element.get(key, default)
    x, y, z = (float(word) for word in text.split())
    return x, y, z


def _frame(ns: int, wheel: _Wheel, angle: float) -> Any:
    half = 0.5 * math.remainder(angle, 2.0 * math.pi)
    length = math.hypot(*wheel.axis)
    x, y, z = (math.sin(half) * part / length for part in wheel.axis)
    turned = _product(wheel.turn, (x, y, z, math.cos(half)))
    message = ros.transform(ns, wheel.parent, wheel.child, wheel.at, 0.0)
    x, y, z, w = turned
    message.transform.rotation = ros.new("geometry_msgs/Quaternion", x=x, y=y, z=z, w=w)
    return message


def _product(a: Quaternion, b: Quaternion) -> Quaternion:
    """Return the rotation b, then a; x, y, z, w."""
    ax, ay, az, aw = a
    bx, by, bz, bw = b
    return (
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
        aw * bw - ax * bx - ay * by - az * bz,
    )
