"""Polygons and markers for 3-D viewers."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np

import crowdbot.core.recording.messages as ros
from crowdbot.core.types.arrays import Array
from crowdbot.core.types.motion import Pose


def polygon(ns: int, corners: Array) -> Any:
    """Return a polygon on the floor; (K, 2), m."""
    points = [ros.new("geometry_msgs/Point32", x=x, y=y, z=0.0) for x, y in corners.tolist()]
    return ros.new(
        "geometry_msgs/PolygonStamped",
        header=ros.header(ns, "map"),
        polygon=ros.new("geometry_msgs/Polygon", points=points),
    )


def marker(
    ns: int,
    namespace: str,
    kind: str,
    size: tuple[float, float, float],
    rgba: tuple[float, float, float, float],
    points: Array,
) -> Any:
    """Return a list marker in the map frame; ``points`` (K, 3), m; ``kind`` as in Marker.msg."""
    cls = ros.message_class("visualization_msgs/Marker")
    return cls(
        header=ros.header(ns, "map"),
        ns=namespace,
        id=0,
        type=getattr(cls, kind),
        action=cls.ADD,
        pose=ros.plane_pose(Pose(0.0, 0.0, 0.0)),
        scale=ros.vector(*size),
        color=ros.new("std_msgs/ColorRGBA", **dict(zip("rgba", rgba, strict=True))),
        lifetime=ros.new("builtin_interfaces/Duration", sec=0, nanosec=0),
        frame_locked=False,
        points=[ros.point(x, y, z) for x, y, z in points.tolist()],
        colors=[],
        texture_resource="",
        texture=ros.new(
            "sensor_msgs/CompressedImage",
            header=ros.header(0, ""),
            format="",
            data=np.zeros(0, np.uint8),
        ),
        uv_coordinates=[],
        text="",
        mesh_resource="",
        mesh_file=ros.new("visualization_msgs/MeshFile", filename="", data=np.zeros(0, np.uint8)),
        mesh_use_embedded_materials=False,
    )


def text_marker(
    ns: int,
    namespace: str,
    text: str,
    place: tuple[float, float, float],
    look: tuple[float, tuple[float, float, float, float]],
) -> Any:
    """Return a text in the map frame that faces its reader.

    Args:
        ns: stamp, ns.
        namespace: of the marker.
        text: what it says.
        place: x, y, z, m.
        look: height of a capital letter, m, and red, green, blue, opacity.
    """
    height, rgba = look
    label = marker(ns, namespace, "TEXT_VIEW_FACING", (0.0, 0.0, height), rgba, np.zeros((0, 3)))
    label.text, label.pose.position = text, ros.point(*place)
    return label


def marker_array(markers: Iterable[Any]) -> Any:
    """Return several markers in one message."""
    return ros.new("visualization_msgs/MarkerArray", markers=list(markers))


def delete_all_markers(ns: int = 0) -> Any:
    """Return a marker that deletes earlier ones."""
    gone = marker(ns, "", "CUBE", (1.0, 1.0, 1.0), (0.0, 0.0, 0.0, 0.0), np.zeros((0, 3)))
    gone.action = gone.DELETEALL
    return gone
