"""The robot in the messages of a topic, or in the transforms of a bag."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from crowdbot.core.trajectories.bag.columns import BodyRow, Columns
from crowdbot.core.trajectories.bag.fields import header_of, place_of
from crowdbot.core.trajectories.bag.frames import TF, FrameTree
from crowdbot.core.trajectories.bag.reader import topic_fields
from crowdbot.core.types.arrays import Array
from crowdbot.errors import InputError, UnknownNameError

#: Frames of a robot's base, in the order they are looked for.
_BASES = ("base_footprint", "base_link")
#: Frames that stand still, likewise; else the root of the tree does.
_WORLDS = ("map", "world", "odom")
#: A slower sideways speed is noise of an estimate, m/s.
_SIDEWAYS = 0.01


def pose_of(path: Path, topic: str, message: Any, log: int, number: int) -> BodyRow:
    """Return the robot's pose in a message, with its velocity if there is one.

    Raises:
        InputError: it has no pose.
    """
    place = place_of(message)
    if place is None:
        fields = topic_fields(path)
        found = [TF] if TF in fields else []
        found += [name for name, names in fields.items() if "pose" in names]
        near = f"; these have: {', '.join(sorted(found))}" if found else ""
        raise InputError(f"{path}: {topic} holds {message.__msgtype__}, which has no pose{near}")
    stamp, frame = header_of(message)
    values = {"theta": place.theta, **_twist(message)}
    child = str(getattr(message, "child_frame_id", "")).lstrip("/")
    return BodyRow(log, stamp, number, frame, place.xyz, values, {"child": child})


def _twist(message: Any) -> dict[str, float]:
    """Return forward, sideways and yaw velocity in the robot's frame, m/s and rad/s."""
    twist = getattr(getattr(message, "twist", None), "twist", None)
    if twist is not None:  # Odometry
        return {
            "v": float(twist.linear.x),
            "vy": float(twist.linear.y),
            "w": float(twist.angular.z),
        }
    if hasattr(message, "linear_velocity") and hasattr(message, "angular_velocity"):
        v, w = message.linear_velocity, message.angular_velocity
        if isinstance(v, float) and isinstance(w, float):  # turtlesim/Pose
            return {"v": v, "w": w}
    return {}


def velocities(columns: Columns) -> dict[str, Array]:
    """Return v and w, and for a robot that moves sideways its world velocities."""
    values = dict(columns.values)
    sideways, theta = values.pop("vy", None), values.get("theta")
    if theta is None or not np.isfinite(theta).any():
        values.pop("theta", None)
        return values
    if sideways is None or not np.nanmax(np.abs(sideways), initial=0.0) > _SIDEWAYS:
        return values
    c, s, v = np.cos(theta), np.sin(theta), values["v"]
    return {**values, "vx": c * v - s * sideways, "vy": s * v + c * sideways}


def split_name(robot: str | None) -> tuple[str | None, str | None]:
    """Return topic and frame of ``/tf:FRAME``; the frame is None of any other topic."""
    if robot is None:
        return None, None
    topic, _, frame = robot.partition(":")
    return (topic, frame.lstrip("/")) if topic == TF else (robot, None)


def base_frame(path: Path, tree: FrameTree, frame: str) -> str:
    """Return the robot's frame in a tree: the named one, else its base frame.

    Raises:
        UnknownNameError: there is no such frame.
        InputError: none is named, and there is no base, or those of several robots.
    """
    if frame:
        if frame not in tree:
            raise UnknownNameError(f"frame of {path}", frame, tree.frames)
        return frame
    for base in _BASES:
        found = [name for name in tree.frames if name == base or name.endswith(f"/{base}")]
        if len(found) > 1:
            raise InputError(
                f"{path}: {TF} has the bases of {len(found)} robots; robot='{TF}:FRAME' says which "
                f"of {', '.join(found)}"
            )
        if found:
            return found[0]
    raise InputError(
        f"{path}: {TF} has no {' or '.join(_BASES)}; robot='{TF}:FRAME' says which of "
        f"{', '.join(tree.frames) or 'none'} is the robot"
    )


def world_frame(tree: FrameTree, base: str, people: Sequence[str]) -> str:
    """Return the frame for the robot's poses: that of the people, else a static one."""
    chain = tree.above(base)[1:]
    return next((name for name in (*people, *_WORLDS) if name in chain), chain[-1] if chain else "")


def from_tree(tree: FrameTree, base: str, world: str) -> Columns:
    """Return the poses of a frame, at the times of the most frequent transform."""
    t = tree.times(base, world)
    found = tree.between(world, base, t)
    assert found is not None  # the world is above the base
    turn, xyz = found
    return Columns(
        log=t, stamp=t, message=np.arange(len(t)), row=np.arange(len(t)),
        frame=np.full(len(t), world, object), xyz=xyz, values={"theta": heading(turn)},
    )  # fmt: skip


def heading(turn: Any) -> Array:
    """Return the headings (K,) of rotations, rad."""
    matrix = turn.as_matrix()
    return np.asarray(np.arctan2(matrix[:, 1, 0], matrix[:, 0, 0]))
