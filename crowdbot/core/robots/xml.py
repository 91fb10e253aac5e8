"""Names, poses and numbers in the XML of a robot's description.

SDFormat and URDF both write poses as x, y, z, roll, pitch, yaw about fixed axes.
"""

from __future__ import annotations

import math
from xml.etree import ElementTree as Xml

import numpy as np

from crowdbot.core.geometry.rotation import rotation
from crowdbot.core.types.arrays import Array
from crowdbot.errors import PluginError


def name_of(element: Xml.Element) -> str:
    """Return the attribute ``name``."""
    return element.get("name", "")


def pose_of(element: Xml.Element) -> list[float]:
    """Return x, y, z, roll, pitch, yaw of an SDFormat (``pose``) or URDF (``origin``) element.

    Raises:
        PluginError: they are not six numbers.
    """
    origin = element.find("origin")
    if origin is not None:
        text = f"{origin.get('xyz', '0 0 0')} {origin.get('rpy', '0 0 0')}"
    else:
        text = element.findtext("pose") or "0 0 0 0 0 0"
    pose = numbers(text, f"the pose of '{name_of(element)}'")
    if len(pose) != 6:
        raise PluginError(f"the pose of '{name_of(element)}' has {len(pose)} numbers, not 6")
    return pose


def numbers(text: str, subject: str) -> list[float]:
    """Return the numbers in a text.

    Raises:
        PluginError: a word is not a number, or not finite.
    """
    try:
        found = [float(word) for word in text.split()]
    except ValueError as error:
        raise PluginError(f"{subject}: {error}") from error
    if not all(math.isfinite(n) for n in found):
        raise PluginError(f"{subject} is not finite")
    return found


def number(text: str, subject: str) -> float:
    """Return the only number in a text.

    Raises:
        PluginError: it is not a number, or not finite.
    """
    found = numbers(text, subject)
    if len(found) != 1:
        raise PluginError(f"{subject} is {len(found)} numbers, not one")
    return found[0]


def matrix(pose: list[float]) -> Array:
    """Return the 4 x 4 pose of x, y, z, roll, pitch, yaw."""
    found = np.eye(4)
    found[:3, :3], found[:3, 3] = rotation(*pose[3:]), pose[:3]
    return found


def six(matrix: Array) -> list[float]:
    """Return x, y, z, roll, pitch, yaw of a 4 x 4 pose."""
    flat = math.hypot(matrix[0, 0], matrix[1, 0])
    pitch = math.atan2(-matrix[2, 0], flat)
    if flat > 1e-9:
        roll, yaw = math.atan2(matrix[2, 1], matrix[2, 2]), math.atan2(matrix[1, 0], matrix[0, 0])
    else:
        roll, yaw = math.atan2(-matrix[1, 2], matrix[1, 1]), 0.0
    return [*matrix[:3, 3].tolist(), roll, pitch, yaw]
