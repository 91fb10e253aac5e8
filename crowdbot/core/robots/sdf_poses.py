"""Normalise poses of SDFormat: degrees, quaternions, and the older attribute ``frame``."""

from __future__ import annotations

import math
from xml.etree import ElementTree as Xml

import numpy as np

from crowdbot.core.geometry.rotation import rotation_of
from crowdbot.core.robots.xml import name_of, numbers, six
from crowdbot.errors import PluginError

_FORMATS = ("euler_rpy", "quat_xyzw")


def plain_poses(model: Xml.Element) -> None:
    """Write all poses of a model as x, y, z, roll, pitch, yaw in rad, in place.

    Before SDFormat 1.7 a pose said ``frame`` for ``relative_to``.

    Raises:
        PluginError: a pose has another number of numbers than its format, or an unknown format.
    """
    for element in model.iter():
        for pose in element.findall("pose"):
            _make_plain(pose, f"the pose of '{name_of(element)}'")


def _make_plain(pose: Xml.Element, subject: str) -> None:
    kind, old = pose.attrib.pop("rotation_format", _FORMATS[0]), pose.attrib.pop("frame", "")
    if old and not pose.get("relative_to"):
        pose.set("relative_to", old)
    in_degrees = pose.attrib.pop("degrees", "false").strip().lower() in ("true", "1")
    if kind not in _FORMATS:
        raise PluginError(
            f"{subject} has the rotation_format '{kind}'; known: {', '.join(_FORMATS)}"
        )
    if (kind == _FORMATS[0] and not in_degrees) or not (pose.text or "").strip():
        return
    found = numbers(pose.text or "", subject)
    count = 6 if kind == _FORMATS[0] else 7
    if len(found) != count:
        raise PluginError(f"{subject} has {len(found)} numbers, not {count}")
    if count == 7:
        found = _from_quaternion(found, subject)
    else:
        found = [*found[:3], *(math.radians(angle) for angle in found[3:])]
    pose.text = " ".join(f"{value:.17g}" for value in found)


def _from_quaternion(found: list[float], subject: str) -> list[float]:
    """Return x, y, z, roll, pitch, yaw of x, y, z and a quaternion x, y, z, w."""
    length = math.sqrt(sum(part * part for part in found[3:]))
    if length < 1e-6:
        raise PluginError(f"{subject} has a quaternion of length 0")
    x, y, z, w = (part / length for part in found[3:])
    made = np.eye(4)
    made[:3, :3] = rotation_of(x, y, z, w)
    made[:3, 3] = found[:3]
    return six(made)
