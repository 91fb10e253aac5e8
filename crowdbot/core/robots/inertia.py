"""Whether moments of inertia are those of a body."""

from __future__ import annotations

from typing import Literal
from xml.etree import ElementTree as Xml

import numpy as np

from crowdbot.core.robots.xml import number

_SLACK = 1e-3  # of the largest moment; files are rounded
#: Radius of gyration of a part, m; a robot of 2 m has 0.6 m.
_WIDEST = 1.0
_MOMENTS = ("ixx", "iyy", "izz", "ixy", "ixz", "iyz")


def check_inertia(
    inertial: Xml.Element, radius: float | None
) -> Literal["impossible", "implausible"] | None:
    """What is wrong with the ``<inertial>`` of a link of a URDF; None: nothing.

    No body has moments that are not positive, or of which one is more than the other two
    together. No wheel has the gyration of a larger one.

    Args:
        radius: of the wheel that it is, m; None of all other links.

    Raises:
        PluginError: something that should be a number is not.
    """
    mass = _value(inertial.find("mass"), "value", "a mass")
    xx, yy, zz, xy, xz, yz = (_value(inertial.find("inertia"), n, n) for n in _MOMENTS)
    if mass <= 0.0:
        return None if mass == 0.0 and not any((xx, yy, zz)) else "impossible"
    moments = np.linalg.eigvalsh([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    if moments[0] <= 0.0 or moments[2] > (1.0 + _SLACK) * (moments[0] + moments[1]):
        return "impossible"
    widest = _WIDEST if radius is None else radius
    return "implausible" if moments[2] > mass * widest**2 * (1.0 + _SLACK) else None


def rolling(inertial: Xml.Element, radius: float) -> None:
    """Give it the moments of a ball as heavy as a disc of this radius (m) is to turn: m r^2 / 2.

    A ball's are the same about every axis, so that it does not matter how the link is turned.
    """
    moment = 0.5 * _value(inertial.find("mass"), "value", "a mass") * radius**2
    inertia = inertial.find("inertia")
    if inertia is None:
        inertia = Xml.SubElement(inertial, "inertia")
    for name in _MOMENTS:
        inertia.set(name, f"{moment:.9g}" if name[1] == name[2] else "0")


def _value(element: Xml.Element | None, name: str, what: str) -> float:
    return 0.0 if element is None else number(element.get(name, "0"), what)
