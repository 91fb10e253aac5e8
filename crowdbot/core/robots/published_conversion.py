"""Steps that turn a published description into a drivable model."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import NamedTuple
from xml.etree import ElementTree as Xml

import numpy as np

import crowdbot.core.robots.published_drive as drives
from crowdbot.core.robots.description import Description
from crowdbot.core.robots.inertia import check_inertia, rolling
from crowdbot.core.robots.joint import child_of, hold_still, parent_of
from crowdbot.core.robots.mesh_pieces import MeshShape
from crowdbot.core.robots.mesh_shapes import MeshNotes, collision_meshes, simplify_mesh
from crowdbot.core.robots.sdf_to_urdf import UNLIMITED
from crowdbot.core.robots.xml import name_of
from crowdbot.core.types.arrays import Array
from crowdbot.errors import PluginError, did_you_mean, nearest

ANCHOR = "joint to the world is left out, the robot drives"
_HELD = ("revolute", "prismatic", "floating", "planar")
#: Number of names that are listed; beyond it, only their number is given.
_NAMED = 4


class PublishedWheel(NamedTuple):
    """Facts about a wheel that a published description lacks, or gives only by its mesh.

    Attributes:
        radius: m.
        effort: torque of the motor of a driven wheel, N m. None: the wheel slides, like omni wheels
            of a holonomic drive.
    """

    radius: float
    effort: float | None = None


class Conversion:
    """A description being converted, and its notes so far."""

    def __init__(
        self, robot: Xml.Element, base: str, wheels: dict[str, PublishedWheel],
        positions: dict[str, float],
    ) -> None:  # fmt: skip
        self.robot, self.base, self.wheels, self.positions = robot, base, wheels, positions
        self.notes: list[str] = []
        for limit in robot.iterfind("joint/limit"):  # negative ones stand for none
            for name in ("effort", "velocity"):
                if limit.get(name, "").strip().startswith("-"):
                    del limit.attrib[name]

    @property
    def links(self) -> dict[str, Xml.Element]:
        """Return the links by name."""
        return {name_of(link): link for link in self.robot.findall("link")}

    @property
    def joints(self) -> dict[str, Xml.Element]:
        """Return the joints by name."""
        return {name_of(joint): joint for joint in self.robot.findall("joint")}

    def note(self, names: Sequence[str], one: str, several: str) -> None:
        """Add a note about some things, if any; ``{}`` is replaced by their number."""
        if names:
            listed = ", ".join(names[:_NAMED])
            more = f" and {len(names) - _NAMED} more" if len(names) > _NAMED else ""
            subject = one if len(names) == 1 else several.format(len(names))
            self.notes.append(f"{subject}: {listed}{more}")

    def check(self) -> None:
        """Check that everything named exists."""
        named = [("link", self.base, self.links)]
        named += [("joint", joint, self.joints) for joint in self.wheels]
        if both := sorted(set(self.wheels) & set(self.positions)):
            raise PluginError(f"positions: joint '{both[0]}' is a wheel")
        for part, name, known in named:
            if name not in known:
                hint = did_you_mean(nearest(name, known)) or f"; there are: {', '.join(known)}"
                raise PluginError(f"the robot's description has no {part} '{name}'{hint}")

    def leave_the_world(self) -> None:
        """Remove a link 'world' and its joints, by which other programs hold or place the robot."""
        world = self.links.get("world")
        if world is None or self.base == "world":
            return
        self.robot.remove(world)
        for name, joint in self.joints.items():
            if parent_of(joint) == "world":
                self.robot.remove(joint)
                self.note([name], ANCHOR, "")
        self.keep_one_tree()

    def keep_one_tree(self) -> None:
        """Remove links that are not connected to the base."""
        hangs = {self.base}
        pairs = [(parent_of(j), child_of(j)) for j in self.joints.values()]
        while grown := {x for pair in pairs if hangs & set(pair) for x in pair} - hangs:
            hangs |= grown
        loose = [name for name in self.links if name not in hangs]
        for name in loose:
            self.robot.remove(self.links[name])
        for joint in self.robot.findall("joint"):
            if child_of(joint) in loose:
                self.robot.remove(joint)
        self.note(loose, "link that does not hang together with the base is left out",
                  "{} links that do not hang together with the base are left out")  # fmt: skip

    def centre_wheels(self) -> None:
        """Move the frames of driven wheels to the wheels' centres, which define the track."""
        for name, wheel in self.wheels.items():
            if wheel.effort is not None:
                note = drives.centre_wheel(self.robot, self.base, self.joints[name])
                self.notes += [note] if note else []

    def compare_plugins(self, model: Xml.Element) -> None:
        """Note where Gazebo's plugins give other values for the two driven wheels."""
        driven = [n for n, wheel in self.wheels.items() if wheel.effort is not None]
        if len(driven) == 2:
            at = drives.places_of(self.robot, self.base, driven)
            track = abs(float(at[driven[0]][1] - at[driven[1]][1]))
            radius = self.wheels[driven[0]].radius
            self.notes += drives.other_in_plugins(model, track, radius)

    def drive_with_two(self) -> None:
        """Replace the driven wheels of each side by one, and move the base onto their axle."""
        driven = [name for name, wheel in self.wheels.items() if wheel.effort is not None]
        if not driven:
            return
        places = drives.places_of(self.robot, self.base, driven)
        both = drives.sides(places)
        if len(driven) > 2 and all(both):
            for side in both:
                self._stand_for(side, places)
            first = [side[0] for side in both]
            self.notes.append(
                f"{len(driven)} driven wheels (skid steer) are approximated by two in their middle "
                f"that roll without slip, {first[0]} and {first[1]}, with the torque of all; the "
                "others slide. Real ones slip when the robot turns, and turn it less than commanded"
            )
            driven = first
        note = drives.onto_axle(self.robot, self.base, driven)
        self.notes += [note] if note else []

    def _stand_for(self, side: Sequence[str], places: Mapping[str, Array]) -> None:
        first, *others = side
        wheel = self.wheels[first]
        effort = sum(self.wheels[name].effort or 0.0 for name in side)
        self.wheels |= {name: self.wheels[name]._replace(effort=None) for name in others}
        self.wheels[first] = wheel._replace(effort=effort)
        support = f"{first}_support"
        drives.add_support(self.robot, self.base, support, places[first], wheel.radius)
        middle = np.mean([places[name] for name in side], axis=0)
        drives.put(self.robot, self.base, first, middle)

    def hold_joints(self) -> None:
        """Fix all joints except those of driven wheels and casters."""
        held, mimics, sliding = list[str](), list[str](), list[str]()
        for name, joint in self.joints.items():
            wheel, kind = self.wheels.get(name), joint.get("type", "")
            mimic = joint.find("mimic")
            if mimic is not None and wheel is not None and wheel.effort is not None:
                joint.remove(mimic)
                self.notes.append(f"driven wheel has a motor of its own, and mimics none: {name}")
                continue
            if mimic is not None and {name, mimic.get("joint")}.isdisjoint(self.positions):
                mimics.append(name)
            elif wheel is not None and wheel.effort is None:
                sliding.append(name)
            elif name in self.positions or mimic is not None:
                pass  # held where it is said
            elif kind in _HELD and wheel is None:
                held.append(name)
            else:
                continue
            hold_still(joint)
        for name, wheel in self.wheels.items():
            if wheel.effort is not None:
                self._drive(name, wheel.effort)
        self.note(held, "joint is held at zero", "{} joints are held at zero")
        self.note(mimics, "joint that mimics another is held at zero",
                  "{} joints that mimic others are held at zero")  # fmt: skip
        self.note(sliding, "wheel does not turn, it slides", "{} wheels do not turn, they slide")

    def _drive(self, name: str, effort: float) -> None:
        joint = self.joints[name]
        limit = joint.find("limit")
        note = drives.point_left(self.robot, self.base, joint)
        self.notes += [note] if note else []
        joint.set("type", "continuous")
        was = "" if limit is None else limit.get("effort", f"{effort:g}")
        if limit is None:
            limit = Xml.SubElement(joint, "limit", velocity="1e9")
        if was in ("", f"{UNLIMITED:g}"):
            self.notes.append(f"wheel without a limit gets a torque of {effort:g} N m: {name}")
        elif was != f"{effort:g}":
            self.notes.append(f"torque is {effort:g} N m, not {was} N m: {name}")
        for end in ("lower", "upper"):
            limit.attrib.pop(end, None)
        limit.set("effort", f"{effort:.12g}")

    def replace_meshes(self, find: Callable[[str], Path | None], shape: MeshShape) -> None:
        """Replace collision meshes by convex shapes, or remove them."""
        done = MeshNotes()
        turned = {child_of(self.joints[name]) for name in self.wheels}
        for link, collision, mesh in collision_meshes(self.robot):
            if shape != "boxes" and name_of(link) in turned:
                link.remove(collision)  # a wheel gets a sphere
                continue
            file = find(mesh.get("filename", ""))
            if file is None or not simplify_mesh(link, collision, mesh, file, shape, done):
                link.remove(collision)
                (done.lost if file is None else done.unread).append(mesh.get("filename", ""))
        self.note(done.boxed, "collision mesh becomes the box around it",
                  "{} collision meshes become the boxes around them")  # fmt: skip
        self.note(done.hulls, "collision mesh becomes its convex hull",
                  "{} collision meshes become their convex hulls")  # fmt: skip
        self.note(done.cut, "collision mesh becomes convex pieces",
                  "{} collision meshes become convex pieces")  # fmt: skip
        self.note(done.uncut, "collision mesh becomes its convex hull instead of pieces",
                  "{} collision meshes become their convex hulls instead of pieces")  # fmt: skip
        self.note(done.unread, "collision mesh is empty or neither STL nor OBJ, and left out",
                  "{} collision meshes are empty or neither STL nor OBJ, and left out")  # fmt: skip
        self.note(done.lost, "collision mesh is not there and left out",
                  "{} collision meshes are not there and left out")  # fmt: skip

    def shape_wheels(self) -> None:
        """Give each wheel a sphere of its radius for contact with the floor."""
        for name, wheel in self.wheels.items():
            link = self.links[child_of(self.joints[name])]
            note = drives.other_radius(link, wheel.radius, name)
            self.notes += [note] if note else []
            for collision in link.findall("collision"):
                link.remove(collision)
            shape = Xml.SubElement(link, "collision", name=f"{name}_floor")
            Xml.SubElement(Xml.SubElement(shape, "geometry"), "sphere", radius=f"{wheel.radius:g}")
        self.note(list(self.wheels), "wheel touches the floor as a sphere",
                  "{} wheels touch the floor as spheres")  # fmt: skip

    def weigh(self) -> None:
        """Replace impossible inertias."""
        impossible, implausible = list[str](), list[str]()
        several = list[str]()
        for name, link in self.links.items():
            for more in link.findall("inertial")[1:]:
                link.remove(more)
                several.append(name)
        self.note(several, "link has a further <inertial>, which is left out",
                  "{} further <inertial> of links are left out")  # fmt: skip
        turned = {child_of(self.joints[n]): w for n, w in self.wheels.items()}
        for name, link in self.links.items():
            inertial = link.find("inertial")
            if inertial is None:
                continue
            wheel = turned.get(name)
            wrong = check_inertia(inertial, None if wheel is None else wheel.radius)
            if wrong == "impossible" or (wrong and wheel is not None):
                rolling(inertial, 0.1 if wheel is None else wheel.radius)
            if wrong:
                (impossible if wrong == "impossible" else implausible).append(name)
        weightless = [
            n for n, link in self.links.items()
            if link.find("inertial") is None and link.find("collision") is not None
        ]  # fmt: skip
        self.note(impossible, "inertia is zero or of no body and replaced by that of a disc",
                  "{} inertias are zero or of no body and replaced by those of discs")  # fmt: skip
        self.note(implausible, "inertia is larger than a body of its size and mass has",
                  "{} inertias are larger than bodies of their size and mass have")  # fmt: skip
        self.note(weightless, "link has a shape and no mass", "{} links have shapes and no mass")
        if not Description("", "urdf", self.robot).mass > 0.0:
            raise PluginError(
                "no link of the robot's description has a mass: write <inertial> with <mass> and "
                f"<inertia>, at least in '{self.base}'"
            )

    def drop_the_rest(self) -> None:
        """Remove parts for other programs: transmissions, Gazebo's elements, visual meshes."""
        for tag, one in (("transmission", "transmission"), ("gazebo", "<gazebo> element")):
            found = self.robot.findall(tag)
            for element in found:
                self.robot.remove(element)
            if found:
                many = "" if len(found) == 1 else "s"
                self.notes.append(f"{len(found)} {one}{many} left out")
        seen = 0
        for link in self.links.values():
            for visual in link.findall("visual"):
                if visual.find("geometry/mesh") is not None:
                    link.remove(visual)
                    seen += 1
        if seen:
            self.notes.append(f"{seen} mesh{'' if seen == 1 else 'es'} for looks left out")
