"""Driven wheels in a recording: joint states, and frames that rotate with the wheels."""

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


class UrdfJoint(NamedTuple):
    """A joint of the robot's description: links, place (m), turn at angle 0, axis."""

    name: str
    kind: str
    parent: str
    child: str
    at: Vector
    rpy: Vector
    axis: Vector

    @property
    def turn(self) -> Quaternion:
        """Return the rotation at joint angle 0 as a quaternion x, y, z, w."""
        return quaternion(*self.rpy)


class WheelMessages:
    """Messages about the driven wheels, left and right, by their angles.

    Args:
        description: the robot's URDF.
        joints: names of the joints of the left and the right wheel.
        namespace: of the robot's frames.
    """

    def __init__(self, description: str, joints: Sequence[str], namespace: str) -> None:
        root = Xml.fromstring(description)  # noqa: S314 - written by crowdbot itself
        found = {joint.name: _named(joint, namespace) for joint in urdf_joints(root)}
        self._wheels = [found[name] for name in joints]
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
            name=[wheel.name for wheel in self._wheels],
            position=np.array(angles, np.float64),
            velocity=np.array(rates, np.float64),
            effort=np.zeros(0),
        )

    def frames(self, ns: int, angles: Sequence[float]) -> Any:
        """Return ``tf2_msgs/TFMessage`` with the frame of each wheel."""
        pairs = zip(self._wheels, angles, strict=True)
        return ros.transforms([_frame(ns, wheel, angle) for wheel, angle in pairs])


def urdf_joints(robot: Xml.Element) -> list[UrdfJoint]:
    """Return the joints of a URDF."""
    return [_joint(joint) for joint in robot.findall("joint")]


def _joint(joint: Xml.Element) -> UrdfJoint:
    origin, axis = joint.find("origin"), joint.find("axis")
    return UrdfJoint(
        name=joint.get("name", ""),
        kind=joint.get("type", ""),
        parent=_link(joint, "parent"),
        child=_link(joint, "child"),
        at=_three(origin, "xyz", "0 0 0"),
        rpy=_three(origin, "rpy", "0 0 0"),
        axis=_three(axis, "xyz", "1 0 0"),
    )


def _named(joint: UrdfJoint, namespace: str) -> UrdfJoint:
    parent, child = (in_namespace(namespace, end) for end in (joint.parent, joint.child))
    return joint._replace(parent=parent, child=child)


def _link(joint: Xml.Element, end: str) -> str:
    found = joint.find(end)
    return "" if found is None else found.get("link", "")


def _three(element: Xml.Element | None, key: str, default: str) -> Vector:
    text = default if element is None else element.get(key, default)
    x, y, z = (float(word) for word in text.split())
    return x, y, z


def _frame(ns: int, wheel: UrdfJoint, angle: float) -> Any:
    half = 0.5 * math.remainder(angle, 2.0 * math.pi)
    length = math.hypot(*wheel.axis)
    x, y, z = (math.sin(half) * part / length for part in wheel.axis)
    turned = _product(wheel.turn, (x, y, z, math.cos(half)))
    message = ros.transform(ns, wheel.parent, wheel.child, wheel.at, 0.0)
    x, y, z, w = turned
    message.transform.rotation = ros.new("geometry_msgs/Quaternion", x=x, y=y, z=z, w=w)
    return message


def _product(a: Quaternion, b: Quaternion) -> Quaternion:
    """Return the quaternion x, y, z, w of rotation b followed by rotation a."""
    ax, ay, az, aw = a
    bx, by, bz, bw = b
    return (
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
        aw * bw - ax * bx - ay * by - az * bz,
    )
