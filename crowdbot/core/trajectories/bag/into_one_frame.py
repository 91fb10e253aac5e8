"""Bring the rows of a robot and of people into one frame."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from crowdbot.core.trajectories.bag.columns import Columns
from crowdbot.core.trajectories.bag.frames import FrameTree
from crowdbot.core.trajectories.bag.robot import heading
from crowdbot.errors import InputError


def into_one_frame(
    path: Path,
    tree: FrameTree,
    robot: Columns | None,
    people: Columns | None,
    notes: list[str],
    *,
    same_frame: bool,
) -> tuple[Columns | None, Columns | None]:
    """Return the rows in the frame of the people, or of the robot if the former moves with it.

    Args:
        path: name for messages.
        tree: the transforms of the bag.
        robot, people: rows in their own frames; either may be missing.
        notes: takes sentences on what was transformed.
        same_frame: True to leave positions as they are.

    Raises:
        InputError: frames differ, and no transform of the bag connects them.
    """
    both = [columns for columns in (robot, people) if columns is not None]
    frames = list(dict.fromkeys(frame for columns in both for frame in columns.frame if frame))
    if same_frame or not frames:
        return robot, people
    target = _target(tree, robot, people, frames)
    if frames == [target]:
        return robot, people
    listed = ", ".join(f"'{frame}'" for frame in frames if frame != target)
    notes.append(f"positions in {listed} are transformed into '{target}', by the bag's transforms")
    made = [None if c is None else _moved(path, tree, c, target, notes) for c in (robot, people)]
    return made[0], made[1]


def _target(
    tree: FrameTree, robot: Columns | None, people: Columns | None, frames: list[str]
) -> str:
    if robot is None:
        above = tree.above(frames[0])
        return above[-1] if tree.is_moving(frames[0]) else frames[0]
    own = next((str(frame) for frame in robot.frame if frame), "")
    theirs = [] if people is None else [str(frame) for frame in dict.fromkeys(people.frame)]
    return next((frame for frame in theirs if frame in tree.above(own)), own or frames[0])


def _moved(path: Path, tree: FrameTree, columns: Columns, target: str, notes: list[str]) -> Columns:
    xyz, values = columns.xyz.copy(), {n: v.copy() for n, v in columns.values.items()}
    for frame in sorted({str(frame) for frame in columns.frame} - {"", target}):
        rows = np.flatnonzero(columns.frame == frame)
        found = tree.between(target, frame, columns.stamp[rows])
        if found is None:
            raise InputError(
                f"{path}: positions in the frames '{frame}' and '{target}', and no transform "
                "between them in /tf or /tf_static; same_frame=True takes them for one frame"
            )
        turn, at = found
        xyz[rows] = turn.apply(columns.xyz[rows]) + at
        yaw = heading(turn)
        if "theta" in values:
            values["theta"][rows] += yaw
        if "vx" in values and tree.is_moving(frame):
            values["vx"][rows] = values["vy"][rows] = np.nan  # relative to what moves
        elif "vx" in values:
            c, s, vx, vy = np.cos(yaw), np.sin(yaw), values["vx"][rows], values["vy"][rows]
            values["vx"][rows], values["vy"][rows] = c * vx - s * vy, s * vx + c * vy
    known = np.asarray(np.isfinite(xyz).all(axis=1))
    lost = np.count_nonzero(~known & np.isfinite(columns.xyz).all(axis=1))
    if lost:
        notes.append(f"{lost} positions are left out: no transform was recorded near their time")
    return replace(columns, xyz=xyz, frame=np.full(len(xyz), target, object), values=values).only(
        known
    )
