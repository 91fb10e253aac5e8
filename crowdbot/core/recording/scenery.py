"""Messages for static data: frames on the robot, walls, map, goal, robot description."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

import crowdbot.core.recording.markers as markers
import crowdbot.core.recording.messages as ros
from crowdbot.core.geometry.optical_frame import OPTICAL_QUATERNION, optical
from crowdbot.core.recording.header import RecordingHeader
from crowdbot.core.recording.links import link_frames
from crowdbot.core.recording.namespace import in_namespace
from crowdbot.core.types.arrays import Array
from crowdbot.core.types.motion import Pose

BASE = "base_footprint"
#: Frames defined by the recording, which no sensor may have.
FRAMES = ("map", "odom", BASE, "base_link")
_WALL_COLOUR = (0.3, 0.3, 0.3, 1.0)
#: Map: size of a cell (m), margin around the walls (m), and largest number of cells per direction.
CELL, _RIM, _MOST_CELLS = 0.05, 0.5, 4000
_OCCUPIED, _UNKNOWN = 100, -1


def static_frames(header: RecordingHeader, description: str = "") -> list[Any]:
    """Return the transforms of ``map``, ``odom``, ``base_footprint``, ``base_link`` and sensors.

    The fixed links of the robot's URDF are included. Empty without a robot, as for people recorded
    apart from several robots, who have no odometry.
    """
    robot = header.robot
    if robot is None:
        return []
    odom, footprint, base = (in_namespace(header.namespace, f) for f in ("odom", BASE, "base_link"))
    frames = [ros.transform(0, "map", odom, (0.0, 0.0, 0.0), 0.0)]
    frames.append(ros.transform(0, footprint, base, (0.0, 0.0, robot.base_height), 0.0))
    own = [in_namespace(header.namespace, frame) for frame in FRAMES]
    mounted = {s.frame: s for s in header.sensors.values() if s.frame not in own}
    for frame, sensor in mounted.items():
        *at, yaw = sensor.mount
        frames.append(ros.transform(0, base, frame, (at[0], at[1], at[2]), yaw, sensor.tilt))
    for info in (s for s in header.sensors.values() if s.camera is not None):
        here = ros.transform(0, info.frame, optical(info.frame), (0.0, 0.0, 0.0), 0.0)
        turned = dict(zip("xyzw", OPTICAL_QUATERNION, strict=True))
        here.transform.rotation = ros.new("geometry_msgs/Quaternion", **turned)
        frames.append(here)
    known = [footprint, *(frame.child_frame_id for frame in frames)]
    return [*frames, *link_frames(description, header.namespace, known)]


def wall_lines(walls: Array) -> Any:
    """Return walls (S, 4), m, as one list of lines."""
    ends = np.zeros((2 * len(walls), 3))
    ends[:, :2] = np.asarray(walls).reshape(-1, 2)
    return markers.marker(0, "walls", "LINE_LIST", (0.1, 0.0, 0.0), _WALL_COLOUR, ends)


def goal_pose(ns: int, header: RecordingHeader) -> Any | None:
    """Return the goal as ``geometry_msgs/PoseStamped``; None without a goal."""
    if header.robot is None or header.robot.goal is None:
        return None
    return ros.pose_stamped(ns, "map", Pose(*header.robot.goal, 0.0))


def occupancy_grid(
    ns: int, walls: Array, cell: float = CELL, goal: tuple[float, float] | None = None
) -> Any:
    """Return a map as ``nav_msgs/OccupancyGrid``: cells touched by a wall are occupied.

    If walls separate the goal from the rim of the map, everything outside them is unknown. All
    other cells are free.

    Args:
        ns: its stamp.
        walls: (S, 4) segments, m; at least one.
        cell: side of a cell, m; larger if the map would exceed 4000 cells per side.
        goal: the robot's goal, m, if there is one.
    """
    ends = np.asarray(walls, np.float64).reshape(-1, 2)
    low, high = ends.min(axis=0) - _RIM, ends.max(axis=0) + _RIM
    cell = max(cell, float(np.max(high - low)) / _MOST_CELLS)
    width, height = (math.ceil(extent / cell) for extent in (high - low).tolist())
    cells = np.zeros((height, width), np.int8)
    for x0, y0, x1, y1 in np.asarray(walls, np.float64).tolist():
        columns, rows = _cells((x0, y0), (x1, y1), low, cell)
        inside = (columns >= 0) & (columns < width) & (rows >= 0) & (rows < height)
        cells[rows[inside], columns[inside]] = _OCCUPIED
    if goal is not None:
        column, row = np.floor((np.asarray(goal) - low) / cell).astype(np.int64).tolist()
        _forget_outside(cells, row, column)
    origin = ros.new(
        "geometry_msgs/Pose",
        position=ros.new("geometry_msgs/Point", x=float(low[0]), y=float(low[1]), z=0.0),
        orientation=ros.new("geometry_msgs/Quaternion", x=0.0, y=0.0, z=0.0, w=1.0),
    )
    head = ros.header(ns, "map")
    info = ros.new(
        "nav_msgs/MapMetaData", map_load_time=head.stamp, resolution=cell, width=width,
        height=height, origin=origin,
    )  # fmt: skip
    return ros.new("nav_msgs/OccupancyGrid", header=head, info=info, data=cells.ravel())


def _forget_outside(cells: NDArray[np.int8], row: int, column: int) -> None:
    """Make the free cells around the walls unknown, unless the goal's cell is one of them."""
    from crowdbot.core.recording.flood_fill import connected  # numba, which a plan does not need

    height, width = cells.shape
    if not (0 <= row < height and 0 <= column < width) or cells[row, column]:
        return
    outside = connected(cells == 0, 0, 0)  # the rim is wider than a cell, and free all around
    if not outside[row, column]:
        cells[outside] = _UNKNOWN


def _cells(
    start: tuple[float, float], end: tuple[float, float], low: Array, cell: float
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Return columns and rows of the cells along a segment, sampled every quarter cell."""
    length = math.dist(start, end)
    along = np.linspace(0.0, 1.0, 2 + math.ceil(4.0 * length / cell))[:, np.newaxis]
    points = np.asarray(start) + along * (np.asarray(end) - np.asarray(start))
    found = np.floor((points - low) / cell).astype(np.int64)
    return found[:, 0], found[:, 1]
