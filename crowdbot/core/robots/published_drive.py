"""The drive of a published robot: axles that are not at the base, more than two driven wheels."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from xml.etree import ElementTree as Xml

import numpy as np

from crowdbot.core.robots.description import Description
from crowdbot.core.robots.joint import child_of, parent_of
from crowdbot.core.robots.xml import matrix, name_of, number, pose_of, six
from crowdbot.core.types.arrays import Array

#: A base that is nearer to the axle is not moved, m.
_SAME = 1e-3
#: Cosine of the largest angle between directions that are taken for opposite.
_OPPOSITE = -0.999
#: Share of a wheel's radius by which two statements of it may differ.
_ROUNDED = 0.02
#: Parameters of plugins, in lower case -> metres in their unit, what they say here, and in notes.
_DRIVES = {
    "wheelseparation": (1.0, "track", "wheel separation"),
    "wheelradius": (1.0, "radius", "wheel radius"),
    "wheeldiameter": (0.5, "radius", "wheel radius"),
}
_PARTS = ("inertial", "visual", "collision")
_ROUND = ("sphere", "cylinder")


def places_of(robot: Xml.Element, base: str, joints: Sequence[str]) -> dict[str, Array]:
    """Return the positions (3,) of wheels by joint, in the base's frame, m."""
    described = Description("", "urdf", robot)
    return {name: described.pose(described.joint(name).child, base)[:3, 3] for name in joints}


def sides(places: Mapping[str, Array]) -> list[list[str]]:
    """Return the joints of the left and of the right wheels, in the given order."""
    return [
        [n for n, at in places.items() if at[1] > 0.0],
        [n for n, at in places.items() if at[1] <= 0.0],
    ]


def put(robot: Xml.Element, base: str, joint: str, place: Array) -> None:
    """Move a wheel to a position in the base's frame, keeping its orientation."""
    described = Description("", "urdf", robot)
    element = next(j for j in robot.findall("joint") if name_of(j) == joint)
    pose = described.pose(child_of(element), base)
    pose[:3, 3] = place
    write_origin(element, described.pose(base, parent_of(element)) @ pose)


def add_support(robot: Xml.Element, base: str, name: str, place: Array, radius: float) -> None:
    """Add a sphere without friction to the base where a wheel was."""
    link = next(e for e in robot.findall("link") if name_of(e) == base)
    shape = Xml.SubElement(link, "collision", name=name)
    Xml.SubElement(shape, "origin", xyz=" ".join(f"{x:.9g}" for x in place.tolist()))
    Xml.SubElement(Xml.SubElement(shape, "geometry"), "sphere", radius=f"{radius:g}")


def onto_axle(robot: Xml.Element, base: str, driven: Sequence[str]) -> str:
    """Move the base's frame along x onto the axle of the driven wheels; return a note.

    Parent links of the base at the same x and y, such as base_footprint, move along.
    """
    ahead = float(np.mean([at[0] for at in places_of(robot, base, driven).values()]))
    if abs(ahead) <= _SAME:
        return ""
    described = Description("", "urdf", robot)
    above = {j.child: j.parent for j in described.joints.values()}
    chain = [base]
    while (parent := above.get(chain[-1])) is not None:
        chain.append(parent)
    if any(np.hypot(*described.pose(link, base)[:2, 3]) > _SAME for link in chain):
        chain = [base]
    by = {link: described.pose(base, link)[:3, :3] @ (ahead, 0.0, 0.0) for link in chain}
    for link in robot.findall("link"):
        if name_of(link) in by:
            for part in (p for kind in _PARTS for p in link.findall(kind)):
                _shift(part, -by[name_of(link)])
    for joint in robot.findall("joint"):
        if child_of(joint) not in by and parent_of(joint) in by:
            _shift(joint, -by[parent_of(joint)])
        elif child_of(joint) == chain[-1] and parent_of(joint):
            turn = matrix(pose_of(joint))[:3, :3]
            _shift(joint, turn @ by[chain[-1]])
    return (
        f"'{base}' is moved {1e3 * abs(ahead):.3g} mm {'ahead' if ahead > 0.0 else 'back'}, onto "
        "the axle of the driven wheels; sensors are mounted from there"
    )


def centre_wheel(robot: Xml.Element, base: str, joint: Xml.Element) -> str:
    """Move a wheel's frame along its axis to the middle of its round shapes; return a note."""
    name, wheel = name_of(joint), child_of(joint)
    link = next(e for e in robot.findall("link") if name_of(e) == wheel)
    shapes = [
        shape
        for shape in link.findall("collision")
        if any(shape.find(f"geometry/{kind}") is not None for kind in _ROUND)
    ]
    if not shapes:
        return ""
    described = Description("", "urdf", robot)
    along = described.pose(wheel, base)[:3, :3].T @ (0.0, 1.0, 0.0)
    by = float(np.mean([matrix(pose_of(c))[:3, 3] @ along for c in shapes]))
    if abs(by) <= _SAME:
        return ""
    for part in (p for kind in _PARTS for p in link.findall(kind)):
        _shift(part, -by * along)
    for other in robot.findall("joint"):
        if parent_of(other) == wheel:
            _shift(other, -by * along)
    _shift(joint, matrix(pose_of(joint))[:3, :3] @ (by * along))
    side = "left" if by > 0.0 else "right"
    return f"the middle of the wheel is {1e3 * abs(by):.3g} mm to the {side} of its joint: {name}"


def other_radius(link: Xml.Element, radius: float, joint: str) -> str:
    """Return a note if the round shapes of a wheel's link have another radius than is given, m."""
    for kind in ("collision", "visual"):
        found = [
            number(shape.get("radius", "0"), f"the radius of the wheel on '{joint}'")
            for tag in _ROUND
            for shape in link.findall(f"{kind}/geometry/{tag}")
        ]
        if found:
            own = max(found)
            same = abs(own - radius) <= _ROUNDED * radius
            return "" if same else f"wheel's radius is {radius:g} m, not {own:g} m: {joint}"
    return ""


def other_in_plugins(model: Xml.Element, track: float, radius: float) -> list[str]:
    """Return notes on Gazebo drives whose track or wheel radius (m) is not the one in use."""
    notes = []
    for plugin in model.iter("plugin"):
        for element in plugin.iter():
            scale, used, label = _DRIVES.get(element.tag.lower().replace("_", ""), (0.0, "", ""))
            try:
                length = scale * float(element.text or "0")
            except ValueError:
                continue
            own = track if used == "track" else radius
            if length > 0.0 and abs(length - own) > _ROUNDED * own:
                notes.append(
                    f"{label} {length:g} m in Gazebo's plugin is not used: the description has "
                    f"{own:.4g} m"
                )
    return list(dict.fromkeys(notes))


def point_left(robot: Xml.Element, base: str, joint: Xml.Element) -> str:
    """Let a driven wheel turn about the left of the base; return a note.

    A joint that does not turn in the file, and an axis that points to the right, get that axis.
    """
    name = name_of(joint)
    described = Description("", "urdf", robot)
    turn = described.pose(child_of(joint), base)[:3, :3]
    kind = joint.get("type", "")
    turns = kind in ("continuous", "revolute")
    if turns and (turn @ described.joint(name).axis)[1] > _OPPOSITE:
        return "" if kind == "continuous" else _made(kind, name)
    axis = joint.find("axis")
    axis = Xml.SubElement(joint, "axis") if axis is None else axis
    axis.set("xyz", " ".join(f"{x + 0.0:.12g}" for x in np.round(turn.T @ (0.0, 1.0, 0.0), 12)))
    if not turns:
        return _made(kind, name)
    return f"wheel's axis points to the right and is reversed, so that it drives ahead: {name}"


def _made(kind: str, name: str) -> str:
    return f"joint that is {kind} is made to turn, as a driven wheel: {name}"


def _shift(element: Xml.Element, by: Array) -> None:
    pose = matrix(pose_of(element))
    pose[:3, 3] += by
    write_origin(element, pose)


def write_origin(element: Xml.Element, pose: Array) -> None:
    """Write a pose (4, 4) as the origin of a URDF element."""
    origin = element.find("origin")
    if origin is None:
        origin = Xml.SubElement(element, "origin")
    numbers = [f"{x + 0.0:.12g}" for x in np.round(six(pose), 12)]
    origin.set("xyz", " ".join(numbers[:3]))
    origin.set("rpy", " ".join(numbers[3:]))
