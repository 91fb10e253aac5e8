"""People as messages: a struct of arrays for programs, a list of spheres for viewers."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

import crowdbot.core.recording.markers as markers
import crowdbot.core.recording.messages as ros
import crowdbot.core.recording.template as template
from crowdbot.core.recording.header import AgentsHeader
from crowdbot.core.types.arrays import Array

PEOPLE = "crowdbot_msgs/msg/Pedestrians"
MARKER = "visualization_msgs/msg/Marker"
#: Slower people keep their last heading, m/s.
HEADING_MIN_SPEED = 0.1
#: Numbers for ROS tools are multiples of 1/1024 m, m/s, rad: short mantissas compress to a third.
_GRID = 1024.0
_COLOUR = (0.36, 0.55, 0.78, 1.0)


class PeopleMessages:
    """Builds the messages of one crowd; remembers headings of standing people."""

    def __init__(self, agents: AgentsHeader) -> None:
        self._id = np.ascontiguousarray(agents.id, np.int64)
        self._radius = agents.radius.astype(np.float32)
        self._heading = np.zeros(len(self._id))
        self._height = float(np.median(agents.radius)) if len(self._id) else 0.3
        self._marker = _MarkerTemplate(self._spheres(np.full((1, 3), 1.5)), 1.5)
        self._people: dict[int, template.Template] = {}  # by number of people

    def pedestrians(self, ns: int, state: Array) -> bytes:
        """Return ``crowdbot_msgs/msg/Pedestrians`` of present people; ``state`` is (4, M)."""
        _, _, vx, vy = state
        moving = np.hypot(vx, vy) > HEADING_MIN_SPEED
        np.copyto(self._heading, np.arctan2(vy, vx), where=moving)
        there = _present(state)
        ids = self._id[there]
        blank = self._people.get(len(ids))
        if blank is None:
            blank = self._people[len(ids)] = template.pedestrians(len(ids))
        columns = _rounded(state[:, there]).astype(np.float32)
        heading = _rounded(self._heading[there]).astype(np.float32)
        everything = (ids, *columns, heading, self._radius[there])
        return blank.fill(template.stamp(ns), *[column.tobytes() for column in everything])

    def marker(self, ns: int, state: Array) -> bytes:
        """Return the serialised sphere list of present people; ``state`` is (4, M)."""
        there = _present(state)
        xy = _rounded(state[:2, there])
        points = np.full((xy.shape[1], 3), self._height)
        points[:, :2] = xy.T
        if len(points) == 0:
            return ros.to_cdr(self._spheres(points, ns))
        return self._marker.fill(ns, points)

    def _spheres(self, points: Array, ns: int = 0) -> Any:
        size = 2.0 * self._height
        return markers.marker(ns, "people", "SPHERE_LIST", (size, size, size), _COLOUR, points)


def _rounded(values: Array) -> Array:
    return np.asarray(np.rint(values * _GRID) / _GRID)


def _present(state: Array) -> NDArray[np.bool_]:
    there: NDArray[np.bool_] = ~np.isnan(state[0])
    return there


class _MarkerTemplate:
    """A serialised list marker with replaceable points.

    rosbags serialises points one object at a time, which would take 2 ms per simulated second with
    200 people. In CDR they are one block of doubles, preceded by their number; 24 bytes each, so
    that whatever follows keeps its alignment.
    """

    def __init__(self, marker: Any, coordinate: float) -> None:
        """Build the template. ``marker`` has one point, with all coordinates ``coordinate``."""
        data = ros.to_cdr(marker)
        start = data.index(np.full(3, coordinate).tobytes())
        count = data.rindex(np.uint32(1).tobytes(), 0, start)
        self._before, self._padding = data[12:count], data[count + 4 : start]
        self._head, self._after = data[:4], data[start + 24 :]

    def fill(self, ns: int, points: Array) -> bytes:
        """Return the marker with ``points`` (K, 3), K > 0, stamped ``ns``."""
        stamp, count = template.stamp(ns), len(points).to_bytes(4, "little")
        return b"".join(
            (self._head, stamp, self._before, count, self._padding, points.tobytes(), self._after)
        )
