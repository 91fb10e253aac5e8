"""Changes of robots during a step, from which rewards are computed; compiled."""

from __future__ import annotations

import math

import numpy as np

from crowdbot.core.batch.robot_tables import DRIVE_STATE
from crowdbot.core.crowd.contact.robot_contact import R_W as _W
from crowdbot.core.crowd.contact.robot_contact import R_YAW as _YAW
from crowdbot.core.crowd.contact.robot_contact import RVX as _VX
from crowdbot.core.crowd.contact.robot_contact import RVY as _VY
from crowdbot.core.support.compiling.compile import kernel
from crowdbot.core.support.records import as_record
from crowdbot.core.types.arrays import Array, Indices, Mask

#: Rows of what `write_changes` writes.
PROGRESS, DISTANCE, CONTACT, WALL, GAP, ADVANCE, WORK, FORCED, ASIDE = range(9)
_ROWS = 9


def changes(count: int) -> tuple[Array, Mask]:
    """Return arrays for `write_changes`: (9, W) numbers and (3, W) flags arrived, touched, late."""
    return np.empty((_ROWS, count)), np.empty((3, count), np.bool_)


@kernel
def write_changes(
    drives: Array, rows: Array, robot: int, goals: Array, distance: Array, here: Mask,
    now: Indices, limits: Indices, ticks: float, found: Array, happened: Mask,
) -> None:  # fmt: skip
    """Write the changes in a step, and the distances to the goals.

    Args:
        drives: (W, R, D) `DriveStateRecord` after it.
        rows: (W, R, 8) of all robots after it.
        robot: index of the robot.
        goals, distance: (W, 2), (W,) of the robot; the distance is that before the step, changed.
        here: (W,) True for worlds that were stepped.
        now, limits: (W,) ticks since the start, and their largest number.
        ticks: of a step.
        found, happened: see `changes`; only worlds that were stepped have arrived, been touched or
            are late.
    """
    for w in range(drives.shape[0]):
        drive = as_record(drives[w, robot], DRIVE_STATE)
        away = math.hypot(goals[w, 0] - rows[w, robot, 0], goals[w, 1] - rows[w, robot, 1])
        found[PROGRESS, w], found[DISTANCE, w] = distance[w] - away, away
        distance[w] = away
        found[CONTACT, w], found[WALL, w] = drive.touched / ticks, drive.blocked / ticks
        found[GAP, w], found[ADVANCE, w], found[WORK, w] = drive.gap, drive.advance, drive.work
        found[FORCED, w], found[ASIDE, w] = drive.forced, drive.aside
        happened[0, w] = here[w] and drive.arrived >= 0.0
        happened[1, w] = here[w] and drive.touched > 0.0
        happened[2, w] = here[w] and now[w] >= limits[w] and not happened[0, w]


@kernel
def keep_commands(given: Array, here: Mask, before: Array) -> None:
    """Remember the commands (W, 3) of worlds that were stepped."""
    for w in range(given.shape[0]):
        if here[w]:
            before[w, 0], before[w, 1], before[w, 2] = given[w, 0], given[w, 1], given[w, 2]


@kernel
def write_motion(rows: Array, robot: int, pose: Array, twist: Array) -> None:
    """Write x, y, yaw and v, w, vy (W, 3) of a robot, m and rad, of rows (W, R, 8)."""
    for k in range(rows.shape[0]):
        row = rows[k, robot]
        cos, sin = math.cos(row[_YAW]), math.sin(row[_YAW])
        pose[k, 0], pose[k, 1], pose[k, 2] = row[0], row[1], row[_YAW]
        twist[k, 0] = cos * row[_VX] + sin * row[_VY]
        twist[k, 1] = row[_W]
        twist[k, 2] = cos * row[_VY] - sin * row[_VX]
