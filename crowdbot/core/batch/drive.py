"""One tick of a robot with kinematic control, compiled.

The motion is that of `crowdbot.core.sim.control.kinematic.KinematicBase`, and the slew limits are
those of `crowdbot.core.sim.planner_system`; a test compares them.
"""

from __future__ import annotations

import math

from crowdbot.core.batch.array_tables import floats1, floats2
from crowdbot.core.batch.robot_tables import (
    CORNERS,
    DRIVE_LIMITS,
    LIMITS,
    PILLARS,
    WALLS,
    ZONE,
    DriveLimitsRecord,
    DriveStateRecord,
)
from crowdbot.core.crowd.contact.robot_contact import RobotRecord
from crowdbot.core.geometry.polygon import entry_fraction, inside
from crowdbot.core.sim.contacts.outline_gap import outline_gap
from crowdbot.core.sim.control.kinematic import free_share
from crowdbot.core.support.compiling.compile import inline_kernel, kernel
from crowdbot.core.support.records import as_record
from crowdbot.core.support.ticks import TICK
from crowdbot.core.types.arrays import Indices

_TURN = 2.0 * math.pi
_MARGIN = 1e-6  # m; robots that are farther from walls than this beyond their way are not checked


@kernel
def _remainder(angle: float) -> float:
    """Return an angle within [-pi, pi], rad."""
    return float(angle - _TURN * round(angle / _TURN))


@kernel
def _slew(now: float, target: float, step: float) -> float:
    return now + min(step, max(-step, target - now))


@inline_kernel
def follow(drive: DriveStateRecord, limits: DriveLimitsRecord) -> None:
    """Move the command of a tick towards the wanted one, within the slew limits."""
    if drive.vy == drive.wanted_vy:
        drive.v = _slew(drive.v, drive.wanted_v, limits.dv)
    else:
        ahead, aside = drive.wanted_v - drive.v, drive.wanted_vy - drive.vy
        length = math.hypot(ahead, aside)
        if length <= limits.dv:
            drive.v, drive.vy = drive.wanted_v, drive.wanted_vy
        else:
            drive.v += ahead * limits.dv / length
            drive.vy += aside * limits.dv / length
    drive.w = _slew(drive.w, drive.wanted_w, limits.dw)


@kernel
def move(robot: RobotRecord, drive: DriveStateRecord, own: Indices) -> None:
    """Move a robot for one tick at the command of the tick before; walls stop it.

    Args:
        robot: its row in the crowd's table, changed.
        drive: its command, changed.
        own: (F, 4) entries of a `robot_table`.
    """
    limits = as_record(floats1(own, LIMITS), DRIVE_LIMITS)
    x, y, yaw = robot.x, robot.y, robot.yaw
    v, w, vy = drive.v, drive.w, drive.vy
    speed, crab = (v, 0.0) if vy == 0.0 else (math.hypot(v, vy), math.atan2(vy, v))
    way, turn = speed * TICK, w * TICK
    share = _share(drive, limits, own, x, y, yaw, crab, way, turn)
    _arc(robot, yaw + crab, way * share, turn * share)
    yaw_after = _remainder(yaw + turn)
    if share < 1.0:
        drive.blocked += 1.0
        speed *= share
        corners = floats2(own, CORNERS)
        if corners.shape[0] > 0:  # as far as corners may move
            rest = (1.0 - share) * turn
            more = free_share(
                floats2(own, WALLS), floats2(own, PILLARS), corners, limits.radius,
                robot.x, robot.y, yaw + turn * share, 0.0, 0.0, rest,
            )  # fmt: skip
            w = w * share + (1.0 - share) * w * more
            yaw_after = _remainder(yaw + w * TICK)
    robot.yaw, robot.turning = yaw_after, w
    robot.vx, robot.vy = speed * math.cos(yaw_after + crab), speed * math.sin(yaw_after + crab)
    follow(drive, limits)


@kernel
def _share(
    drive: DriveStateRecord, limits: DriveLimitsRecord, own: Indices,
    x: float, y: float, yaw: float, crab: float, way: float, turn: float,
) -> float:  # fmt: skip
    """Return the fraction of an arc that the robot can drive before it touches a wall, 0 to 1.

    Far from walls this is 1 without a test: no point of the outline moves farther than the length
    of the arc plus reach times angle of the turn.
    """
    farthest = abs(way) + abs(turn) * limits.reach
    drive.clear -= farthest
    if drive.clear > limits.radius + _MARGIN:
        return 1.0
    walls, pillars, corners = floats2(own, WALLS), floats2(own, PILLARS), floats2(own, CORNERS)
    drive.clear = outline_gap(walls, pillars, corners, x, y, yaw) - farthest
    if drive.clear > limits.radius + _MARGIN:
        return 1.0
    return float(free_share(walls, pillars, corners, limits.radius, x, y, yaw, crab, way, turn))


@inline_kernel
def _arc(robot: RobotRecord, heading: float, way: float, turn: float) -> None:
    """Move the robot's position along an arc that starts at ``heading`` (rad); its yaw stays."""
    half = 0.5 * turn
    chord = way * (math.sin(half) / half if half != 0.0 else 1.0)
    robot.x += chord * math.cos(heading + half)
    robot.y += chord * math.sin(heading + half)


@kernel
def watch_goal(
    robot: RobotRecord, drive: DriveStateRecord, own: Indices, x0: float, y0: float
) -> None:
    """Record the arrival of a robot; (x0, y0) is its position one tick ago, m."""
    zone = floats2(own, ZONE)
    if drive.arrived < 0.0 and inside(zone, robot.x, robot.y):
        fraction = entry_fraction(zone, x0, y0, robot.x, robot.y)
        drive.arrived = max(0.0, drive.since - (1.0 - fraction) * TICK)
