"""Fix joints of a published robot, such as those of an arm, at angles other than zero."""

from __future__ import annotations

import math
from collections.abc import Mapping
from xml.etree import ElementTree as Xml

import numpy as np

from crowdbot.core.robots.joint import urdf_joint
from crowdbot.core.robots.published_drive import write_origin
from crowdbot.core.robots.xml import matrix, name_of, number, pose_of
from crowdbot.core.types.arrays import Array
from crowdbot.errors import PluginError, did_you_mean, nearest

_TURNS, _SLIDES = ("revolute", "continuous"), ("prismatic",)


def hold_at(robot: Xml.Element, positions: Mapping[str, float]) -> None:
    """Turn the origins of joints, and of those that mimic them, to the angles of ``positions``.

    Args:
        robot: a URDF; it is changed.
        positions: rad, or m of prismatic joints, by joint.

    Raises:
        PluginError: there is no such joint, it does not move, or not so far.
    """
    joints = {name_of(joint): joint for joint in robot.findall("joint")}
    for name, value in positions.items():
        if name not in joints:
            hint = did_you_mean(nearest(name, joints))
            raise PluginError(f"positions: the robot's description has no joint '{name}'{hint}")
        _check_limits(joints[name], value)
        _move(joints[name], value)
    for name, joint in joints.items():
        mimic = joint.find("mimic")
        if mimic is not None and name not in positions and mimic.get("joint") in positions:
            factor, offset = (
                number(mimic.get(key, usual), f"the {key} of '{name}', which mimics another")
                for key, usual in (("multiplier", "1"), ("offset", "0"))
            )
            _move(joint, factor * positions[mimic.get("joint", "")] + offset)


def _check_limits(joint: Xml.Element, value: float) -> None:
    limit = joint.find("limit")
    if limit is None or joint.get("type") == "continuous":
        return
    low, high = (
        number(limit.get(end, "0"), f"the limit of '{name_of(joint)}'")
        for end in ("lower", "upper")
    )
    if low < high and not low - 1e-9 <= value <= high + 1e-9:
        raise PluginError(
            f"positions: joint '{name_of(joint)}' goes from {low:g} to {high:g}, not to {value:g}"
        )


def _move(joint: Xml.Element, value: float) -> None:
    kind, motion = joint.get("type", ""), np.eye(4)
    axis = urdf_joint(joint).axis
    if kind in _TURNS:
        motion[:3, :3] = _turn(axis, value)
    elif kind in _SLIDES:
        motion[:3, 3] = value * axis
    else:
        raise PluginError(f"positions: joint '{name_of(joint)}' is {kind}, and does not move")
    write_origin(joint, matrix(pose_of(joint)) @ motion)


def _turn(axis: Array, angle: float) -> Array:
    """Return the rotation (3, 3) about an axis of length 1 (Rodrigues)."""
    x, y, z = axis.tolist()
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.asarray(np.eye(3) + math.sin(angle) * cross + (1.0 - math.cos(angle)) * cross @ cross)
