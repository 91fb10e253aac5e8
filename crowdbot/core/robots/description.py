"""A robot's description, SDFormat or URDF, as far as checks and models need it.

Nothing here needs Drake.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Literal
from xml.etree import ElementTree as Xml

import numpy as np

from crowdbot.core.robots.joint import Joint, child_of, sdf_joint, urdf_joint
from crowdbot.core.robots.xml import matrix, name_of, number, numbers, pose_of
from crowdbot.core.types.arrays import Array
from crowdbot.core.types.robot import DifferentialDrive
from crowdbot.errors import PluginError, did_you_mean, nearest

Format = Literal["sdf", "urdf"]
ROUND = ("sphere", "cylinder", "ellipsoid")


@dataclass(frozen=True)
class Description:
    """A parsed robot description, SDFormat or URDF.

    Attributes:
        text: the text as read.
        model: the ``robot`` or ``model`` element.
        version: version of SDFormat.
        notes: simplifications made on reading, for the user.
    """

    text: str
    format: Format
    model: Xml.Element
    version: str = "1.9"
    notes: tuple[str, ...] = ()

    @cached_property
    def links(self) -> Mapping[str, Xml.Element]:
        """Return the links by name."""
        return {name_of(link): link for link in self.model.findall("link")}

    @cached_property
    def joints(self) -> Mapping[str, Joint]:
        """Return the joints by name."""
        read = urdf_joint if self.format == "urdf" else sdf_joint
        return {name_of(joint): read(joint) for joint in self.model.findall("joint")}

    @cached_property
    def mass(self) -> float:
        """Mass of all links together, kg."""
        return sum(_mass(link, self.format) for link in self.links.values())

    @cached_property
    def root(self) -> str:
        """Return the only link without a parent.

        Raises:
            PluginError: there is none, or there are several.
        """
        children = {joint.child for joint in self.joints.values()}
        roots = [name for name in self.links if name not in children]
        if len(roots) != 1:
            found = ", ".join(f"'{r}'" for r in roots) or "none"
            raise PluginError(f"a robot hangs from one link, its root; here: {found}")
        return roots[0]

    def link(self, name: str) -> Xml.Element:
        """Return the link with this name.

        Raises:
            PluginError: there is none; the message suggests the closest name.
        """
        if name not in self.links:
            raise PluginError(_unknown("link", name, self.links))
        return self.links[name]

    def joint(self, name: str) -> Joint:
        """Return the joint with this name.

        Raises:
            PluginError: there is none; the message suggests the closest name.
        """
        if name not in self.joints:
            raise PluginError(_unknown("joint", name, self.joints))
        return self.joints[name]

    def pose(self, link: str, seen_from: str) -> Array:
        """Return the pose of a link in the frame of another, with all joints at zero, 4 x 4.

        Raises:
            PluginError: there is no such link, or its pose is relative to something that is not a
                link.
        """
        of = self._from_root if self.format == "urdf" else self._in_model
        pose: Array = np.linalg.inv(of(seen_from, ())) @ of(link, ())
        return pose

    def mass_of(self, link: str) -> float:
        """Return the mass of a link, kg.

        Raises:
            PluginError: there is no such link, or its mass is not a number.
        """
        return _mass(self.link(link), self.format)

    def centre_of_mass(self, seen_from: str) -> Array:
        """Return the centre of mass (3,) in the frame of a link, with all joints at zero, m.

        Raises:
            PluginError: there is no such link, or no mass.
        """
        total = np.zeros(3)
        for name, link in self.links.items():
            inertial = link.find("inertial")
            at = np.eye(4) if inertial is None else matrix(pose_of(inertial))
            total += _mass(link, self.format) * (self.pose(name, seen_from) @ at)[:3, 3]
        if not self.mass > 0.0:
            raise PluginError("the robot has no mass")
        return np.asarray(total / self.mass)

    def wheel_radius(self, joint: str) -> float:
        """Return the radius of the collision shape on a joint, m.

        Raises:
            PluginError: there is no such joint, or no sphere or cylinder on it.
        """
        wheel = self.joint(joint).child
        found = [_radius(shape) for shape in collisions(self.link(wheel)) if shape.tag in ROUND]
        if not found:
            raise PluginError(
                f"wheel '{wheel}' has no collision shape that can roll: a sphere or a cylinder"
            )
        return max(found)

    def differential_drive(
        self, left_joint: str, right_joint: str, *, base: str = "base_link"
    ) -> DifferentialDrive:
        """Return the drive of two wheels, with radius and track from the description.

        Raises:
            PluginError: the joints are missing, have no wheels, or are swapped.
        """
        left, right = (
            self.pose(self.joint(name).child, base)[:3, 3] for name in (left_joint, right_joint)
        )
        if left[1] - right[1] < abs(left[0] - right[0]):
            behind = abs(left[1] - right[1]) < abs(left[0] - right[0])
            raise PluginError(
                f"'{left_joint}' and '{right_joint}' lie along the x axis of '{base}', not beside "
                "it; robots drive along that axis: name as base a link whose x axis points ahead, "
                "or add one with a fixed joint that turns it, rpy='0 0 1.5708' or '0 0 -1.5708'"
                if behind
                else f"'{left_joint}' is on the right of '{base}', '{right_joint}' on its left: "
                "exchange them"
            )
        return DifferentialDrive(
            left_joint=left_joint,
            right_joint=right_joint,
            command_radius=self.wheel_radius(left_joint),
            track=float(left[1] - right[1]),
        )

    def base_height(self, drive: DifferentialDrive, *, base: str = "base_link") -> float:
        """Height of the base link above the floor on which the driven wheels stand, m."""
        wheel = self.joint(drive.left_joint).child
        return drive.command_radius - float(self.pose(wheel, base)[2, 3])

    def _from_root(self, link: str, below: tuple[str, ...]) -> Array:
        """Return the pose (4, 4) of a URDF's link in the frame of its root."""
        self.link(link)
        _check_circle(link, below)
        joint = next((j for j in self.model.findall("joint") if child_of(j) == link), None)
        if joint is None:
            return np.eye(4)
        parent = self.joints[name_of(joint)].parent
        return self._from_root(parent, (*below, link)) @ matrix(pose_of(joint))

    def _in_model(self, link: str, below: tuple[str, ...]) -> Array:
        """Return the pose (4, 4) of an SDFormat model's link in the model's frame."""
        _check_circle(link, below)
        element = self.link(link)
        pose = element.find("pose")
        seen_from = pose.get("relative_to") if pose is not None else None
        own = matrix(pose_of(element))
        if not seen_from or seen_from == "__model__":
            return own
        return self._in_model(seen_from, (*below, link)) @ own


def _unknown(part: str, name: str, known: Mapping[str, object]) -> str:
    hint = did_you_mean(nearest(name, known)) or f"; there are: {', '.join(known) or 'none'}"
    return f"the robot's description has no {part} '{name}'{hint}"


def _check_circle(link: str, below: tuple[str, ...]) -> None:
    if link in below:
        raise PluginError(f"link '{link}' hangs from itself")


def _mass(link: Xml.Element, kind: Format) -> float:
    """Return the mass of a link, kg; a link of a URDF without an inertial weighs nothing."""
    mass = link.find("inertial/mass")
    if mass is None:
        if link.find("inertial") is not None:
            raise PluginError(f"the inertial of '{name_of(link)}' has no mass")
        return 0.0
    text = mass.get("value", "") if kind == "urdf" else mass.text or ""
    return number(text, f"the mass of '{name_of(link)}'")


def collisions(link: Xml.Element) -> Iterator[Xml.Element]:
    """Yield the collision shapes of a link."""
    for collision in link.findall("collision"):
        yield from collision.findall("geometry/*")


def _radius(shape: Xml.Element) -> float:
    if shape.tag == "ellipsoid":
        return max(numbers(shape.findtext("radii") or "", "the radii of an ellipsoid"), default=0.0)
    text = shape.get("radius") or shape.findtext("radius") or ""
    return number(text, f"the radius of a {shape.tag}")
