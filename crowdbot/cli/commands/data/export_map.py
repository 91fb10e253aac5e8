"""``crowdbot export-map``: export the place of a scenario as a nav2 map and as GeoJSON."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from crowdbot.cli.output.say import say, say_json
from crowdbot.cli.shared.option import option, switch
from crowdbot.cli.shared.options import NoPlugins, Plugins, ScenarioSet, installed
from crowdbot.cli.shared.run_arguments import ScenarioArgument, SpecArgument
from crowdbot.errors import UsageError

if TYPE_CHECKING:
    from crowdbot.dsl.scenario.scenario import Scenario

#: Default clearance height without a robot: people walk under higher obstacles, m.
_HEAD = 1.7


def export_map(
    spec: SpecArgument,
    scenario: ScenarioArgument = None,
    out: Annotated[Path | None, option("DIR", "Folder to write; default: ID.map, here.")] = None,
    resolution: Annotated[float, option("METRES", "Side of a cell of the grid.")] = 0.05,
    overrides: ScenarioSet = None,
    plugin: Plugins = None,
    no_plugins: NoPlugins = False,
    as_json: Annotated[bool, switch("--json", "Paths and size as JSON.")] = False,
) -> None:
    """Write map.yaml with map.pgm for nav2, and map.geojson, of the place of a scenario.

    Example: crowdbot export-map challenge-2020 in-d0125-slow-c20-r05 --out maps/corridor
    """
    from crowdbot.core.environments.build import build_environment
    from crowdbot.core.environments.grid_map import grid_map
    from crowdbot.core.environments.outline_map import floor_points, outline_map, to_geojson
    from crowdbot.core.scenarios.library import open_spec, pick
    from crowdbot.core.support.atomic_write import atomic_write

    if not 1e-3 <= resolution <= 10.0:
        raise UsageError(f"--resolution {resolution:g}: a cell is 0.001 m to 10 m wide")
    registry = installed(plugin, no_plugins)
    chosen = pick(open_spec(spec, registry, overrides or []), scenario)
    parts = build_environment(registry, chosen.environment)
    inside = _inside(chosen)
    found = outline_map(parts, inside)
    grid = grid_map(
        found,
        parts.walls[parts.stops_robot],
        inside or floor_points(found),
        resolution,
        _height(chosen, registry),
    )
    folder = out or Path(f"{chosen.id.replace('/', '_')}.map")
    files = {
        "map.pgm": grid.to_pgm(),
        "map.yaml": grid.to_yaml("map.pgm").encode(),
        "map.geojson": to_geojson(found, parts.zones, parts.portals).encode(),
    }
    for name, content in files.items():
        atomic_write(folder / name, content)
    if as_json:
        rows, columns = grid.cells.shape
        listed = {"files": [str(folder / n) for n in files], "cells": [columns, rows]}
        say_json({**listed, "resolution": resolution})
    else:
        say("\n".join(str(folder / name) for name in files))


def _inside(scenario: Scenario) -> list[tuple[float, float]]:
    """Return positions on the floor, m: starts of robots, or else centres of zones."""
    starts = [robot.task.start[:2] for robot in scenario.robots.values()]
    zones = scenario.environment.zones.values()
    middles = [(0.5 * (z.x[0] + z.x[1]), 0.5 * (z.y[0] + z.y[1])) for z in zones]
    return list(starts) or middles


def _height(scenario: Scenario, registry: object) -> float:
    """Return the height above which obstacles are left out, m: the top of the highest robot."""
    from crowdbot.core.registry.registry import Registry
    from crowdbot.core.robots.build import build_model

    assert isinstance(registry, Registry)
    heights = [build_model(registry, r.model).height for r in scenario.robots.values()]
    return max(heights, default=_HEAD)
