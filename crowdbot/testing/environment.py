"""Checks for every environment."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from crowdbot.core.registry.registry import Registry
from crowdbot.core.types.arrays import Array
from crowdbot.core.types.environment import EnvironmentParts
from crowdbot.dsl.spec.component import Component
from crowdbot.testing.around import around, built, each_built, specs_of, with_zone
from crowdbot.testing.free_floor import FreeFloorGrid, seen_sides, viewpoints


def check_parts(component: Component[Any], registry: Registry | None = None) -> None:
    """Walls, pillars, solids and heights are finite arrays of the declared shapes.

    If this fails, look at `EnvironmentParts`: one row of heights per wall, bottom below top.
    """
    for parts in _parts(component, registry):
        assert isinstance(parts, EnvironmentParts), f"build returned a {type(parts).__name__}"
        _assert_table("walls", parts.walls, (-1, 4))
        count, pillars, solids = len(parts.walls), len(parts.pillars), len(parts.solids)
        _assert_heights("wall_heights", parts.wall_heights, count)
        for name in ("stops_robot", "stops_crowd"):
            flags = getattr(parts, name)
            assert isinstance(flags, np.ndarray), f"{name} is a {type(flags).__name__}, no array"
            assert flags.dtype == np.bool_, f"{name} is {flags.dtype}"
            assert flags.shape == (count,), f"{name} has shape {flags.shape} for {count} walls"
        lengths = np.hypot(*(parts.walls[:, 2:] - parts.walls[:, :2]).T)
        assert np.all(lengths > 0.0), "a wall has no length"
        _assert_table("pillars", parts.pillars, (-1, 3))
        _assert_heights("pillar_heights", parts.pillar_heights, pillars)
        assert np.all(parts.pillars[:, 2] > 0.0), "a pillar has no radius"
        _assert_heights("solid_heights", parts.solid_heights, solids)
        for outline in parts.solids:
            _assert_outline("a solid", outline)


def check_zones_and_portals(component: Component[Any], registry: Registry | None = None) -> None:
    """Zones are counter-clockwise polygons and portals boxes; all that the spec names exist.

    If this fails, return ``spec.zones`` (``zone.polygon``) and ``spec.portals`` (x, then y).
    """
    known = around(component, registry)
    examples = specs_of(component, known)
    zoned = [with_zone(known, s, viewpoints(built(known, s))[0]) for s in examples]
    for spec in (*examples, *zoned):
        parts: EnvironmentParts = built(known, spec)
        lacking = sorted(set(getattr(spec, "zones", {})) - set(parts.zones))
        assert not lacking, f"the spec has a zone '{lacking[0]}', the parts have not"
        assert set(parts.portals) >= set(getattr(spec, "portals", {})), "a portal is missing"
        for name, zone in parts.zones.items():
            _assert_outline(f"zone '{name}'", zone)
        for name, (x0, x1, y0, y1) in parts.portals.items():
            assert x0 < x1, f"portal '{name}' is not (x0, x1, y0, y1)"
            assert y0 < y1, f"portal '{name}' is not (x0, x1, y0, y1)"


def check_zones_are_on_the_floor(
    component: Component[Any], registry: Registry | None = None
) -> None:
    """The centre of every zone is free: within the walls, outside pillars and solids.

    If this fails, a zone lies outside the place, or an obstacle stands in its middle.
    """
    for parts in _parts(component, registry):
        grid = FreeFloorGrid(parts)
        for name, zone in parts.zones.items():
            centre = zone.mean(axis=0)
            assert grid.is_free(centre), f"zone '{name}' has something in its centre {centre}"
            assert grid.holds(centre), f"zone '{name}' lies outside of the walls"


def check_free_side_is_on_the_left(
    component: Component[Any], registry: Registry | None = None
) -> None:
    """From a zone, or the middle of the floor, only the left side of every wall is visible.

    If this fails, swap the ends of the named wall: sensors ignore the side, but robot and people
    are kept on its left.
    """
    for parts in _parts(component, registry):
        for x, y in viewpoints(parts):
            wrong = [s for s, left in seen_sides(parts, x, y).items() if not left]
            assert not wrong, (
                f"from ({x:g}, {y:g}) the right side of wall {parts.walls[wrong[0]]} is seen"
            )


def check_is_closed(component: Component[Any], registry: Registry | None = None) -> None:
    """A robot cannot leave between walls, unless there are none or the boundary is periodic.

    If this fails, there is a gap of more than 0.2 m, or ``stops_robot`` is wrong. A place that is
    open by design declares ``Component(exceptions={"check_is_closed": "why"})``.
    """
    for parts in _parts(component, registry):
        if parts.periodic_boundary is not None or not len(parts.walls):
            continue
        if not np.any(parts.stops_robot):
            assert parts.solids, "no wall stops a robot"
            continue
        grid = FreeFloorGrid(parts)
        for x, y in viewpoints(parts):
            out = grid.way_out(x, y)
            assert out is None, f"from ({x:g}, {y:g}) a robot gets out at {out}"


def check_same_spec_same_place(component: Component[Any], registry: Registry | None = None) -> None:
    """Building the same spec twice gives the same place.

    If this fails, something is random: put the numbers, or a seed, into the spec.
    """
    pairs = zip(_parts(component, registry), _parts(component, registry), strict=True)
    for one, two in pairs:
        for name in ("walls", "wall_heights", "stops_robot", "stops_crowd", "pillars"):
            assert np.array_equal(getattr(one, name), getattr(two, name)), f"other {name}"


def check_runs(component: Component[Any], registry: Registry | None = None) -> None:
    """A robot drives in it for a second, reproducibly and without simulator warnings.

    If this fails, the simulator's message names the problem with the geometry.
    """
    from crowdbot.testing.tiny import assert_runs, scenario_in

    known = around(component, registry)
    for spec in specs_of(component, known):
        parts: EnvironmentParts = built(known, spec)
        x, y = viewpoints(parts)[0]
        assert_runs(scenario_in(known, spec, (x, y)), known)


def _parts(component: Component[Any], registry: Registry | None) -> Iterator[EnvironmentParts]:
    return each_built(component, registry)


def _assert_table(name: str, table: Array, shape: tuple[int, int]) -> None:
    assert isinstance(table, np.ndarray), f"{name} is a {type(table).__name__}, no array"
    assert table.dtype == np.float64, f"{name} is {table.dtype}"
    assert table.ndim == 2, f"{name} has shape {table.shape}"
    assert table.shape[1] == shape[1], f"{name} has shape {table.shape}"
    assert np.all(np.isfinite(table)), f"{name} is not finite"


def _assert_heights(name: str, table: Array, count: int) -> None:
    _assert_table(name, table, (count, 2))
    assert len(table) == count, f"{len(table)} {name} for {count}"
    assert np.all(table[:, 0] < table[:, 1]), f"{name}: the bottom must be below the top"


def _assert_outline(name: str, corners: Array) -> None:
    _assert_table(name, corners, (-1, 2))
    assert len(corners) >= 3, f"{name} has {len(corners)} corners"
    x, y = corners.T
    area = 0.5 * float(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)))
    assert area > 0.0, f"the corners of {name} are not counter-clockwise"
