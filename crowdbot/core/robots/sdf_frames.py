"""Convert the frames of an SDFormat model so that each moving link's frame is that of its joint.

In SDFormat the pose of a joint is relative to its child, and poses may be relative to links, joints
and frames. URDF, checks and models need one frame for a link and its joint. Links on fixed joints
keep their frames, on which sensors are mounted.
"""

from __future__ import annotations

from collections.abc import Mapping
from copy import deepcopy
from xml.etree import ElementTree as Xml

import numpy as np

from crowdbot.core.robots.xml import matrix, name_of, numbers, pose_of, six
from crowdbot.core.types.arrays import Array
from crowdbot.errors import PluginError, did_you_mean, nearest

_MODEL = "__model__"
_PARTS = ("inertial", "collision", "visual")
#: Joints of casters that turn about every axis: a sphere that slides stands for them.
_BALLS = ("ball", "universal")


def written_out(model: Xml.Element, version: str) -> tuple[Xml.Element, list[str]]:
    """Return a model without joint poses, frames and ball joints, and notes on the changes.

    A model without any of these is returned itself.

    Args:
        model: the ``model`` element.
        version: of SDFormat; before 1.5 axes are in the model's frame.

    Raises:
        PluginError: a pose is relative to something that is not there, or to itself.
    """
    joints = model.findall("joint")
    balls = [name_of(joint) for joint in joints if joint.get("type") in _BALLS]
    if not balls and not any(_is_elsewhere(model, version)):
        return model, []
    made = _Frames(model, version).model()
    for joint in made.findall("joint"):
        if name_of(joint) in balls:
            joint.set("type", "fixed")
            for axis in joint.findall("axis"):
                joint.remove(axis)
    one = "ball joint is held; its caster slides" if len(balls) == 1 else (
        f"{len(balls)} ball joints are held; their casters slide")  # fmt: skip
    return made, [f"{one}: {', '.join(balls)}"] if balls else []


def _is_elsewhere(model: Xml.Element, version: str) -> list[bool]:
    """Return True for each element that needs conversion, since its frame is not the default."""
    found = [bool(model.findall("frame"))]
    for joint in model.findall("joint"):
        found += [any(pose_of(joint)), _reference(joint) != ""]
        axis = joint.find("axis")
        found.append(axis is not None and _axis_frame(axis, version) != "")
    parts = [
        part for link in model.findall("link") for kind in _PARTS for part in link.findall(kind)
    ]
    return found + [_reference(part) != "" for part in parts]


def _reference(element: Xml.Element) -> str:
    """Return the frame that an element's pose names; empty if none."""
    pose = element.find("pose")
    return "" if pose is None else pose.get("relative_to") or ""


def _axis_frame(axis: Xml.Element, version: str) -> str:
    """Return the frame in which an axis is written; empty for the joint's own."""
    xyz = axis.find("xyz")
    named = "" if xyz is None else xyz.get("expressed_in") or ""
    of_model = (axis.findtext("use_parent_model_frame") or "").strip().lower() in ("1", "true")
    return _MODEL if of_model or _number(version) < (1, 5) else named


def _number(version: str) -> tuple[int, ...]:
    parts = version.split(".")
    return tuple(int(part) for part in parts) if all(p.isdigit() for p in parts) else (1, 9)


class _Frames:
    """The frames of a model by name, and their poses."""

    def __init__(self, model: Xml.Element, version: str) -> None:
        self._source, self._version = model, version
        self._found: Mapping[str, Xml.Element] = {
            name_of(e): e for kind in ("link", "joint", "frame") for e in model.findall(kind)
        }

    def pose(self, name: str, below: tuple[str, ...] = ()) -> Array:
        """Return the pose (4, 4) of a link, joint or frame in the model's frame."""
        if name in ("", _MODEL):
            return np.eye(4)
        element = self._found.get(name)
        if element is None:
            near = did_you_mean(nearest(name, self._found))
            raise PluginError(f"a pose is relative to '{name}', which the model lacks{near}")
        if name in below:
            raise PluginError(f"the pose of '{name}' is relative to itself")
        reference = _reference(element)
        if not reference:
            reference = self._usual(element)
        return self.pose(reference, (*below, name)) @ matrix(pose_of(element))

    def _usual(self, element: Xml.Element) -> str:
        """Return the default frame of an element's pose."""
        if element.tag == "joint":
            return (element.findtext("child") or "").strip()
        return element.get("attached_to", "") if element.tag == "frame" else ""

    def link_of(self, name: str, below: tuple[str, ...] = ()) -> str:
        """Return the link to which a frame is attached; a link is itself."""
        element = self._found.get(name)
        if element is None or element.tag == "link" or name in below:
            return name
        on = element.get("attached_to") or element.findtext("child") or ""
        return self.link_of(on.strip(), (*below, name)) if on else name

    def model(self) -> Xml.Element:
        """Return a copy of the model in which each moving link has its origin at its joint."""
        made = deepcopy(self._source)
        hung = {
            self.link_of((j.findtext("child") or "").strip()): name_of(j)
            for j in self._source.findall("joint")
            if j.get("type") != "fixed"
        }
        places = {}
        for link in made.findall("link"):
            name = name_of(link)
            place = self.pose(name)
            if name in hung:
                place[:3, 3] = self.pose(hung[name])[:3, 3]
            places[name] = place
            self._move(link, place)
        for joint in made.findall("joint"):
            self._straighten(joint, places)
        for frame in made.findall("frame"):
            made.remove(frame)
        return made

    def _move(self, link: Xml.Element, place: Array) -> None:
        """Put a link's frame at a place in the model; its parts stay where they are."""
        name, back = name_of(link), np.linalg.inv(place)
        for part in (p for kind in _PARTS for p in link.findall(kind)):
            at = self.pose(_reference(part) or name) @ matrix(pose_of(part))
            _write(part, back @ at)
        _write(link, place)

    def _straighten(self, joint: Xml.Element, places: Mapping[str, Array]) -> None:
        """Remove a joint's pose, and express its axis in the child's frame."""
        name = name_of(joint)
        own = self.pose(name)
        for end in ("parent", "child"):
            element = joint.find(end)
            if element is not None:
                element.text = self.link_of((element.text or "").strip())
        child = places.get((joint.findtext("child") or "").strip(), np.eye(4))
        axis = joint.find("axis")
        if axis is not None:
            frame = _axis_frame(axis, self._version)
            turn = own if not frame else self.pose(frame)
            xyz = axis.find("xyz")
            text = "0 0 1" if xyz is None else xyz.text or ""
            along = np.array(numbers(text, f"the axis of joint '{name}'"))
            if along.shape == (3,):
                turned = child[:3, :3].T @ turn[:3, :3] @ along
                xyz = Xml.SubElement(axis, "xyz") if xyz is None else xyz
                xyz.attrib.clear()
                xyz.text = " ".join(f"{v + 0.0:.12g}" for v in np.round(turned, 12))
            for old in axis.findall("use_parent_model_frame"):
                axis.remove(old)
        for pose in joint.findall("pose"):
            joint.remove(pose)


def _write(element: Xml.Element, place: Array) -> None:
    pose = element.find("pose")
    if pose is None:
        pose = Xml.Element("pose")
        element.insert(0, pose)
    pose.attrib.clear()
    pose.text = " ".join(f"{v + 0.0:.12g}" for v in np.round(six(place), 12))
