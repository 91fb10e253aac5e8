"""Convert published robot URDFs, made for viewers and arm planners, to drivable models.

Such files have missing meshes, mimic joints, floating joints and frames without mass.
`read_published` converts them to a description that a mobile base can be simulated with, and keeps
a note of each simplification.
"""

from __future__ import annotations

from collections.abc import Mapping
from copy import deepcopy
from dataclasses import replace
from importlib.resources.abc import Traversable
from pathlib import Path
from xml.etree import ElementTree as Xml

from crowdbot.core.robots.description import Description
from crowdbot.core.robots.description_file import parse_description, read_description, read_text
from crowdbot.core.robots.held_joints import hold_at
from crowdbot.core.robots.mesh_pieces import MeshShape
from crowdbot.core.robots.published_conversion import ANCHOR, Conversion, PublishedWheel
from crowdbot.core.robots.sdf_to_urdf import from_sdf
from crowdbot.core.robots.xml import name_of
from crowdbot.errors import InputError, PluginError


def read_published(
    source: str | Path | Traversable,
    *,
    wheels: Mapping[str, PublishedWheel],
    shell: str,
    base: str = "base_link",
    packages: Mapping[str, Path] | None = None,
    meshes: MeshShape = "boxes",
    positions: Mapping[str, float] | None = None,
) -> Description:
    """Convert a file that was not written for simulated contacts to a robot's description.

    The base's frame moves onto the axle of the driven wheels. With more than two driven wheels, the
    first of each side replaces all of its side, at their centre.

    Args:
        source: as in `read_description`.
        wheels: wheels by the name of their joint.
        shell: ``<collision>`` elements for contact with walls, in the base's frame.
        base: the link that sensors are mounted on.
        packages: folders for ``package://NAME/…``. Packages that are not among them are looked for
            where the description lies: a folder above it of that name, or one beside such a folder.
            A collision mesh found so (STL or OBJ), or beside the description, is simplified; others
            are left out.
        meshes: what collision meshes become: bounding ``boxes``, convex ``hulls``, or convex
            ``pieces``, which needs the extra ``meshes`` and is hulls without it.
        positions: where joints that are not wheels are held, rad or m; others are held at zero.

    Returns:
        the description; its `Description.notes` list the simplifications.

    Raises:
        PluginError: it cannot be read, has no such joint or link, or ``shell`` is not well-formed.
    """
    text, folder = read_text(source)
    described = parse_description(text)
    anchors = _loosen(described.model) if described.format == "sdf" else []
    try:
        robot = from_sdf(described, {}) if described.format == "sdf" else described.model
    except InputError as error:
        raise PluginError(str(error)) from error
    work = Conversion(deepcopy(robot), base, dict(wheels), dict(positions or {}))
    work.robot.set("name", name_of(robot) or "robot")
    work.notes += described.notes
    work.note(anchors, ANCHOR, "")
    work.check()
    work.keep_one_tree()
    work.leave_the_world()
    hold_at(work.robot, work.positions)
    work.centre_wheels()
    work.compare_plugins(described.model)
    work.drive_with_two()
    work.hold_joints()
    work.replace_meshes(lambda name: _find(name, folder, packages or {}), meshes)
    work.shape_wheels()
    work.weigh()
    work.drop_the_rest()
    _add_shell(work, shell)
    made = read_description(Xml.tostring(work.robot, encoding="unicode"))
    return replace(made, notes=tuple(work.notes))


def _loosen(model: Xml.Element) -> list[str]:
    """Remove the joints of an SDFormat model to the world; return their names."""
    anchors = [j for j in model.findall("joint") if j.findtext("parent", "").strip() == "world"]
    for joint in anchors:
        model.remove(joint)
    return [name_of(joint) for joint in anchors]


def _find(name: str, folder: Path | None, packages: Mapping[str, Path]) -> Path | None:
    """Return the file of a mesh, if it exists."""
    if name.startswith("package://"):
        package, _, rest = name.removeprefix("package://").partition("/")
        found = [packages[package]] if package in packages else _above(package, folder)
        files = [place / rest for place in found if ".." not in Path(rest).parts]
    else:
        plain = Path(name.removeprefix("file://"))
        files = [plain] if plain.is_absolute() else [] if folder is None else [folder / plain]
    return next((file for file in files if file.is_file()), None)


def _above(package: str, folder: Path | None) -> list[Path]:
    """Return the folders that may be a package of this name, nearest first.

    A description lies within its package, and packages lie side by side.
    """
    if folder is None or package in ("", ".", ".."):
        return []
    above = [folder.resolve(), *folder.resolve().parents]
    return [place for up in above for place in ([up] if up.name == package else [up / package])]


def _add_shell(work: Conversion, shell: str) -> None:
    """Add the base's shapes for contact with walls."""
    try:
        shapes = list(Xml.fromstring(f"<shell>{shell}</shell>"))
    except Xml.ParseError as error:
        raise PluginError(f"shell is not well-formed XML: {error}") from error
    if any(shape.tag != "collision" for shape in shapes):
        raise PluginError("shell holds <collision> elements, and nothing else")
    work.links[work.base].extend(shapes)
