"""XML elements of a trial: numbers, places and wrappers in the original CrowdBot's format."""

from __future__ import annotations

import math
from xml.etree import ElementTree as Xml

#: Largest number of a float32, which stands for no limit.
UNLIMITED = "3.402823E+38"


def number(value: float) -> str:
    """Return a number as text, without a fraction if it is whole."""
    value = float(value) + 0.0
    return str(int(value)) if value == int(value) and abs(value) < 1e15 else repr(value)


def limit(value: float) -> str:
    """Return a limit of speed or acceleration; 1000 and more means no limit."""
    return UNLIMITED if value >= 1e3 else number(value)


def add(parent: Xml.Element, tag: str, **attributes: str) -> Xml.Element:
    """Append an element and return it."""
    return Xml.SubElement(parent, tag, attributes)


def place(parent: Xml.Element, tag: str, x: float, y: float, z: float = 0.0) -> Xml.Element:
    """Append a place: crowdbot's x is a trial's y, its y a trial's x."""
    return add(parent, tag, x=number(y), y=number(x), z=number(z))


def turn(parent: Xml.Element, heading: float) -> Xml.Element:
    """Append a ``Rotation`` in degrees, with the sense of rotation reversed."""
    return add(parent, "Rotation", x="0", y="0", z=number(-math.degrees(heading)))


def text_of(root: Xml.Element) -> str:
    """Return a document as text: indented, with a byte order mark, as the original's files."""
    Xml.indent(root)
    body = Xml.tostring(root, encoding="unicode")
    return f'\ufeff<?xml version="1.0" encoding="utf-8"?>\n{body}\n'
