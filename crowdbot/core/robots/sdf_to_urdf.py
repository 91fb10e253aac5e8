"""Convert an SDFormat model, whose frames are written out, to a URDF."""

from __future__ import annotations

from collections.abc import Mapping
from xml.etree import ElementTree as Xml

from crowdbot.core.robots.description import Description
from crowdbot.core.robots.xml import name_of, pose_of, six
from crowdbot.core.robots.xml import numbers as numbers_in
from crowdbot.errors import InputError

#: URDF requires limits that SDFormat may omit, which means unlimited there.
UNLIMITED = 1e9
_SHAPES = ("box", "cylinder", "sphere", "capsule", "mesh")


def from_sdf(described: Description, rates: Mapping[str, float]) -> Xml.Element:
    """Return the ``robot`` element of a URDF for an SDFormat model.

    Args:
        rates: velocity limits of joints without one in the description, rad/s.

    Raises:
        InputError: the description has a shape that URDF cannot express.
    """
    document = Xml.Element("robot", name=name_of(described.model) or "robot")
    for name, link in described.links.items():
        _link(Xml.SubElement(document, "link", name=name), link)
    for joint in described.model.findall("joint"):
        _joint(document, joint, described, rates.get(name_of(joint), UNLIMITED))
    return document


def _link(link: Xml.Element, source: Xml.Element) -> None:
    inertial = source.find("inertial")
    if inertial is not None:
        _inertial(Xml.SubElement(link, "inertial"), inertial)
    for kind in ("visual", "collision"):
        for item in source.findall(kind):
            part = Xml.SubElement(link, kind, name=name_of(item))
            write_origin(part, pose_of(item))
            _shape(Xml.SubElement(part, "geometry"), item)
            _material(part, item)


def _inertial(inertial: Xml.Element, source: Xml.Element) -> None:
    write_origin(inertial, pose_of(source))
    Xml.SubElement(inertial, "mass", value=source.findtext("mass", "").strip())
    moments = {k: source.findtext(f"inertia/{k}", "0").strip() for k in _MOMENTS}
    Xml.SubElement(inertial, "inertia", moments)


_MOMENTS = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")


def _shape(geometry: Xml.Element, source: Xml.Element) -> None:
    for shape in _SHAPES:
        found = source.find(f"geometry/{shape}")
        if found is not None:
            numbers = {c.tag: (c.text or "").strip() for c in found}
            if "uri" in numbers:
                numbers["filename"] = numbers.pop("uri")
            Xml.SubElement(geometry, shape, numbers)
            return
    if (radii := source.findtext("geometry/ellipsoid/radii")) is not None:  # a wheel about z
        radius, _, half = numbers_in(radii, f"the radii of '{name_of(source)}'")
        Xml.SubElement(geometry, "cylinder", radius=f"{radius:g}", length=f"{2.0 * half:g}")
        return
    kind = next((shape.tag for shape in source.findall("geometry/*")), "nothing")
    raise InputError(
        f"'{name_of(source)}' has the shape '{kind}', which URDF lacks; use {', '.join(_SHAPES)}"
    )


def _material(part: Xml.Element, source: Xml.Element) -> None:
    colour = source.findtext("material/diffuse")
    if part.tag == "visual" and colour is not None:
        material = Xml.SubElement(part, "material", name=f"{name_of(source)}_material")
        Xml.SubElement(material, "color", rgba=colour.strip())


def _joint(
    document: Xml.Element, source: Xml.Element, described: Description, fastest: float
) -> None:
    """Add a joint; ``fastest`` (rad/s) is its velocity limit if the description has none."""
    found = described.joints[name_of(source)]
    name, kind = found.name, "continuous" if found.free else found.kind
    joint = Xml.SubElement(document, "joint", name=name, type=kind)
    Xml.SubElement(joint, "parent", link=found.parent)
    Xml.SubElement(joint, "child", link=found.child)
    write_origin(joint, six(described.pose(found.child, found.parent)))
    axis = source.findtext("axis/xyz")
    if axis is not None:
        Xml.SubElement(joint, "axis", xyz=axis.strip())
    damping = source.findtext("axis/dynamics/damping")
    if damping is not None and kind != "fixed":
        Xml.SubElement(joint, "dynamics", damping=damping.strip())
    limits = {
        k: v.strip()
        for k in ("lower", "upper", "effort", "velocity")
        if (v := source.findtext(f"axis/limit/{k}")) is not None
    }
    for limit in ("effort", "velocity"):  # negative means unlimited in SDFormat
        if limits.get(limit, "").startswith("-"):
            del limits[limit]
    if limits:
        whole = {"effort": f"{UNLIMITED:g}", "velocity": f"{fastest:.12g}", **limits}
        Xml.SubElement(joint, "limit", whole)


def write_origin(parent: Xml.Element, pose: list[float]) -> None:
    """Add an ``origin`` of x, y, z, roll, pitch, yaw."""
    xyz, rpy = (" ".join(f"{v + 0.0:.12g}" for v in part) for part in (pose[:3], pose[3:]))
    Xml.SubElement(parent, "origin", xyz=xyz, rpy=rpy)
