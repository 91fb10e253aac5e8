"""Planners' drawings, given in the robot's base frame, as messages and in the world frame."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

import crowdbot.core.recording.markers as markers
import crowdbot.core.recording.messages as ros
from crowdbot.core.planning.drawn import Drawn
from crowdbot.core.planning.planner import TRACKS
from crowdbot.core.recording.topics import Topic
from crowdbot.core.types.arrays import Array

_COLOUR, _WIDTH, _HEIGHT = (0.7, 0.35, 0.0, 1.0), 0.04, 0.03

#: Length of the line that shows a point, m.
_POINT = 0.1
#: Height of letters and of their place above the floor, m; time for which texts are shown, s.
_LETTER, _TEXT_HEIGHT, _TEXT_AGE = 0.25, 2.0, 0.5
#: A track's line ends where its person would be after this time, s.
_AHEAD = 1.0


def drawn_lines(columns: Array, name: str = "") -> Array:
    """Return the line segments (2, M, 2), from and to x, y, that show a drawing, m.

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


def text_markers(ns: int, name: str, columns: Array, texts: Sequence[str]) -> list[bytes]:
    """Return one ``visualization_msgs/Marker`` for each text that is not empty, above heads.

    They expire if they are not drawn again, as in the replay.
    """
    found = []
    for number, ((x, y), text) in enumerate(zip(columns[:2].T.tolist(), texts, strict=True)):
        if text:
            label = markers.text_marker(ns, name, text, (x, y, _TEXT_HEIGHT), (_LETTER, _COLOUR))
            label.id, label.lifetime.nanosec = number, round(1e9 * _TEXT_AGE)
            found.append(ros.to_cdr(label))
    return found


def drawing_message(ns: int, frame: str, drawn: Drawn) -> tuple[str, int, Any]:
    """Return topic, stamp (ns) and message of a drawing in a recording.

    Args:
        ns: stamp, ns.
        frame: the robot's base frame.
        drawn: the drawing.
    """
    kind = "crowdbot_msgs/Drawing" if drawn.texts is None else "crowdbot_msgs/DrawnTexts"
    topic = Topic.TRACKS if drawn.name == TRACKS else Topic.THOUGHTS
    texts = {} if drawn.texts is None else {"texts": list(drawn.texts)}
    message = ros.new(
        kind,
        header=ros.header(ns, frame),
        name=drawn.name,
        columns=drawn.rows.shape[1],
        data=drawn.rows.ravel(),
        **texts,
    )
    return topic if drawn.texts is None else Topic.THOUGHT_TEXTS, ns, message


def drawing_in_world(x: float, y: float, yaw: float, rows: ArrayLike, *, tracks: bool) -> Array:
    """Return x and y (2, K) of points in the world, m; of tracks also vx and vy, (4, K), m/s.

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
