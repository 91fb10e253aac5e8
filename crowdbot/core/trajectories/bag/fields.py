"""Read messages by their fields, not by their type names: packages need not be installed."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

#: Fields that hold a place, in the order they are tried; some hold it in turn in such a field.
_PLACES = (
    "position", "pos", "pose", "pose_with_covariance", "transform", "translation", "kinematics",
    "bbox", "center",
)  # fmt: skip
#: Types of messages that are a place; a vector may be a speed.
_PLACE_TYPES = (
    "Point", "Point32", "PointStamped", "Pose", "PoseStamped", "Pose2D", "PoseWithCovariance",
    "PoseWithCovarianceStamped", "Transform", "TransformStamped",
)  # fmt: skip
_YAWS = ("theta", "yaw", "heading")
_DEPTH = 5


class BagPose(NamedTuple):
    """A position, m, and a heading, rad; NaN if the message has none."""

    xyz: tuple[float, float, float]
    theta: float


def header_of(message: Any) -> tuple[int, str]:
    """Return the stamp of a header, ns, and its frame; 0 and an empty text without a header."""
    header = getattr(message, "header", None)
    stamp = getattr(header, "stamp", None)
    if stamp is None:
        return 0, ""
    frame = str(getattr(header, "frame_id", "")).lstrip("/")
    return 10**9 * int(stamp.sec) + int(stamp.nanosec), frame


def place_of(item: Any, depth: int = _DEPTH) -> BagPose | None:
    """Return the position in a message, or in a part of one; None if it has none."""
    if item is None or depth == 0:
        return None
    if _is_point(item):
        theta = next((float(getattr(item, n)) for n in _YAWS if hasattr(item, n)), math.nan)
        return BagPose((float(item.x), float(item.y), float(getattr(item, "z", 0.0))), theta)
    if isinstance(item, np.ndarray) and item.shape == (3,):
        return BagPose((float(item[0]), float(item[1]), float(item[2])), math.nan)
    for name in _PLACES:
        found = place_of(getattr(item, name, None), depth - 1)
        if found is not None:
            turn = getattr(item, "orientation", getattr(item, "rotation", None))
            return found if turn is None else BagPose(found.xyz, yaw_of(turn))
    return place_of(_only_place(item), depth - 1)


def _only_place(item: Any) -> Any:
    """Return the only part of a message that is a position or pose; None if none or several are."""
    parts = [getattr(item, name) for name in getattr(item, "__dataclass_fields__", {})]
    kinds = [str(getattr(part, "__msgtype__", "")).rpartition("/")[2] for part in parts]
    found = [part for part, kind in zip(parts, kinds, strict=True) if kind in _PLACE_TYPES]
    return found[0] if len(found) == 1 else None


def _is_point(item: Any) -> bool:
    return all(isinstance(getattr(item, name, None), int | float | np.number) for name in "xy")


def yaw_of(q: Any) -> float:
    """Return the heading of a quaternion, rad; NaN if it does not rotate, such as all zeros."""
    if not q.x**2 + q.y**2 + q.z**2 + q.w**2 > 0.5:
        return math.nan
    # Right for any length: some senders do not divide by it.
    return math.atan2(2.0 * (q.w * q.z + q.x * q.y), q.w**2 + q.x**2 - q.y**2 - q.z**2)


def linear_of(item: Any) -> Any:
    """Return the linear velocity of a twist, which may be nested; None without one."""
    kinematics = getattr(item, "kinematics", item)
    for name in ("twist", "twist_with_covariance", "velocity"):
        found = getattr(kinematics, name, None)
        found = getattr(found, "twist", found)
        found = getattr(found, "linear", found)
        if found is not None and _is_point(found):
            return found
    return None
