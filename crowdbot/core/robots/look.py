"""A robot's appearance: the visible shapes of its description.

Cameras draw each as a solid; a view from above shows the outline of its projection.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import NamedTuple
from xml.etree import ElementTree as Xml

import numpy as np
import shapely  # type: ignore[import-untyped,unused-ignore]

from crowdbot.core.robots.description import Description
from crowdbot.core.robots.description_file import read_description
from crowdbot.core.robots.xml import matrix, numbers, pose_of
from crowdbot.core.types.arrays import Array
from crowdbot.core.types.robot import RobotModel

_RIM = 24  # corners of a circle
_GREY = "#8a8d91"
_LEAST = 1e-6  # m^2; smaller outlines are not drawn


class SeenPart(NamedTuple):
    """A visible part, seen from above.

    Attributes:
        outline: (K, 2) convex, counter-clockwise, base frame, m.
        colour: ``#rrggbb``.
        top: height of its top above the base's frame, m.
    """

    outline: Array
    colour: str
    top: float


class VisualPart(NamedTuple):
    """A part as cameras see it.

    Attributes:
        corners: (N, 3) points whose convex hull is the part, base frame, m.
        colour: ``#rrggbb``.
    """

    corners: Array
    colour: str


def visual_parts(robot: RobotModel) -> list[VisualPart]:
    """Return the visible parts, without meshes."""
    described = read_description(robot.description)
    return [
        part
        for name, link in described.links.items()
        for part in _visual_parts(link, described.pose(name, robot.base), described)
    ]


def seen_from_above(robot: RobotModel) -> list[SeenPart]:
    """Return the visible parts, lowest first, without meshes."""
    found = []
    for corners, colour in visual_parts(robot):
        outline = _hull(corners[:, :2])
        if len(outline):
            found.append(SeenPart(outline, colour, float(corners[:, 2].max())))
    return sorted(found, key=lambda part: part.top)


def _visual_parts(link: Xml.Element, at: Array, described: Description) -> Iterator[VisualPart]:
    for visual in link.findall("visual"):
        for shape in visual.findall("geometry/*"):
            cloud = _cloud(shape)
            if len(cloud):
                pose = at @ matrix(pose_of(visual))
                placed = cloud @ pose[:3, :3].T + pose[:3, 3]
                yield VisualPart(placed, _colour(visual, described))


def _cloud(shape: Xml.Element) -> Array:
    """Return points (N, 3) whose hull is the shape; empty for a mesh."""
    if shape.tag == "box":
        half = 0.5 * np.array(_values(shape, "size"))
        signs = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
        return np.asarray(signs * half)
    if shape.tag in ("cylinder", "capsule"):
        (radius,), (length,) = _values(shape, "radius"), _values(shape, "length")
        ring, end = _circle(radius), np.array([0.0, 0.0, 0.5 * length])
        return np.concatenate([ring + end, ring - end])
    if shape.tag == "sphere":
        (radius,) = _values(shape, "radius")
        ring = _circle(radius)
        return np.concatenate([ring, ring[:, [0, 2, 1]], ring[:, [2, 1, 0]]])
    return np.zeros((0, 3))


def _circle(radius: float) -> Array:
    angle = np.linspace(0.0, 2.0 * math.pi, _RIM, endpoint=False)
    return np.column_stack([radius * np.cos(angle), radius * np.sin(angle), np.zeros(_RIM)])


def _values(shape: Xml.Element, name: str) -> list[float]:
    """Return numbers that are an attribute in URDF and text in SDFormat."""
    return numbers(shape.get(name) or shape.findtext(name) or "", f"the {name} of a {shape.tag}")


def _hull(points: Array) -> Array:
    """Return the corners (K, 2) of the convex hull, counter-clockwise; empty without area.

    Uses shapely, which is loaded anyway; scipy.spatial takes half a second to load.
    """
    hull = shapely.convex_hull(shapely.multipoints(points))
    if hull.geom_type != "Polygon" or hull.area <= _LEAST:
        return np.zeros((0, 2))
    ring = hull.exterior
    return np.asarray(ring.coords[:-1] if ring.is_ccw else ring.coords[:0:-1])


def _colour(visual: Xml.Element, described: Description) -> str:
    text = visual.findtext("material/diffuse")
    material = visual.find("material")
    if text is None and material is not None:
        named = described.model.find(f"material[@name='{material.get('name')}']")
        for place in (material, named):
            colour = None if place is None else place.find("color")
            if colour is not None:
                text = colour.get("rgba")
                break
    if text is None:
        return _GREY
    red, green, blue, *_ = (round(255.0 * min(1.0, max(0.0, c))) for c in numbers(text, "a colour"))
    return f"#{red:02x}{green:02x}{blue:02x}"
