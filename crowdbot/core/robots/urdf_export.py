"""Export robots as URDF for ROS tools: the body, and a frame for each sensor.

A robot is described in SDFormat or URDF (`RobotModel.description`). They differ in the frames of
joints: a URDF joint is its child's frame.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from copy import deepcopy
from xml.etree import ElementTree as Xml

import numpy as np

from crowdbot.core.geometry.optical_frame import OPTICAL_RPY, optical
from crowdbot.core.recording.scenery import FRAMES
from crowdbot.core.robots.convex_piece import corners_of, is_piece
from crowdbot.core.robots.description import Description
from crowdbot.core.robots.description_file import read_description
from crowdbot.core.robots.sdf_to_urdf import from_sdf, write_origin
from crowdbot.core.robots.xml import matrix, pose_of, six
from crowdbot.core.types.robot import DifferentialDrive, RobotModel
from crowdbot.core.types.sensor import SensorInfo
from crowdbot.errors import InputError

FOOTPRINT, BASE = "base_footprint", "base_link"
_SAME = 1e-3  # m; also tolerance of a rotation's entries
LEVEL = (0.0, 0.0, 0.0)


def to_urdf(robot: RobotModel, sensors: Mapping[str, SensorInfo], name: str) -> str:
    """Return the URDF text of a robot.

    Args:
        sensors: sensors by name, which is also their frame; those that measure motion (odometry)
            have no frame.
        name: the robot's name in the document.

    Raises:
        InputError: the description has something that URDF cannot express, or `check_frames`
            refuses a sensor.
    """
    check_frames(robot, sensors)
    described = read_description(robot.description)
    urdf = described.format == "urdf"
    document = deepcopy(described.model) if urdf else from_sdf(described, wheel_rates(robot))
    document.set("name", name)
    _ground(document, robot, described)
    for link in document.findall("link"):
        if link.find("visual") is None:
            _show(link)
    for sensor, info in sensors.items():
        if info.category == "odometry":
            continue
        x, y, z, yaw = info.mount
        if sensor not in described.links:
            _frame(document, BASE, sensor, f"{sensor}_joint", (x, y, z), (*info.tilt, yaw))
        if info.camera is not None:
            eye = optical(sensor)
            _frame(document, sensor, eye, f"{eye}_joint", (0.0, 0.0, 0.0), OPTICAL_RPY)
    Xml.indent(document)
    return '<?xml version="1.0"?>\n' + Xml.tostring(document, encoding="unicode") + "\n"


def _show(link: Xml.Element) -> None:
    """Add a link's collision shapes as visual shapes; a convex piece as its bounding box."""
    for collision in link.findall("collision"):
        seen = deepcopy(collision)
        seen.tag = "visual"
        seen.attrib.pop("name", None)
        geometry = seen.find("geometry")
        for shape in [] if geometry is None else list(geometry):
            if is_piece(shape):
                _box_around(seen, shape)
        link.append(seen)


def _box_around(visual: Xml.Element, piece: Xml.Element) -> None:
    corners = corners_of(piece)
    low, high = corners.min(axis=0), corners.max(axis=0)
    middle = np.eye(4)
    middle[:3, 3] = 0.5 * (low + high)
    at = matrix(pose_of(visual)) @ middle
    for part in (*visual.findall("origin"), *visual.findall("geometry")):
        visual.remove(part)
    write_origin(visual, six(at))
    size = " ".join(f"{side:.6g}" for side in (high - low).tolist())
    Xml.SubElement(Xml.SubElement(visual, "geometry"), "box", size=size)


def _ground(document: Xml.Element, robot: RobotModel, described: Description) -> None:
    """Add the standard frames: ``base_link``, and ``base_footprint`` on the floor."""
    if robot.base != BASE:
        _frame(document, robot.base, BASE, f"{BASE}_joint", (0.0, 0.0, 0.0), LEVEL)
    if FOOTPRINT in described.links:
        height = float(described.pose(robot.base, FOOTPRINT)[2, 3])
        if not math.isclose(height, robot.base_height, abs_tol=_SAME):
            raise InputError(
                f"'{FOOTPRINT}' is {height:g} m below '{robot.base}', whose base_height is "
                f"{robot.base_height:g} m"
            )
        return
    rise = float(described.pose(robot.base, described.root)[2, 3])
    at = (0.0, 0.0, robot.base_height - rise)
    _frame(document, FOOTPRINT, described.root, f"{FOOTPRINT}_joint", at, LEVEL)


def check_frames(robot: RobotModel, sensors: Mapping[str, SensorInfo]) -> None:
    """Refuse sensors whose frames clash with others.

    Raises:
        InputError: a sensor has the name of a standard frame, of another sensor's optical frame, or
            of a link at another position.
    """
    described = read_description(robot.description)
    framed = {n: info for n, info in sensors.items() if info.category != "odometry"}
    eyes = {optical(n) for n, info in framed.items() if info.camera is not None}
    for sensor, info in framed.items():
        if sensor in FRAMES or sensor in eyes:
            raise InputError(
                f"sensor '{sensor}' has the name of another frame of the recording: "
                "give it another name"
            )
        if sensor in described.links:
            _check_same(sensor, info, described, robot.base)


def _check_same(sensor: str, info: SensorInfo, described: Description, base: str) -> None:
    """Accept a link with a sensor's name as its frame if it is at the sensor's position."""
    x, y, z, yaw = info.mount
    if not np.allclose(
        described.pose(sensor, base), matrix([x, y, z, *info.tilt, yaw]), atol=_SAME
    ):
        raise InputError(
            f"sensor '{sensor}' has the name of a link of the robot, and is mounted elsewhere: "
            f"give it another name, or the link's mount"
        )


def _frame(
    document: Xml.Element,
    parent: str,
    child: str,
    joint: str,
    at: tuple[float, float, float],
    rpy: tuple[float, float, float],
) -> None:
    """Add a fixed joint, and its links if they do not exist yet."""
    links = {link.get("name") for link in document.iter("link")}
    for link in (parent, child):
        if link not in links:
            Xml.SubElement(document, "link", name=link)
    fixed = Xml.SubElement(document, "joint", name=joint, type="fixed")
    Xml.SubElement(fixed, "parent", link=parent)
    Xml.SubElement(fixed, "child", link=child)
    write_origin(fixed, [*at, *rpy])


# ---------------------------------------------------------------------------- SDFormat
def wheel_rates(robot: RobotModel) -> dict[str, float]:
    """Return each driven wheel's rate at the robot's limits, rad/s, by its joint's name."""
    drive, limits = robot.drive, robot.limits
    if not isinstance(drive, DifferentialDrive):
        return {}
    rim = max(-limits.v_min, limits.v_max) + 0.5 * drive.track * limits.w_max
    return dict.fromkeys((drive.left_joint, drive.right_joint), rim / drive.command_radius)
