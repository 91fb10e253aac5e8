"""Addresses of the arrays of a robot with kinematic control, for compiled code."""

from __future__ import annotations

import numpy as np

from crowdbot.core.batch.array_tables import ArrayTable
from crowdbot.core.geometry.footprint import footprint_of_model
from crowdbot.core.sim.control.kinematic import obstacles
from crowdbot.core.support.records import record_type, rows_of
from crowdbot.core.support.ticks import TICK
from crowdbot.core.types.arrays import Array
from crowdbot.core.types.environment import EnvironmentParts
from crowdbot.core.types.robot import RobotModel

#: Arrays of a robot, in the order of the columns below.
ROBOT_FIELDS = ("limits", "walls", "pillars", "corners", "zone")
LIMITS, WALLS, PILLARS, CORNERS, ZONE = range(len(ROBOT_FIELDS))

_SKIN = 1e-6  # m; distance kept by corners, as in `KinematicBase`


class DriveLimitsRecord:
    """Limits of a robot's motion.

    Attributes:
        least_v, most_v, most_w, most_vy: of commands, m/s and rad/s.
        dv, dw: largest change in a tick, m/s and rad/s.
        radius: rounding of its outline, m.
        reach: radius of the circle around its origin that holds it, m.
    """

    least_v: float
    most_v: float
    most_w: float
    most_vy: float
    dv: float
    dw: float
    radius: float
    reach: float


class DriveStateRecord:
    """A robot's state of motion beyond pose and velocity, which are in the crowd's table.

    Attributes:
        v, w, vy: the command after slew limits, m/s and rad/s.
        wanted_v, wanted_w, wanted_vy: the command before slew limits.
        clear: lower bound of the distance between its outline and walls, m.
        blocked: ticks in which a wall stopped it, since the step began.
        touched: ticks in which a person touched it, since the step began.
        since: time since the step began, s.
        arrived: time since the beginning of the step at which it entered its goal zone, s; below 0
            while it has not.
        gap: from its outline to the nearest person at the end of the step, m.
        advance: distance driven towards people, weighted by the room that they lack, m.
        work: work that people need against it to keep room, J.
        forced: its work, per mass, against people who evade it at the last moment, since the step
            began, J/kg.
        aside: people whom it has driven aside since the step began, each as in
            `encounters.driven_aside`.
    """

    v: float
    w: float
    vy: float
    wanted_v: float
    wanted_w: float
    wanted_vy: float
    clear: float
    blocked: float
    touched: float
    since: float
    arrived: float
    gap: float
    advance: float
    work: float
    forced: float
    aside: float


DRIVE_LIMITS, DRIVE_STATE = record_type(DriveLimitsRecord), record_type(DriveStateRecord)


def robot_table(model: RobotModel, parts: EnvironmentParts, zone: Array) -> ArrayTable:
    """Return a table with the addresses of a robot's arrays.

    Args:
        zone: (K, 2) its goal zone, m.
    """
    body, limits, own = footprint_of_model(model), model.limits, ArrayTable(ROBOT_FIELDS)
    walls, pillars = obstacles(parts, model.height)
    row = rows_of(1, DRIVE_LIMITS)
    for name, value in {
        "least_v": limits.v_min,
        "most_v": limits.v_max,
        "most_w": limits.w_max,
        "most_vy": limits.vy_max,
        "dv": limits.a_max * TICK,
        "dw": limits.alpha_max * TICK,
        "radius": max(body.radius, _SKIN),
        "reach": body.reach,
    }.items():
        row[name][:] = value
    own.put(
        limits=row,
        walls=np.ascontiguousarray(walls),
        pillars=np.ascontiguousarray(pillars),
        corners=np.ascontiguousarray(body.corners),
        zone=np.ascontiguousarray(zone, np.float64),
    )
    return own
