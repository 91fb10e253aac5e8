"""Joints of a robot's description."""

from __future__ import annotations

from dataclasses import dataclass
from xml.etree import ElementTree as Xml

import numpy as np

from crowdbot.core.robots.xml import matrix, name_of, number, numbers, pose_of
from crowdbot.core.types.arrays import Array
from crowdbot.errors import PluginError

#: Joint types that a mobile base may have.
KNOWN = ("fixed", "continuous", "revolute", "prismatic")
#: SDFormat treats limits from this value on as unlimited.
_UNLIMITED = 1e16


@dataclass(frozen=True, slots=True)
class Joint:
    """A joint of a robot's description.

    Attributes:
        kind: joint type in SDFormat or URDF.
        axis: (3,) in the frame of the child.
        effort: largest force or torque, N or N m; None if not given.
        free: True if it rotates without limits.
        damping: N m s/rad, or N s/m.
        velocity: largest speed, rad/s or m/s; None if not given.
    """

    name: str
    kind: str
    parent: str
    child: str
    axis: Array
    effort: float | None
    free: bool
    damping: float = 0.0
    velocity: float | None = None


def child_of(joint: Xml.Element) -> str:
    """Return the name of a joint's child link."""
    child = joint.find("child")
    return "" if child is None else child.get("link") or (child.text or "").strip()


def parent_of(joint: Xml.Element) -> str:
    """Return the name of a URDF joint's parent link."""
    parent = joint.find("parent")
    return "" if parent is None else parent.get("link", "")


def _axis(text: str, name: str) -> Array:
    axis = np.array(numbers(text, f"the axis of joint '{name}'"))
    length = float(np.linalg.norm(axis))
    if axis.shape != (3,) or length == 0.0:
        raise PluginError(f"the axis of joint '{name}' is not a direction: '{text}'")
    return axis / length


def _damping(text: str | None, name: str) -> float:
    return 0.0 if text is None else number(text, f"the damping of joint '{name}'")


def _fastest(text: str | None, name: str) -> float | None:
    """Return the largest speed of a joint; numbers that are not positive stand for none."""
    speed = None if text is None else number(text, f"the velocity limit of joint '{name}'")
    return speed if speed is not None and speed > 0.0 else None


def urdf_joint(joint: Xml.Element) -> Joint:
    """Return a joint of a URDF, whose frame is its child's."""
    name, kind = name_of(joint), joint.get("type", "")
    limit, axis = joint.find("limit"), joint.find("axis")
    if kind == "fixed":
        axis = None  # unused here, and files contain 0 0 0
    effort = None if limit is None else limit.get("effort")
    return Joint(
        name=name,
        kind=kind,
        parent=parent_of(joint),
        child=child_of(joint),
        axis=_axis("1 0 0" if axis is None else axis.get("xyz", "1 0 0"), name),
        effort=None if effort is None else number(effort, f"the effort of joint '{name}'"),
        free=kind == "continuous",
        damping=_damping(None if (d := joint.find("dynamics")) is None else d.get("damping"), name),
        velocity=_fastest(None if limit is None else limit.get("velocity"), name),
    )


def sdf_joint(joint: Xml.Element) -> Joint:
    """Return a joint of an SDFormat model whose frames are written out (`sdf_frames`).

    Its frame may be rotated against its child's.
    """
    name, kind = name_of(joint), joint.get("type", "")
    axis, effort = joint.find("axis/xyz"), joint.findtext("axis/limit/effort")
    turned = matrix(pose_of(joint))[:3, :3]
    bounds = [joint.findtext(f"axis/limit/{side}") for side in ("lower", "upper")]
    limits = [number(t, f"a limit of joint '{name}'") for t in bounds if t is not None]
    bounded = any(abs(limit) < _UNLIMITED for limit in limits)
    return Joint(
        name=name,
        kind=kind,
        parent=joint.findtext("parent", "").strip(),
        child=child_of(joint),
        axis=turned @ _axis("0 0 1" if axis is None else axis.text or "", name),
        effort=None if effort is None else number(effort, f"the effort of joint '{name}'"),
        free=kind == "continuous" or (kind == "revolute" and not bounded),
        damping=_damping(joint.findtext("axis/dynamics/damping"), name),
        velocity=_fastest(joint.findtext("axis/limit/velocity"), name),
    )


def hold_still(joint: Xml.Element) -> None:
    """Make a joint a fixed one."""
    joint.set("type", "fixed")
    for tag in ("axis", "limit", "mimic", "dynamics", "safety_controller", "calibration"):
        for part in joint.findall(tag):
            joint.remove(part)
