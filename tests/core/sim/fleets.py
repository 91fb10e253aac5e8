"""Scenarios with several robots, and their runs."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from crowdbot.core.registry.registry import Registry
from crowdbot.core.runs.run_options import RunOptions
from crowdbot.core.scenarios.library import open_spec
from crowdbot.core.sim.simulate import simulate
from crowdbot.dsl.scenario.scenario import Scenario

HALL = """\
crowdbot: 1
scenario:
  id: hall
  environment:
    kind: floor
    area: {x: [-10 m, 10 m], y: [-3 m, 3 m]}
    zones: {east: {x: [8 m, 10 m], y: [-3 m, 3 m]}, west: {x: [-10 m, -8 m], y: [-3 m, 3 m]}}
"""
#: Six people who walk to the east.
PEOPLE = """\
  crowd:
    spawns:
      six: {count: 6, area: {centre: [0 m, 0 m], size: [6 m, 5 m]}, goals: {areas: [far]}}
    goal_areas: {far: {area: {centre: [7.5 m, 0 m], size: [1 m, 4 m]}}}
    speed: {mean: 1.2 m/s, std: 10 cm/s}
    policy: {kind: velocity_space}
    costs: {mid_term: {kind: ttca_dca, weight: 20, range: 5 m}}
"""


def robot(
    x: float, y: float, yaw: float, goal: str, limit: float = 3.0, **more: str
) -> dict[str, Any]:
    """One robot of a hall: start (m, degrees), goal zone, time limit (s)."""
    return {"start": (x, y, yaw), "goal": goal, "limit": limit, **more}


def scenario(
    folder: Path, registry: Registry, robots: Mapping[str, dict[str, Any]], people: str = ""
) -> Scenario:
    """A hall with robots."""
    lines = [HALL, people, "  robots:\n"]
    for name, one in robots.items():
        x, y, yaw = one["start"]
        lines.append(
            f"    {name}:\n"
            f"      model: {{kind: {one.get('model', 'turtlebot2')}}}\n"
            f"      control: {one.get('control', 'differential_drive')}\n"
            "      sensors:\n"
            "        lidar: {kind: lidar2d, mount: {z: 0.2 m}, noise: 1 mm}\n"
            "        odometry: {kind: wheel_odometry}\n"
            f"      task: {{start: [{x} m, {y} m, {yaw} deg], goal: {{zone: {one['goal']}}}, "
            f"time_limit: {one['limit']} s, when_ended: {one.get('when_ended', 'stay')}}}\n"
        )
    file = folder / "hall.yaml"
    file.write_text("".join(lines))
    return open_spec(str(file), registry, ()).scenarios[0]


def run(
    scenario: Scenario, registry: Registry, out: Path, planner: str = "goal_seek", **options: Any
) -> Any:
    """Simulate it, without calibration runs and without a page."""
    given = {"references": False, "replay": False, **options}
    seed = given.pop("seed", 0)
    chosen = RunOptions(**given)
    return simulate(scenario, registry, planner=planner, seed=seed, out=out, options=chosen)
