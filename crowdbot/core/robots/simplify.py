"""Simplify a robot's description for the simulation: a body, and rolling wheels.

- Joints with limits (arms, pan and tilt heads) are held at zero.
- Wheels touch the floor as spheres: a cylinder's contact point jumps between its rims
  (docs/decisions/0004).
- Shapes without given friction slide without friction, like casters and omni wheels, except driven
wheels, which grip.
- Visual shapes, and motors except those of the driven wheels, are left out.
"""

from __future__ import annotations

from collections.abc import Collection
from copy import deepcopy
from typing import NamedTuple
from xml.etree import ElementTree as Xml

from crowdbot.core.robots.convex_piece import corners_of, is_piece
from crowdbot.core.robots.description import Description, Format
from crowdbot.core.robots.xml import matrix, name_of, pose_of
from crowdbot.core.types.arrays import Array

_DRAKE = "{http://drake.mit.edu}"
Xml.register_namespace("drake", "http://drake.mit.edu")  # otherwise it would become ns0


class LinkPiece(NamedTuple):
    """A convex piece of a link, which Drake's parser does not read.

    Attributes:
        corners: (N, 3) points whose hull it is, in the link's frame, m.
    """

    link: str
    name: str
    corners: Array


def simplified(described: Description, driven: Collection[str]) -> tuple[str, list[LinkPiece]]:
    """Return the text for Drake's parser, in the format of the description, and convex pieces.

    Args:
        driven: names of the joints of the driven wheels.
    """
    model = deepcopy(described.model)
    for unused in (*model.findall("transmission"), *model.findall("material")):
        model.remove(unused)
    for joint in model.findall("joint"):
        if not described.joints[name_of(joint)].free:
            _hold(joint)
    wheels = {joint.child for joint in described.joints.values() if joint.free}
    gripping = {described.joint(name).child for name in driven}
    pieces = list[LinkPiece]()
    for link in model.findall("link"):
        for visual in link.findall("visual"):
            link.remove(visual)
        for collision in link.findall("collision"):
            shape = collision.find("geometry/mesh")
            if shape is not None and is_piece(shape):
                pieces.append(_piece(link, collision, shape))
                link.remove(collision)
                continue
            if name_of(link) in wheels:
                _round(collision)
            if name_of(link) not in gripping:
                _let_slide(collision, described.format)
    return Xml.tostring(_whole(model, described), encoding="unicode"), pieces


def _piece(link: Xml.Element, collision: Xml.Element, shape: Xml.Element) -> LinkPiece:
    at = matrix(pose_of(collision))
    placed = corners_of(shape) @ at[:3, :3].T + at[:3, 3]
    return LinkPiece(name_of(link), name_of(collision), placed)


def _whole(model: Xml.Element, described: Description) -> Xml.Element:
    if described.format == "urdf":
        return model
    document = Xml.Element("sdf", version=described.version)
    document.append(model)
    return document


def _hold(joint: Xml.Element) -> None:
    joint.set("type", "fixed")
    for tag in ("axis", "limit", "mimic", "dynamics"):
        for part in joint.findall(tag):
            joint.remove(part)


def _round(collision: Xml.Element) -> None:
    geometry = collision.find("geometry")
    cylinder = None if geometry is None else geometry.find("cylinder")
    if geometry is None or cylinder is None:
        return
    geometry.remove(cylinder)
    sphere = Xml.SubElement(geometry, "sphere")
    if "radius" in cylinder.attrib:
        sphere.set("radius", cylinder.attrib["radius"])
    sphere.extend(cylinder.findall("radius"))


def _let_slide(collision: Xml.Element, kind: Format) -> None:
    rubs = (f"{_DRAKE}proximity_properties", "surface/friction")
    if any(collision.find(tag) is not None for tag in rubs):
        return
    properties = Xml.SubElement(collision, rubs[0])
    for name in ("mu_dynamic", "mu_static"):
        number = Xml.SubElement(properties, f"{_DRAKE}{name}")
        if kind == "urdf":
            number.set("value", "0")
        else:
            number.text = "0"
