"""Build robots from their URDF."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from crowdbot.plugin import (
    Array,
    Description,
    HolonomicDrive,
    PluginError,
    PublishedWheel,
    RobotModel,
    read_published,
)
from crowdbot.plugins.robots.limits_build import limits_of
from crowdbot.plugins.robots.urdf import HolonomicUrdfSpec, UrdfFields, UrdfSpec


def build(spec: UrdfSpec) -> RobotModel:
    """Return a robot on two driven wheels.

    Raises:
        PluginError: the file is not a URDF, or has no such joint or link.
    """
    wheel = PublishedWheel(radius=spec.drive.radius, effort=spec.drive.effort)
    left, right = spec.drive.sides
    wheels = dict.fromkeys((*left, *right), wheel)
    bare = _read(spec, wheels, "")
    drive = bare.differential_drive(left[0], right[0], base=spec.base)
    height = bare.base_height(drive, base=spec.base)
    described = _read(spec, wheels, _shell(spec, height))
    return _model(spec, described, drive, height, sideways=False)


def build_holonomic(spec: HolonomicUrdfSpec) -> RobotModel:
    """Return a robot that goes in every direction.

    Raises:
        PluginError: the file is not a URDF, has no such joint or link, or the height of its base is
            not known.
    """
    wheels = {name: PublishedWheel(radius=spec.drive.radius) for name in spec.drive.joints}
    bare = _read(spec, wheels, "")
    at = [bare.pose(bare.joint(name).child, spec.base)[:3, 3] for name in spec.drive.joints]
    height = spec.drive.base_height
    if height is None:
        if not at:
            raise PluginError("give drive.joints, the wheels, or drive.base_height")
        height = spec.drive.radius - min(float(place[2]) for place in at)
    apart = 2.0 * max((math.hypot(p[0], p[1]) for p in at), default=spec.half_width)
    drive = HolonomicDrive(
        max_force=spec.drive.max_force,
        max_torque=spec.drive.max_torque,
        wheel_radius=spec.drive.radius,
        track=apart,
    )
    return _model(spec, _read(spec, wheels, _shell(spec, height)), drive, height, sideways=True)


def _read(spec: UrdfFields, wheels: Mapping[str, PublishedWheel], shell: str) -> Description:
    return read_published(
        spec.file.file, wheels=wheels, shell=shell, base=spec.base, meshes=spec.meshes,
        positions=spec.positions,
    )  # fmt: skip


def _model(
    spec: UrdfFields, described: Description, drive: object, base_height: float, *, sideways: bool
) -> RobotModel:
    corners = _corners(spec)
    reach = spec.disc.radius if spec.disc is not None else float(np.max(np.hypot(*corners.T)))
    return RobotModel(
        description=described.text,
        base=spec.base,
        base_height=base_height,
        drive=drive,  # type: ignore[arg-type]
        limits=limits_of(spec, sideways=sideways),
        footprint_radius=reach,
        footprint=None if spec.disc is not None else corners,
        height=spec.height,
        force_height=0.5 * spec.height,
        mass=described.mass,
        notes=described.notes,
    )


def _corners(spec: UrdfFields) -> Array:
    """Return the corners of a box (4, 2), counter-clockwise, m; none of a disc."""
    if spec.box is None:
        return np.zeros((0, 2))
    ahead, aside = 0.5 * spec.box.length, 0.5 * spec.box.width
    signs = np.array([[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]])
    return signs * [ahead, aside] + [spec.box.x, 0.0]


def _shell(spec: UrdfFields, base_height: float) -> str:
    """Return the outline and the casters as ``<collision>`` elements in the base's frame."""
    high = spec.height - spec.clearance
    z = spec.clearance + 0.5 * high - base_height
    if spec.disc is not None:
        x, shape = 0.0, f'<cylinder radius="{spec.disc.radius}" length="{high}"/>'
    else:
        assert spec.box is not None
        x, shape = spec.box.x, f'<box size="{spec.box.length} {spec.box.width} {high}"/>'
    balls = [
        _collision(
            f"{name}_caster", (c.x, c.y, c.radius - base_height), f'<sphere radius="{c.radius}"/>'
        )
        for name, c in spec.casters.items()
    ]
    return "".join([_collision("outline", (x, 0.0, z), shape), *balls])


def _collision(name: str, at: tuple[float, float, float], shape: str) -> str:
    x, y, z = at
    return (
        f'<collision name="{name}"><origin xyz="{x} {y} {z}"/>'
        f"<geometry>{shape}</geometry></collision>"
    )
