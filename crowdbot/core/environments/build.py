"""Build environments from plugins; their geometry is checked before use."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from crowdbot.core.registry.registry import Registry
from crowdbot.core.types.arrays import Array
from crowdbot.core.types.environment import EnvironmentParts
from crowdbot.dsl.spec.component_specs import EnvironmentSpec
from crowdbot.errors import PluginError


def build_environment(registry: Registry, spec: EnvironmentSpec) -> EnvironmentParts:
    """Return the place that a spec describes.

    Raises:
        PluginError: it cannot be built, or its tables do not fit each other.
    """
    parts = registry.build(spec, checked_parts)
    if spec.floor.friction == 1.0 and spec.light is None:
        return parts
    return replace(parts, floor_friction=spec.floor.friction, light=spec.light)


def checked_parts(parts: object) -> EnvironmentParts:
    """Return the parts of an environment after checking that their tables are consistent.

    Raises:
        PluginError: they are not.
    """
    if not isinstance(parts, EnvironmentParts):
        raise PluginError(f"build returned a {type(parts).__name__}, not EnvironmentParts")
    walls, pillars, solids = len(parts.walls), len(parts.pillars), len(parts.solids)
    _table("walls", parts.walls, (walls, 4))
    _heights("wall_heights", parts.wall_heights, walls)
    _flags("stops_robot", parts.stops_robot, walls)
    _flags("stops_crowd", parts.stops_crowd, walls)
    _table("pillars", parts.pillars, (pillars, 3))
    _heights("pillar_heights", parts.pillar_heights, pillars)
    if pillars and not np.all(parts.pillars[:, 2] > 0.0):
        raise PluginError("pillars: every radius must be above 0")
    _heights("solid_heights", parts.solid_heights, solids)
    _flags("solids_stop_crowd", parts.solids_stop_crowd, solids)
    for i, outline in enumerate(parts.solids):
        _polygon(f"solids[{i}]", outline)
    for name, zone in _mapping("zones", parts.zones).items():
        _polygon(f"zone '{name}'", zone)
    for name, portal in _mapping("portals", parts.portals).items():
        _box(f"portal '{name}'", portal)
    if parts.periodic_boundary is not None:
        _box("periodic_boundary", parts.periodic_boundary)
    return parts


def _table(name: str, table: object, shape: tuple[int, ...]) -> None:
    fits = isinstance(table, np.ndarray) and table.dtype == np.float64 and table.shape == shape
    if not fits:
        raise PluginError(f"{name} must be a float64 array {shape}, not {_description(table)}")
    if not np.all(np.isfinite(np.asarray(table))):
        raise PluginError(f"{name} must be finite")


def _description(table: object) -> str:
    if isinstance(table, np.ndarray):
        return f"{table.dtype} {table.shape}"
    return type(table).__name__


def _heights(name: str, table: Array, rows: int) -> None:
    _table(name, table, (rows, 2))
    if not np.all(table[:, 0] < table[:, 1]):
        raise PluginError(f"{name}: every bottom must be below its top")


def _flags(name: str, table: object, rows: int) -> None:
    fits = isinstance(table, np.ndarray) and table.dtype == np.bool_ and table.shape == (rows,)
    if not fits:
        raise PluginError(f"{name} must be a bool array ({rows},), not {_description(table)}")


def _mapping(name: str, table: object) -> Mapping[str, Any]:
    if not isinstance(table, Mapping):
        raise PluginError(f"{name} must be a mapping, not {type(table).__name__}")
    return table


def _polygon(name: str, corners: Array) -> None:
    _table(name, corners, (max(3, len(corners)), 2))
    x, y = corners.T
    if not np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y) > 0.0:
        raise PluginError(f"{name}: its corners must run counter-clockwise")


def _box(name: str, box: object) -> None:
    found = np.asarray(box, np.float64)
    if found.shape != (4,) or not np.all(np.isfinite(found)):
        raise PluginError(f"{name} must be x0, x1, y0, y1, not {box!r}")
    if not (found[0] < found[1] and found[2] < found[3]):
        raise PluginError(f"{name}: {box!r} must go from smaller to larger numbers")
