"""Read and check a robot's description from a file or a text."""

from __future__ import annotations

import re
from collections import Counter
from importlib.resources.abc import Traversable
from pathlib import Path
from xml.etree import ElementTree as Xml

from crowdbot.core.robots.convex_piece import is_piece
from crowdbot.core.robots.description import ROUND, Description, collisions
from crowdbot.core.robots.joint import KNOWN
from crowdbot.core.robots.plain_xacro import is_macro, write_out
from crowdbot.core.robots.sdf_frames import written_out
from crowdbot.core.robots.sdf_inertia import write_out_inertias
from crowdbot.core.robots.sdf_nested import without_nested
from crowdbot.core.robots.sdf_poses import plain_poses
from crowdbot.core.robots.xml import name_of
from crowdbot.core.support.text_files import LARGEST
from crowdbot.dsl.text.bounded_files import read_bytes
from crowdbot.errors import PluginError

#: Shapes that a link collides as; Drake drops others without an error.
_SOLID = ("box", "capsule", "empty", *ROUND)
_EXPAND = (
    "expand them into a file: xacro ROBOT.urdf.xacro > ROBOT.urdf, where ROS is installed, or "
    "after 'pip install xacro'"
)


def read_description(source: str | Path | Traversable) -> Description:
    """Read a robot's description from text or from a file.

    Args:
        source: text that begins with ``<``, or a path: of a file beside the scenario
            (``spec.body.file`` of an ``Asset``) or one of a package
            (``importlib.resources.files("my_package") / "robot.urdf"``).

    Raises:
        PluginError: it cannot be read, is not well-formed, or contains no robot.
    """
    text, _ = read_text(source)
    try:
        return _checked(parse_description(text))
    except PluginError as error:
        if text is source:
            raise
        raise PluginError(f"{source}: {error}") from error


def read_text(source: str | Path | Traversable) -> tuple[str, Path | None]:
    """Return the text of a description and its folder; arguments as in `read_description`.

    Raises:
        PluginError: it cannot be read.
    """
    if isinstance(source, str) and source.lstrip("\ufeff \t\r\n").startswith("<"):
        return source, None
    if isinstance(source, str) and not source.strip("\ufeff \t\r\n"):
        raise PluginError("the robot's description is empty")
    file = Path(source) if isinstance(source, str) else source
    try:
        is_path = isinstance(file, Path)
        content = read_bytes(Path(str(file)), LARGEST) if is_path else file.read_bytes()
        text = content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise PluginError(
            f"robot description {file} cannot be read: is not UTF-8 text; save it as UTF-8, and "
            "remove another encoding from its first line"
        ) from error
    except OSError as error:
        raise PluginError(f"robot description {file} cannot be read: {error}") from error
    return text, file.parent if isinstance(file, Path) else None


def parse_description(text: str) -> Description:
    """Parse a description without checking its contents.

    Raises:
        PluginError: it is not well-formed, or contains no robot.
    """
    try:
        top = Xml.fromstring(text.lstrip("\ufeff \t\r\n"))
    except Xml.ParseError as error:
        hint = f"; its xacro macros: {_EXPAND}" if "xacro:" in text else ""
        raise PluginError(
            f"the robot's description is not well-formed XML: {error}{hint}"
        ) from error
    notes: tuple[str, ...] = ()
    if any(is_macro(element) for element in top.iter()):
        names = write_out(top)
        if not names:
            raise PluginError(f"the robot's description has xacro macros; {_EXPAND}")
        text = Xml.tostring(top, encoding="unicode")
        notes = (f"{len(names)} of xacro's properties written out: {', '.join(names)}",)
    if top.tag == "robot":
        return Description(text, "urdf", top, notes=notes)
    model = top if top.tag == "model" else _only_model(top)
    if top.tag not in ("sdf", "model") or model is None:
        raise PluginError(
            f"the robot's description is neither URDF (<robot>) nor SDFormat (<sdf><model>): "
            f"<{top.tag}>"
        )
    version = top.get("version", "1.9")
    plain_poses(model)
    flat, nested = without_nested(model)
    made, written = written_out(flat, version)
    all_notes = (*notes, *nested, *written, *write_out_inertias(made))
    return Description(text, "sdf", made, version if made is model else "1.9", all_notes)


def _only_model(top: Xml.Element) -> Xml.Element | None:
    """Return the model of a file of SDFormat, also of a world with nothing else.

    Raises:
        PluginError: a world has several models, or only includes of other files.
    """
    found = top.findall("model") or top.findall("world/model")
    if len(found) > 1:
        names = ", ".join(f"'{name_of(model)}'" for model in found)
        raise PluginError(f"the file has {len(found)} models, not one robot: {names}")
    if not found and (uri := top.findtext("world/include/uri")) is not None:
        raise PluginError(f"the world includes its model, '{uri.strip()}'; name that model's file")
    return found[0] if found else None


def _checked(described: Description) -> Description:
    if not described.links:
        raise PluginError("the robot's description has no link")
    if not name_of(described.model):
        tag = described.model.tag
        raise PluginError(f'the robot\'s description has no name: write <{tag} name="…">')
    for part in ("link", "joint"):
        names = Counter(name_of(element) for element in described.model.findall(part))
        if twice := [name for name, count in names.items() if count > 1]:
            raise PluginError(f"the robot's description has two {part}s named '{twice[0]}'")
    for joint in described.joints.values():
        if joint.kind not in KNOWN:
            raise PluginError(
                f"joint '{joint.name}' is {joint.kind}; the joints of a mobile base are "
                f"{', '.join(KNOWN)}"
            )
        described.link(joint.parent)
        described.link(joint.child)
    _check_limits(described)
    for name, link in described.links.items():
        if len(link.findall("inertial")) > 1:
            raise PluginError(f"link '{name}' has several <inertial>; add them up to one")
        for shape in collisions(link):
            kind = re.split("[:}]", shape.tag)[-1]  # without the prefix of Drake's own shapes
            if kind in _SOLID or is_piece(shape):
                continue
            way = ", or read the file with read_published" if kind == "mesh" else ""
            raise PluginError(
                f"link '{name}' collides as a {kind}; use box, cylinder, sphere or capsule{way}"
            )
    return described


def _check_limits(described: Description) -> None:
    for element in described.model.findall("joint"):
        limit = element.find("limit")
        if limit is not None and limit.get("velocity", "").strip().startswith("-"):
            raise PluginError(
                f"joint '{name_of(element)}' has the velocity limit {limit.get('velocity')}; "
                "leave it out if there is none"
            )
