"""Check the links of a description: their masses, and shapes that lift a robot off its wheels."""

from __future__ import annotations

from collections.abc import Iterator
from xml.etree import ElementTree as Xml

import numpy as np

from crowdbot.core.robots.convex_piece import corners_of, is_piece
from crowdbot.core.robots.description import Description
from crowdbot.core.robots.xml import matrix, number, numbers, pose_of
from crowdbot.core.types.arrays import Array
from crowdbot.errors import PluginError

#: Shapes may reach this far below the floor, m: casters of published files do.
_BELOW = 5e-3
_MOMENTS = ("ixx", "iyy", "izz")
_ROUNDED = 0.01  # share of the largest moment; files are rounded


def check_masses(described: Description) -> None:
    """Check that Drake uses each link's mass as given; it replaces invalid ones by 1 kg.

    Raises:
        PluginError: a mass is below 0; or 0 in SDFormat, with moments of inertia, or of a part that
            moves; or a wheel has no moments of inertia.
    """
    for name, link in described.links.items():
        mass = described.mass_of(name)
        if mass < 0.0:
            raise PluginError(f"link '{name}' has a mass of {mass:g} kg; it must not be negative")
        if mass > 0.0:
            continue
        if described.format == "sdf":
            raise PluginError(
                f"link '{name}' has mass 0, which SDFormat does not admit: write a small one, such "
                "as 0.001, with moments that fit it"
            )
        inertia = link.find("inertial/inertia")
        if inertia is not None and any(_moment(inertia, n) for n in _MOMENTS):
            raise PluginError(f"link '{name}' has mass 0 and moments of inertia above 0; write one")
    wheels = {joint.child for joint in described.joints.values() if joint.free}
    for name, part in _parts(described).items():
        if not any(described.mass_of(link) for link in part):
            raise PluginError(
                f"link '{name}' weighs nothing, with all that is fixed to it; a part that moves "
                "needs a mass"
            )
        if name in wheels and not any(_resists(described, link) for link in part):
            raise PluginError(
                f"link '{name}' has no moments of inertia; a wheel needs some: for a disc, half of "
                "its mass times its radius squared"
            )


def _parts(described: Description) -> dict[str, list[str]]:
    """Return groups of rigidly connected links, by the topmost link of each group."""
    above = {joint.child: joint for joint in described.joints.values()}
    parts = dict[str, list[str]]()
    for name in described.links:
        top, seen = name, {name}
        while (joint := above.get(top)) is not None and not joint.free and joint.parent not in seen:
            top = joint.parent
            seen.add(top)
        parts.setdefault(top, []).append(name)
    return parts


def _resists(described: Description, link: str) -> bool:
    """Return True if a link has moments of inertia."""
    inertia = described.links[link].find("inertial/inertia")
    return inertia is not None and any(_moment(inertia, name) for name in _MOMENTS)


def impossible_moments(described: Description) -> Iterator[str]:
    """Yield a note for each link with impossible moments of inertia, which Drake replaces."""
    for name, link in described.links.items():
        inertia = link.find("inertial/inertia")
        if inertia is None or not described.mass_of(name) > 0.0:
            continue
        xx, yy, zz, xy, xz, yz = (_moment(inertia, n) for n in (*_MOMENTS, "ixy", "ixz", "iyz"))
        least, middle, most = np.linalg.eigvalsh([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
        if least < -_ROUNDED * most or most > (1.0 + _ROUNDED) * (least + middle):
            yield f"no body has the moments of inertia of '{name}': Drake takes others"


def _moment(inertia: Xml.Element, name: str) -> float:
    text = inertia.get(name) or inertia.findtext(name) or "0"
    return number(text, f"{name} of an inertia")


def below_floor(described: Description, base: str, height: float) -> Iterator[str]:
    """Yield a note for each link other than a wheel whose shape reaches below the floor.

    Args:
        base: link whose frame lies ``height`` (m) above the floor.
    """
    wheels = {joint.child for joint in described.joints.values() if joint.free}
    for name, link in described.links.items():
        if name in wheels:
            continue
        at = described.pose(name, base)
        lows = [
            _lowest(shape, at @ matrix(pose_of(collision))) + height
            for collision in link.findall("collision")
            for shape in collision.findall("geometry/*")
        ]
        if lows and min(lows) < -_BELOW:
            yield (
                f"the collision shape of '{name}' reaches {-1e3 * min(lows):.3g} mm below the "
                "floor on which the wheels stand, and may lift them off it"
            )


def _lowest(shape: Xml.Element, at: Array) -> float:
    """Return the height of the lowest point of a shape, m, in a frame where it has this pose."""
    up, z = at[2, :3], float(at[2, 3])
    kind = shape.tag.rpartition("}")[2].rpartition(":")[2]
    if kind == "empty":
        return float(np.inf)
    if is_piece(shape):
        return float((corners_of(shape) @ up).min()) + z
    if kind == "box":
        return z - float(np.abs(up) @ _values(shape, "size")) / 2.0
    if kind == "ellipsoid":
        return z - float(np.linalg.norm(up * _ellipsoid(shape)))
    (radius,) = _values(shape, "radius")
    if kind == "sphere":
        return z - float(radius)
    (length,) = _values(shape, "length")
    lean = 1.0 if kind == "capsule" else float(np.hypot(up[0], up[1]))
    return z - float(abs(up[2]) * length / 2.0 + radius * lean)


def _ellipsoid(shape: Xml.Element) -> Array:
    """Return its half axes (3,): ``radii`` in SDFormat, ``a``, ``b``, ``c`` in Drake's URDF."""
    if shape.find("radii") is not None:
        return _values(shape, "radii")
    return np.concatenate([_values(shape, name) for name in "abc"])


def _values(shape: Xml.Element, name: str) -> Array:
    text = shape.get(name) or shape.findtext(name) or ""
    return np.array(numbers(text, f"the {name} of a {shape.tag}"))
