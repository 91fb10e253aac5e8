"""Build the content of a scenario's map.

Sensors are drawn from their specs alone: building sensors would compile ray casting.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

from crowdbot.core.assistance.target import Target, find_targets
from crowdbot.core.environments.build import build_environment
from crowdbot.core.geometry.footprint import footprint_of_model
from crowdbot.core.population.realisation import Realisation
from crowdbot.core.registry.registry import Registry
from crowdbot.core.robots.build import build_model
from crowdbot.core.types.arrays import Point
from crowdbot.core.view.map_content import MapContent, RobotView, Sector
from crowdbot.core.view.ways import ways_of
from crowdbot.dsl.scenario.crowd import Crowd
from crowdbot.dsl.scenario.robot import Robot
from crowdbot.dsl.scenario.scenario import Scenario
from crowdbot.dsl.spec.areas import Area
from crowdbot.dsl.spec.component_specs import SensorSpec
from crowdbot.dsl.spec.spec import Mount


def build_map_content(scenario: Scenario, people: Realisation, registry: Registry) -> MapContent:
    """Build the environment and collect everything else on the map.

    Args:
        scenario: the scenario to draw.
        people: its agents, sampled or read from a lock.
        registry: the installed components.
    """
    areas = {} if scenario.crowd is None else _areas(scenario.crowd)
    parts = build_environment(registry, scenario.environment)
    targets = find_targets(scenario, parts, people)
    return MapContent(
        parts=parts,
        people=people,
        robots=tuple(_robot(n, r, registry, targets.get(n)) for n, r in scenario.robots.items()),
        areas=areas,
        ways=ways_of(scenario.crowd, people, parts),
    )


def _areas(crowd: Crowd) -> dict[str, dict[str, tuple[Point, ...]]]:
    """Return the crowd's own areas; those that are zones are drawn as zones."""
    spawns = {n: s.area.corners for n, s in crowd.spawns.items() if isinstance(s.area, Area)}
    goals = {n: g.area.corners for n, g in crowd.goal_areas.items() if isinstance(g.area, Area)}
    for name, stream in crowd.streams.items():
        for field, place in stream.places():
            if isinstance(place, Area):
                role = spawns if field[0] in stream.begin_fields else goals
                role[" ".join([name, *map(str, field)])] = place.corners
    return {"spawn": spawns, "goal-area": goals}


def _robot(name: str, robot: Robot, registry: Registry, target: Target | None) -> RobotView:
    x, y, yaw = robot.task.start
    model = build_model(registry, robot.model)
    body = footprint_of_model(model)
    return RobotView(
        name=name,
        x=x,
        y=y,
        yaw=yaw,
        radius=body.reach,
        outline=tuple(map(tuple, body.outline(x, y, yaw).tolist())),
        goal=robot.task.zone or "",
        targets=() if target is None else tuple(target.rows.tolist()),
        sensors=tuple(_sectors(robot, x, y, yaw, model.base_height)),
    )


def _sectors(robot: Robot, x: float, y: float, yaw: float, base: float) -> Iterator[Sector]:
    """Yield the views of sensors; ``base`` is the height of base_link above the floor, m."""
    for name, spec in robot.sensors.items():
        seen = field_of_view(spec)
        if seen is None:
            continue
        start, end, reach = seen
        mount = getattr(spec, "mount", None) or Mount()
        mx, my, turned = mount.x, mount.y, mount.yaw
        flat = hasattr(spec, "angle_min") and not hasattr(spec, "elevation")
        c, s = math.cos(yaw), math.sin(yaw)
        yield Sector(
            name=name,
            x=x + c * mx - s * my,
            y=y + s * mx + c * my,
            start=yaw + turned + start,
            end=yaw + turned + end,
            reach=reach,
            axis=yaw + turned,
            tilt=(getattr(mount, "roll", 0.0), getattr(mount, "pitch", 0.0)),
            height=base + mount.z if flat else None,
        )


def field_of_view(spec: SensorSpec) -> tuple[float, float, float] | None:
    """Return first and last angle (rad) and range (m) of a sensor.

    A spec may define ``field_of_view()``. Otherwise its field names decide: a maximum range with
    ``angle_min`` and ``angle_max``, or with an opening angle; with neither, the view is all round.
    None for a sensor without a view, such as odometry.
    """
    own = getattr(spec, "field_of_view", None)
    if callable(own):
        low, high, far = own()
        return float(low), float(high), float(far)
    reach = next((r for r in (_number(spec, n) for n in _REACHES) if r is not None), None)
    if reach is None:
        return None
    low, high = getattr(spec, "angle_min", None), getattr(spec, "angle_max", None)
    if isinstance(low, float) and isinstance(high, float):
        return low, high, reach
    for name in _OPENINGS:
        width = _number(spec, name)
        if width is not None:
            return -0.5 * width, 0.5 * width, reach
    return -math.pi, math.pi, reach


#: Field names for a sensor's range and opening angle.
_REACHES = ("range_max", "max_range", "reach", "max_distance", "range")
_OPENINGS = (
    "horizontal_fov", "fov", "field_of_view", "opening_angle", "opening", "aperture", "beam_width",
)  # fmt: skip


def _number(spec: SensorSpec, name: str) -> float | None:
    value: object = getattr(spec, name, None)
    if isinstance(value, bool) or not isinstance(value, int | float):
        return None
    return float(value) if math.isfinite(value) else None
