"""Write out the inertias that an SDFormat model leaves out: 1 kg, and moments of 1 kg m^2.

These are the defaults of the SDFormat specification (``<inertial>``, with identity for its pose),
and what the simulator takes. In URDF a link without ``<inertial>`` weighs nothing.
"""

from __future__ import annotations

from xml.etree import ElementTree as Xml

from crowdbot.core.robots.xml import name_of

_MOMENTS = {"ixx": "1", "iyy": "1", "izz": "1", "ixy": "0", "ixz": "0", "iyz": "0"}
#: Number of names that are listed.
_NAMED = 4


def write_out_inertias(model: Xml.Element) -> list[str]:
    """Complete the inertias of a model's links, in place; return notes on the changes."""
    without, unweighed, unshaped = list[str](), list[str](), list[str]()
    for link in model.findall("link"):
        inertial = link.find("inertial")
        if inertial is None:
            without.append(name_of(link))
            inertial = Xml.SubElement(link, "inertial")
        elif inertial.find("mass") is None:
            unweighed.append(name_of(link))
        elif not _has_moments(inertial):
            unshaped.append(name_of(link))
        _complete(inertial)
    notes = [
        (without, "<inertial>", "1 kg and moments of inertia of 1 kg m^2, the defaults"),
        (unweighed, "<mass>", "1 kg, the default"),
        (unshaped, "all moments of inertia", "1 kg m^2 for each that is missing, the default"),
    ]
    return [_note(names, part, usual) for names, part, usual in notes if names]


def _has_moments(inertial: Xml.Element) -> bool:
    return all(inertial.find(f"inertia/{name}") is not None for name in ("ixx", "iyy", "izz"))


def _complete(inertial: Xml.Element) -> None:
    if inertial.find("mass") is None:
        Xml.SubElement(inertial, "mass").text = "1"
    inertia = inertial.find("inertia")
    if inertia is None:
        inertia = Xml.SubElement(inertial, "inertia")
    for name, value in _MOMENTS.items():
        if inertia.find(name) is None:
            Xml.SubElement(inertia, name).text = value


def _note(names: list[str], part: str, usual: str) -> str:
    listed = ", ".join(names[:_NAMED])
    more = f" and {len(names) - _NAMED} more" if len(names) > _NAMED else ""
    some = "link without" if len(names) == 1 else f"{len(names)} links without"
    gets = "gets" if len(names) == 1 else "get"
    return f"{some} {part} {gets} {usual} of SDFormat: {listed}{more}"
