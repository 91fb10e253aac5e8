"""Messages for 3-D viewers: people and contacts as markers, one by one, and the path."""

from __future__ import annotations

import math
from struct import Struct
from typing import Any

import numpy as np
from numpy.typing import NDArray

import crowdbot.core.recording.markers as markers
import crowdbot.core.recording.messages as ros
import crowdbot.core.recording.template as template
from crowdbot.core.recording.template import ANY_STAMP, ANY_TIME, Template
from crowdbot.core.types.arrays import Array
from crowdbot.core.types.motion import Pose

PATH_TYPE, ARROWS_TYPE = "nav_msgs/msg/Path", "visualization_msgs/msg/MarkerArray"
#: People one by one are large, and a path is written again and again, Hz.
PEOPLE_RATE, PATH_RATE = 4.0, 2.0
#: Slower people keep their last heading, m/s.
HEADING_MIN_SPEED = 0.1
_PERSON, _TOUCH = (0.36, 0.55, 0.78, 1.0), (0.85, 0.2, 0.15, 0.9)
_TOUCH_SIZE, _ARROW_HEIGHT, _SHORTEST = 0.25, 0.1, 0.1
#: Positions and lengths are multiples of 1/1024 m, numbers of quaternions of 1/16384: short
#: mantissas compress to a third.
_GRID, _FINE = 1024.0, 16384.0
_ID = Struct("<i")
_ANY_ID, _A, _B, _C, _D, _E = 0x11223344, 1.0625, 2.125, 3.1875, 4.25, 5.3125


class PeopleArrows:
    """An arrow per person with its id: in its heading, length by speed, width by body."""

    def __init__(self, ids: NDArray[np.int64], radius: Array) -> None:
        """Build the arrows. ``ids`` (M,) of the people, ``radius`` (M,) m."""
        self._id = np.asarray(ids, np.int64)
        self._width = np.rint(2.0 * np.asarray(radius, np.float64) * _GRID) / _GRID
        self._heading = np.zeros(len(self._id))
        self._blank: dict[int, Template] = {}  # by number of people

    def message(self, ns: int, state: Array) -> bytes:
        """Return ``visualization_msgs/MarkerArray`` of present people; ``state`` is (4, M)."""
        speed = np.hypot(state[2], state[3])
        with np.errstate(invalid="ignore"):
            moving = speed > HEADING_MIN_SPEED
        np.copyto(self._heading, np.arctan2(state[3], state[2]), where=moving)
        there = np.flatnonzero(np.isfinite(state[0]))
        blank = self._blank.get(len(there))
        if blank is None:
            blank = self._blank[len(there)] = _arrows(len(there))
        half, stamp = 0.5 * self._heading[there], template.stamp(ns)
        rows = np.column_stack((
            np.rint(state[0, there] * _GRID) / _GRID,
            np.rint(state[1, there] * _GRID) / _GRID,
            np.rint(np.sin(half) * _FINE) / _FINE,
            np.rint(np.cos(half) * _FINE) / _FINE,
            np.maximum(np.rint(speed[there] * _GRID) / _GRID, _SHORTEST),
            self._width[there],
        ))  # fmt: skip
        raw, parts = rows.tobytes(), [stamp]
        for k, number in enumerate(self._id[there].tolist()):
            row = raw[48 * k : 48 * (k + 1)]
            parts += (stamp, _ID.pack(number), row[:16], row[16:32], row[32:])
        return blank.fill(*parts)


def _arrows(count: int) -> Template:
    """Return a template.

    Places: stamp of the deletion; then per person stamp, id, x, y, turn, size.
    """
    gone = markers.delete_all_markers(ANY_TIME)
    arrow = markers.marker(
        ANY_TIME, "people", "ARROW", (_D, _E, _ARROW_HEIGHT), _PERSON, np.zeros((0, 3))
    )
    arrow.id, arrow.pose = _ANY_ID, ros.plane_pose(Pose(_A, _B, _C))
    of_each = (
        ANY_STAMP, _ID.pack(_ANY_ID), template.two(_A, _B), template.turn(_C),
        template.two(_D, _E),
    )  # fmt: skip
    return Template(markers.marker_array([gone, *[arrow] * count]), ANY_STAMP, *of_each * count)


class RobotPath:
    """Past poses of a robot: a path for viewers, and its pose at any time so far."""

    def __init__(self, radius: float) -> None:
        """Start a path. ``radius`` of the robot's footprint, m."""
        self._radius = radius
        self._rows: list[tuple[float, float, float, float]] = []
        self._path: list[tuple[float, float, float, float]] = []
        self._contacts = 0

    def add(self, t: float, x: float, y: float, yaw: float) -> None:
        """Add a pose; s, m, rad."""
        self._rows.append((t, x, y, yaw))
        if not self._path or t >= self._path[-1][0] + 1.0 / PATH_RATE - 1e-9:
            self._path.append(self._rows[-1])

    @property
    def known(self) -> bool:
        """Return True if the path has a pose."""
        return bool(self._rows)

    def path(self, ns: int) -> Any:
        """Return the path so far as ``nav_msgs/Path``."""
        poses = [_coarse(*row) for row in self._path]
        return ros.new("nav_msgs/Path", header=ros.header(ns, "map"), poses=poses)

    def touch(self, t: float, agent: int, bearing: float) -> Any:
        """Return a ball at a contact's start: ``visualization_msgs/MarkerArray`` with one marker.

        Args:
            t: start of the contact, s.
            agent: id of the person; -1 is a wall.
            bearing: bearing of the first point of contact, in the robot's frame, rad; NaN: unknown.
        """
        x, y, yaw = self._at(t)
        if math.isfinite(bearing):
            x += self._radius * math.cos(yaw + bearing)
            y += self._radius * math.sin(yaw + bearing)
        size = (_TOUCH_SIZE,) * 3
        stamp = ros.nanoseconds(t)
        ball = markers.marker(stamp, "contacts", "SPHERE", size, _TOUCH, np.zeros((0, 3)))
        ball.id, ball.pose = self._contacts, ros.plane_pose(Pose(x, y, 0.0))
        ball.text = f"person {agent}" if agent >= 0 else ("wall" if agent == -1 else "robot")
        self._contacts += 1
        return markers.marker_array([ball])

    def _at(self, t: float) -> tuple[float, float, float]:
        if not self._rows:
            return 0.0, 0.0, 0.0
        at, *columns = np.array(self._rows).T
        x, y, yaw = (float(np.interp(t, at, column)) for column in columns)
        return x, y, yaw


def _coarse(t: float, x: float, y: float, yaw: float) -> Any:
    """Return a rounded pose of a path, which compresses well."""
    short = Pose(round(x * _GRID) / _GRID, round(y * _GRID) / _GRID, yaw)
    pose = ros.pose_stamped(ros.nanoseconds(t), "map", short)
    turn = pose.pose.orientation
    turn.z, turn.w = round(turn.z * _FINE) / _FINE, round(turn.w * _FINE) / _FINE
    return pose
