"""Check that moments of inertia are physically possible."""

from __future__ import annotations

from typing import Literal
from xml.etree import ElementTree as Xml

import numpy as np

from crowdbot.core.robots.xml import number

_SLACK = 1e-3  # share of the largest moment; files are rounded
#: Largest radius of gyration of a part, m; a robot of 2 m has 0.6 m.
_WIDEST = 1.0
_MOMENTS = ("ixx", "iyy", "izz", "ixy", "ixz", "iyz")


def check_inertia(
    inertial: Xml.Element, radius: float | None
) -> Literal["impossible", "implausible"] | None:
    """Return the error in the ``<inertial>`` of a URDF link; None if there is none.

    Moments must be positive, and none may exceed the sum of the other two. A wheel's radius of
    gyration must fit its radius.

    Args:
        radius: radius of the wheel, m; None for other links.

    Raises:
        PluginError: a value is not a number.
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
    """Set the inertia of a sphere that rolls like a disc of this radius (m): m r^2 / 2.

    A sphere's inertia is equal about all axes, so the link's orientation does not matter.
    """
    moment = 0.5 * _value(inertial.find("mass"), "value", "a mass") * radius**2
    inertia = inertial.find("inertia")
    if inertia is None:
        inertia = Xml.SubElement(inertial, "inertia")
    for name in _MOMENTS:
        inertia.set(name, f"{moment:.9g}" if name[1] == name[2] else "0")


def _value(element: Xml.Element | None, name: str, subject: str) -> float:
    return 0.0 if element is None else number(element.get(name, "0"), subject)
