"""Names of links and joints in a URDF, without building a robot."""

from __future__ import annotations

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
    text = file.read_bytes().decode(errors="replace").lstrip("\ufeff \t\r\n")
    if any(sign in text for sign in _LEFT_TO_BUILD):
        return {}
    try:
        top = Xml.fromstring(text)  # noqa: S314 - files that declare entities are left out
    except (Xml.ParseError, ValueError):  # the build tells it
        return {}
    if top.tag != "robot":
        return {}
    return {
        "link": frozenset(link.get("name", "") for link in top.findall("link")),
        "joint": frozenset(joint.get("name", "") for joint in top.findall("joint")),
    }
