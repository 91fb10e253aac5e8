"""A planner's drawings, made in its robot's base frame, placed in the world and as lines."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

import crowdbot.core.recording.markers as markers
import crowdbot.core.recording.messages as ros
from crowdbot.core.types.arrays import Array

_COLOUR, _WIDTH, _HEIGHT = (0.7, 0.35, 0.0, 1.0), 0.04, 0.03

#: Length of the line that shows a point, m.
_POINT = 0.1
#: A track's line ends where its person would be after this time, s.
_AHEAD = 1.0


def drawn_lines(columns: Array, name: str = "") -> Array:
    """Return the lines (2, M, 2) from x, y to x, y that show a drawing, m.

    Args:
        columns: of `drawing_in_world`. A path (2, K): from each row to the next. Tracks (4, K):
            from each person to where it would be a second later.
        name: of the drawing. ``points…`` (2, K): a short line on each row; ``arrows…``: from each
            row to the next one, two rows each.
    """
    places = columns[:2].T
    if len(columns) == 2 and name.startswith("points"):
        half = np.array([_POINT / 2.0, 0.0])
        return np.stack([places - half, places + half])
    if len(columns) == 2 and name.startswith("arrows"):
        pairs = places[: len(places) // 2 * 2].reshape(-1, 2, 2)
        return np.stack([pairs[:, 0], pairs[:, 1]])
    if len(columns) == 2:
        return np.stack([places[:-1], places[1:]])
    return np.stack([places, places + _AHEAD * columns[2:].T])


def drawn_marker(ns: int, name: str, columns: Array) -> bytes:
    """Return ``visualization_msgs/Marker`` with the lines of a drawing, on the floor."""
    ends = drawn_lines(columns, name).transpose(1, 0, 2).reshape(-1, 2)
    points = np.column_stack([ends, np.full(len(ends), _HEIGHT)])
    size = (_WIDTH, 0.0, 0.0)
    return ros.to_cdr(markers.marker(ns, name, "LINE_LIST", size, _COLOUR, points))


def drawing_in_world(x: float, y: float, yaw: float, rows: ArrayLike, *, tracks: bool) -> Array:
    """Return x and y (2, K) of rows, m; of tracks also vx and vy, (4, K), m/s.

    Args:
        x, y, yaw: the robot's pose, m and rad.
        rows: (K, 2 or more) in its base frame; of tracks (K, 5) number, x, y, vx, vy.
    """
    given = np.asarray(rows, np.float64)
    c, s = math.cos(yaw), math.sin(yaw)
    rotation = np.array([[c, -s], [s, c]])
    first = 1 if tracks else 0
    places = rotation @ given[:, first : first + 2].T + np.array([[x], [y]])
    if not tracks:
        return np.asarray(places)
    return np.concatenate([places, rotation @ given[:, 3:5].T])
