"""Replace a collision mesh of a description by its bounding box, its hull, or convex pieces."""

from __future__ import annotations

from collections.abc import Iterator
from copy import deepcopy
from dataclasses import dataclass, field
from pathlib import Path
from xml.etree import ElementTree as Xml

from crowdbot.core.robots.convex_piece import add_piece
from crowdbot.core.robots.mesh_box import mesh_box
from crowdbot.core.robots.mesh_pieces import MeshShape, mesh_pieces
from crowdbot.core.robots.xml import matrix, name_of, pose_of


@dataclass
class MeshNotes:
    """The collision meshes that were simplified, by the shape that replaced them."""

    boxed: list[str] = field(default_factory=list)
    hulls: list[str] = field(default_factory=list)
    cut: list[str] = field(default_factory=list)
    uncut: list[str] = field(default_factory=list)
    unread: list[str] = field(default_factory=list)
    lost: list[str] = field(default_factory=list)


def simplify_mesh(
    link: Xml.Element, collision: Xml.Element, mesh: Xml.Element, file: Path, shape: MeshShape,
    notes: MeshNotes,
) -> bool:  # fmt: skip
    """Replace a collision mesh, and note it; return False if its file cannot be used.

    Args:
        link, collision, mesh: the elements.
        file: of the mesh.
        shape: what it becomes.
        notes: is added to.
    """
    scale = mesh.get("scale", "1 1 1")
    if shape == "boxes":
        return _box(link, collision, mesh, file, scale, notes)
    pieces = mesh_pieces(file, scale, shape)
    if pieces is None:
        return _box(link, collision, mesh, file, scale, notes)
    name = name_of(link)
    if pieces.why:
        notes.uncut.append(f"{name} ({pieces.why})")
    elif shape == "hulls":
        notes.hulls.append(name)
    else:
        notes.cut.append(f"{name} ({len(pieces.corners)})")
    geometry = collision.find("geometry")
    assert geometry is not None
    geometry.remove(mesh)
    at = list(link).index(collision)
    link.remove(collision)
    base_name = collision.get("name") or f"{name}_mesh{at}"
    for k, corners in enumerate(pieces.corners):
        one = deepcopy(collision)
        one.set("name", f"{base_name}_{k}")
        inner = one.find("geometry")
        assert inner is not None
        add_piece(inner, corners, f"{base_name}_{k}")
        link.insert(at + k, one)
    return True


def _box(
    link: Xml.Element, collision: Xml.Element, mesh: Xml.Element, file: Path, scale: str,
    notes: MeshNotes,
) -> bool:  # fmt: skip
    box = mesh_box(file, scale)
    geometry = collision.find("geometry")
    assert geometry is not None
    if box is None:
        return False
    size, centre = box
    geometry.remove(mesh)
    Xml.SubElement(geometry, "box", size=" ".join(f"{x:.9g}" for x in size))
    _shift(collision, centre)
    notes.boxed.append(name_of(link))
    return True


def _shift(collision: Xml.Element, by: tuple[float, float, float]) -> None:
    """Move a shape within its own frame from the origin to ``by``."""
    pose = pose_of(collision)
    place = matrix(pose) @ (*by, 1.0)
    origin = collision.find("origin")
    if origin is None:
        origin = Xml.SubElement(collision, "origin")
    origin.set("xyz", " ".join(f"{x:.9g}" for x in place[:3].tolist()))
    origin.set("rpy", " ".join(f"{x:.12g}" for x in pose[3:]))


def collision_meshes(robot: Xml.Element) -> Iterator[tuple[Xml.Element, Xml.Element, Xml.Element]]:
    """Yield link, collision and mesh of each collision mesh."""
    for link in robot.findall("link"):
        for collision in link.findall("collision"):
            mesh = collision.find("geometry/mesh")
            if mesh is not None:
                yield link, collision, mesh
