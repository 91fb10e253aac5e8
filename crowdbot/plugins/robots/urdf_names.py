"""Names of links and joints in a URDF or an SDFormat model, without building a robot."""

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
    model = top.find("model") if top.tag == "sdf" else top
    if model is None or top.tag not in ("robot", "sdf"):
        return {}
    if top.tag == "sdf" and any(model.find(other) is not None for other in ("model", "include")):
        return {}
    return {
        "link": frozenset(link.get("name", "") for link in model.findall("link")),
        "joint": frozenset(joint.get("name", "") for joint in model.findall("joint")),
    }
