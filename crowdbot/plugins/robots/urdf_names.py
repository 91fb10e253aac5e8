"""Names and masses in a URDF or an SDFormat model, without building a robot."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from pathlib import Path
from xml.etree import ElementTree as Xml

from crowdbot.plugin import DescribedPart

#: What only a build reads: names that xacro writes, and declarations.
_LEFT_TO_BUILD = ("${", "$(", "xacro:", "<!DOCTYPE", "<!ENTITY")


def urdf_names(file: Path) -> dict[DescribedPart, frozenset[str]]:
    """Return the names of links and joints; empty if the file has to be converted first.

    Raises:
        OSError: it cannot be read.
    """
    top = _plain(file)
    if top is None:
        return {}
    model = top.find("model") if top.tag == "sdf" else top
    if model is None or top.tag not in ("robot", "sdf"):
        return {}
    if top.tag == "sdf" and any(model.find(other) is not None for other in ("model", "include")):
        return {}
    return {
        "link": frozenset(link.get("name", "") for link in model.findall("link")),
        "joint": frozenset(joint.get("name", "") for joint in model.findall("joint")),
    }


def weightless(file: Path, base: str, wheels: Collection[str]) -> Iterator[str]:
    """Yield the links of a URDF that move and weigh nothing, with all that hangs on them.

    In SDFormat each link weighs something. Wrong numbers are left to the build.

    Args:
        file: the URDF.
        base: the link from which the wheels hang.
        wheels: joints of the wheels that turn; all others are held.

    Raises:
        OSError: it cannot be read.
    """
    top = _plain(file)
    if top is None or top.tag != "robot":
        return
    above, turning = dict[str, str](), set[str]()
    for joint in top.findall("joint"):
        child, parent = (joint.find(end) for end in ("child", "parent"))
        if child is not None and parent is not None:
            above[child.get("link", "")] = parent.get("link", "")
            if joint.get("name") in wheels:
                turning.add(child.get("link", ""))
    parts = dict[str, float]()
    for link in top.findall("link"):
        name = _hangs_on(link.get("name", ""), above, turning)
        mass = link.find("inertial/mass")
        parts[name] = parts.get(name, 0.0) + (0.0 if mass is None else _mass(mass))
    hung = {_hangs_on(base, above, turning)} | turning
    yield from (name for name, mass in parts.items() if name in hung and mass == 0.0)


def _plain(file: Path) -> Xml.Element | None:
    """Return the root of a file; None if only a build can read it."""
    text = file.read_bytes().decode(errors="replace").lstrip("\ufeff \t\r\n")
    if any(sign in text for sign in _LEFT_TO_BUILD):
        return None
    try:
        return Xml.fromstring(text)  # noqa: S314 - files that declare entities are left out
    except (Xml.ParseError, ValueError):  # the build tells it
        return None


def _hangs_on(link: str, above: dict[str, str], turning: Collection[str]) -> str:
    """Return the wheel that a link is part of, or the link at the top."""
    seen = set[str]()
    while link not in turning and link in above and link not in seen:
        seen.add(link)
        link = above[link]
    return link


def _mass(element: Xml.Element) -> float:
    try:
        return float(element.get("value", ""))
    except ValueError:
        return float("nan")
