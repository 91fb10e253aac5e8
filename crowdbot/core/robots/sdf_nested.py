"""Flatten nested models of SDFormat: their parts become those of the outer model.

A part of the model ``arm`` gets a name such as ``arm__wheel``, since simulators reserve ``::``. The
inner model's frame becomes a frame named ``arm``.
"""

from __future__ import annotations

from collections.abc import Iterator
from copy import deepcopy
from xml.etree import ElementTree as Xml

from crowdbot.core.robots.xml import name_of
from crowdbot.errors import PluginError

_MODEL = "__model__"
_KINDS = ("link", "joint", "frame")
#: Where an element or its part names a frame or a link, as attributes.
_ATTRIBUTES = ("relative_to", "attached_to", "expressed_in")


def without_nested(model: Xml.Element) -> tuple[Xml.Element, list[str]]:
    """Return a model without nested models, and notes; the model itself if it has none.

    Raises:
        PluginError: a model includes a file, or is placed by a frame that is not its own.
    """
    for include in model.iter("include"):
        uri = (include.findtext("uri") or "").strip()
        raise PluginError(
            f"the robot's model includes '{uri}'; write its <model> here, for example what "
            "'gz sdf -p FILE' prints"
        )
    inner = [name_of(nested) for nested in model.findall("model")]
    if not inner:
        return model, []
    made = deepcopy(model)
    _flatten(made)
    parts = ", ".join(f"{name}__PART" for name in inner)
    return made, [f"models inside the model are written out; their parts are named {parts}"]


def _flatten(model: Xml.Element) -> None:
    """Move the parts of all models inside into a model, in place."""
    for nested in model.findall("model"):
        _flatten(nested)
        name = name_of(nested)
        model.remove(nested)
        own = {name_of(part) for kind in _KINDS for part in nested.findall(kind)}
        model.append(_frame_of(nested, name))
        for kind in _KINDS:
            for part in nested.findall(kind):
                _rename(part, name, own)
                model.append(part)
    for element in _placed(model):
        for key in _ATTRIBUTES:
            if (value := element.get(key)) is not None:
                element.set(key, _flat(value))
    for end in (e for joint in model.findall("joint") for e in joint if e.tag in _ENDS):
        end.text = _flat((end.text or "").strip())


_ENDS = ("parent", "child")


def _flat(name: str) -> str:
    """Return the name of a nested part, ``arm::wheel``, as it is here; ``arm::__model__``: arm."""
    return name.removesuffix(f"::{_MODEL}").replace("::", "__")


def _frame_of(nested: Xml.Element, name: str) -> Xml.Element:
    """Return the frame that stands for a nested model: its own, attached to its first link."""
    links = [name_of(link) for link in nested.findall("link")]
    first = nested.get("canonical_link") or (links[0] if links else "")
    placed = nested.get("placement_frame")
    if placed not in (None, "", _MODEL):
        raise PluginError(f"model '{name}' is placed by its frame '{placed}'; place its own frame")
    frame = Xml.Element("frame", {"name": name})
    if first:
        frame.set("attached_to", f"{name}__{_flat(first)}")
    pose = nested.find("pose")
    pose = Xml.Element("pose") if pose is None else pose
    pose.text = pose.text or "0 0 0 0 0 0"
    if not pose.get("relative_to"):
        pose.set("relative_to", _MODEL)
    frame.append(pose)
    return frame


def _rename(part: Xml.Element, model: str, own: set[str]) -> None:
    """Give a part of a nested model, and what it names, the names of the outer one."""

    def outer(name: str) -> str:
        if name in ("", _MODEL):
            return model
        return name if name == "world" and name not in own else f"{model}__{name}"

    for element in _placed_in(part):
        for key in _ATTRIBUTES:
            if (value := element.get(key)) is not None:
                element.set(key, outer(value))
    if part.tag == "joint":
        for end in (e for e in part if e.tag in _ENDS):
            end.text = outer((end.text or "").strip())
    elif part.tag == "link" or not part.get("attached_to"):
        pose = part.find("pose")
        if pose is None:
            pose = Xml.SubElement(part, "pose")
            pose.text = "0 0 0 0 0 0"
        if not pose.get("relative_to"):
            pose.set("relative_to", model)
    part.set("name", f"{model}__{name_of(part)}")


def _placed(model: Xml.Element) -> Iterator[Xml.Element]:
    for kind in _KINDS:
        for part in model.findall(kind):
            yield from _placed_in(part)


def _placed_in(part: Xml.Element) -> Iterator[Xml.Element]:
    """Yield a part and everything in it that may name a frame."""
    yield part
    yield from part.iter("pose")
    yield from part.iter("xyz")
