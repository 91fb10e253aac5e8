"""Robots as URDF, for the tools of ROS: the body, and a frame for each sensor.

A robot is described in SDFormat or URDF (`RobotModel.sdf`). Both write poses as x, y, z, roll,
pitch, yaw about fixed axes; they differ in where joints stand: a URDF joint is its child's frame.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from xml.etree import ElementTree as Xml

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.interfaces import RobotModel, SensorInfo
from crowdbot.core.optical import OPTICAL_RPY, optical
from crowdbot.errors import InputError

Array = NDArray[np.float64]
FOOTPRINT = "base_footprint"
LEVEL = (0.0, 0.0, 0.0)
_SHAPES = ("box", "cylinder", "sphere", "capsule", "mesh")


def to_urdf(robot: RobotModel, sensors: Mapping[str, SensorInfo], name: str) -> str:
    """The URDF text of a robot.

    Args:
        sensors: framed by their names; those that measure motion (odometry) get no frame.
        name: what the document calls the robot.

    Raises:
        InputError: the description holds something that URDF cannot say.
    """
    source = Xml.fromstring(robot.sdf)
    document = source if source.tag == "robot" else _from_sdf(source)
    document.set("name", name)
    _frame(
        document, FOOTPRINT, robot.base, "base_footprint_joint", (0, 0, robot.base_height), LEVEL
    )
    for sensor, info in sensors.items():
        if info.category == "odometry":
            continue
        x, y, z, yaw = info.mount
        _frame(document, "base_link", sensor, f"{sensor}_joint", (x, y, z), (0.0, 0.0, yaw))
        if info.camera is not None:
            eye = optical(sensor)
            _frame(document, sensor, eye, f"{eye}_joint", (0.0, 0.0, 0.0), OPTICAL_RPY)
    Xml.indent(document)
    return '<?xml version="1.0"?>\n' + Xml.tostring(document, encoding="unicode") + "\n"


def _frame(
    document: Xml.Element,
    parent: str,
    child: str,
    joint: str,
    at: tuple[float, float, float],
    rpy: tuple[float, float, float],
) -> None:
    """A fixed joint; links that are not there yet are made."""
    links = {link.get("name") for link in document.iter("link")}
    for link in (parent, child):
        if link not in links:
            Xml.SubElement(document, "link", name=link)
    fixed = Xml.SubElement(document, "joint", name=joint, type="fixed")
    Xml.SubElement(fixed, "parent", link=parent)
    Xml.SubElement(fixed, "child", link=child)
    _origin(fixed, [*at, *rpy])


def _origin(parent: Xml.Element, pose: list[float]) -> None:
    xyz, rpy = (" ".join(f"{v + 0.0:.12g}" for v in part) for part in (pose[:3], pose[3:]))
    Xml.SubElement(parent, "origin", xyz=xyz, rpy=rpy)


# ---------------------------------------------------------------------------- SDFormat
def _from_sdf(source: Xml.Element) -> Xml.Element:
    model = source if source.tag == "model" else source.find("model")
    if model is None:
        raise InputError("the robot's description has no model")
    document = Xml.Element("robot")
    links = {_name(link): link for link in model.findall("link")}
    for name, link in links.items():
        _link(Xml.SubElement(document, "link", name=name), link)
    for joint in model.findall("joint"):
        _joint(document, joint, links)
    return document


def _name(element: Xml.Element) -> str:
    return element.get("name", "")


def _link(link: Xml.Element, source: Xml.Element) -> None:
    inertial = source.find("inertial")
    if inertial is not None:
        _inertial(Xml.SubElement(link, "inertial"), inertial)
    for kind in ("visual", "collision"):
        for item in source.findall(kind):
            part = Xml.SubElement(link, kind, name=_name(item))
            _origin(part, _pose(item))
            _shape(Xml.SubElement(part, "geometry"), item)
            _material(part, item)


def _inertial(inertial: Xml.Element, source: Xml.Element) -> None:
    _origin(inertial, _pose(source))
    Xml.SubElement(inertial, "mass", value=source.findtext("mass", "0").strip())
    moments = {k: source.findtext(f"inertia/{k}", "0").strip() for k in _MOMENTS}
    Xml.SubElement(inertial, "inertia", moments)


_MOMENTS = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")


def _shape(geometry: Xml.Element, source: Xml.Element) -> None:
    for shape in _SHAPES:
        found = source.find(f"geometry/{shape}")
        if found is not None:
            Xml.SubElement(geometry, shape, {c.tag: (c.text or "").strip() for c in found})
            return
    raise InputError(f"URDF has no shape like that of '{_name(source)}'")


def _material(part: Xml.Element, source: Xml.Element) -> None:
    colour = source.findtext("material/diffuse")
    if part.tag == "visual" and colour is not None:
        material = Xml.SubElement(part, "material", name=f"{_name(source)}_material")
        Xml.SubElement(material, "color", rgba=colour.strip())


def _joint(document: Xml.Element, source: Xml.Element, links: Mapping[str, Xml.Element]) -> None:
    name, kind = _name(source), source.get("type", "fixed")
    parent, child = source.findtext("parent", "").strip(), source.findtext("child", "").strip()
    if any(_pose(source)):
        raise InputError(f"joint '{name}' stands beside its child's frame, as URDF joints cannot")
    joint = Xml.SubElement(document, "joint", name=name, type=kind)
    Xml.SubElement(joint, "parent", link=parent)
    Xml.SubElement(joint, "child", link=child)
    there = np.linalg.inv(_in_model(links, parent)) @ _in_model(links, child)
    _origin(joint, _numbers(there))
    axis = source.findtext("axis/xyz")
    if axis is not None:
        Xml.SubElement(joint, "axis", xyz=axis.strip())
    limits = {
        k: v.strip()
        for k in ("lower", "upper", "effort", "velocity")
        if (v := source.findtext(f"axis/limit/{k}")) is not None
    }
    if limits:
        Xml.SubElement(joint, "limit", {"effort": "0", "velocity": "0", **limits})


def _pose(element: Xml.Element) -> list[float]:
    numbers = [float(v) for v in (element.findtext("pose") or "0 0 0 0 0 0").split()]
    if len(numbers) != 6:
        raise InputError(f"the pose of '{_name(element)}' has {len(numbers)} numbers, not 6")
    return numbers


def _in_model(links: Mapping[str, Xml.Element], name: str) -> Array:
    """Pose of a link in the model's frame, 4 x 4."""
    if name not in links:
        raise InputError(f"the robot's description has no link '{name}'")
    own = _matrix(_pose(links[name]))
    pose = links[name].find("pose")
    base = pose.get("relative_to") if pose is not None else None
    return _in_model(links, base) @ own if base else own


def _matrix(pose: list[float]) -> Array:
    x, y, z, roll, pitch, yaw = pose
    cr, sr, cp, sp, cy, sy = (f(a) for a in (roll, pitch, yaw) for f in (math.cos, math.sin))
    return np.array(
        [
            [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr, x],
            [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr, y],
            [-sp, cp * sr, cp * cr, z],
            [0.0, 0.0, 0.0, 1.0],
        ]
    )


def _numbers(matrix: Array) -> list[float]:
    """x, y, z, roll, pitch, yaw of a 4 x 4 pose."""
    flat = math.hypot(matrix[0, 0], matrix[1, 0])
    pitch = math.atan2(-matrix[2, 0], flat)
    if flat > 1e-9:
        roll, yaw = math.atan2(matrix[2, 1], matrix[2, 2]), math.atan2(matrix[1, 0], matrix[0, 0])
    else:
        roll, yaw = math.atan2(-matrix[1, 2], matrix[1, 1]), 0.0
    return [*matrix[:3, 3].tolist(), roll, pitch, yaw]
