"""Expand xacro's properties and arguments without running xacro.

Makers publish files that need xacro only for a name or a number: ``xacro:property``, ``xacro:arg``,
``${NAME}``, ``$(arg NAME)`` and ``$(optenv NAME DEFAULT)``, which is its default here, whatever the
environment says. Macros, conditions, includes and sums are left to xacro.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from xml.etree import ElementTree as Xml

_USE = re.compile(r"\$\{\s*(\w+)\s*\}|\$\(\s*arg\s+(\w+)\s*\)")
_VARIABLE = re.compile(r"\$\(\s*optenv\s+(\w+)\s*([^()]*)\)")
#: Properties may name others, to this depth.
_DEPTH = 8


def is_macro(element: Xml.Element) -> bool:
    """Return True for xacro elements, and for texts with ``${...}`` or ``$(...)``."""
    if _tag(element):
        return True
    return any("${" in value or "$(" in value for value in element.attrib.values())


def write_out(top: Xml.Element) -> tuple[str, ...]:
    """Replace uses of plain properties and arguments, in place, and remove their definitions.

    Returns:
        their names; none if something else is left to xacro, and nothing was changed.
    """
    definitions = [element for element in top if _tag(element)]
    values: dict[tuple[str, str], str] = {}
    for element in definitions:
        kind = _tag(element)
        given = element.get({"property": "value", "arg": "default"}.get(kind, ""))
        if given is None or len(element):
            return ()
        values[kind, element.get("name", "")] = given
    texts = [(e, key, value) for e in top.iter() for key, value in e.items()]
    variables = [found[1] for _, _, value in texts for found in _VARIABLE.finditer(value)]
    pairs = [(e, key, _filled(value, values)) for e, key, value in texts]
    if any("${" in text or "$(" in text for e, _, text in pairs if e not in definitions):
        return ()
    for element in definitions:
        top.remove(element)
    if any(_tag(element) for element in top.iter()):
        top.extend(definitions)
        return ()
    for element, key, text in pairs:
        element.set(key, text)
    return tuple(dict.fromkeys((*(name for _, name in values), *variables)))


def _tag(element: Xml.Element) -> str:
    """Return the name of an element of xacro; "" for others."""
    if not isinstance(element.tag, str):
        return ""
    space, _, name = element.tag.partition("}")
    return name if "xacro" in space else ""


def _filled(text: str, values: Mapping[tuple[str, str], str]) -> str:
    """Return a text with its variables replaced by ``values``, (kind, name) -> text."""

    def value(use: re.Match[str]) -> str:
        return values.get(("property", use[1]) if use[1] else ("arg", use[2]), use[0])

    text = _VARIABLE.sub(lambda use: use[2].strip(), text)
    for _ in range(_DEPTH):
        found = _USE.sub(value, text)
        if found == text:
            break
        text = found
    return text
