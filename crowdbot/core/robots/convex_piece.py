"""Convex pieces in a robot's description: shapes whose hull is given by points in the text.

A piece is a ``<mesh>`` with its corners in an attribute, so that a description needs no files and
is the same on every machine. Programs that read only the file's name find none and leave it out.
"""

from __future__ import annotations

from xml.etree import ElementTree as Xml

import numpy as np

from crowdbot.core.robots.xml import numbers
from crowdbot.core.types.arrays import Array
from crowdbot.errors import PluginError

_CORNERS = "corners"


def add_piece(geometry: Xml.Element, corners: Array, name: str) -> None:
    """Add a piece to a ``<geometry>``.

    Args:
        corners: (N, 3) points whose convex hull it is, in the collision's frame, m.
        name: of the piece.
    """
    text = " ".join(f"{x:.6g}" for x in corners.ravel().tolist())
    Xml.SubElement(geometry, "mesh", {"filename": f"{name}.piece", _CORNERS: text})


def is_piece(shape: Xml.Element) -> bool:
    """Return True if a shape is a convex piece."""
    return shape.tag == "mesh" and shape.get(_CORNERS) is not None


def corners_of(shape: Xml.Element) -> Array:
    """Return the corners (N, 3) of a piece, m.

    Raises:
        PluginError: they are not at least four points of three numbers.
    """
    values = numbers(shape.get(_CORNERS, ""), "the corners of a convex piece")
    if len(values) < 12 or len(values) % 3:
        raise PluginError(f"a convex piece has at least four corners, not {len(values)} numbers")
    return np.array(values).reshape(-1, 3)
