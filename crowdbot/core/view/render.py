"""Render the content of a map as a drawing: map, legend and heading."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

from crowdbot.core.types.environment import EnvironmentParts
from crowdbot.core.view.map_content import (
    LOW,
    MapContent,
    extent,
    fastest,
    shapes,
    solid_role,
)
from crowdbot.core.view.shapes import SPEEDS, Disc, Drawing, Path, Shape, Text
from crowdbot.core.view.world import LEFT, TOP, Map

_RIGHT, _HEAD, _LINE = 26.0, 62.0, 24.0
_SWATCH = 13.0
_LEAST_WIDTH = 720.0


def render(
    content: MapContent,
    title: str,
    facts: Mapping[str, str],
    *,
    heading: bool,
    legend: bool = True,
) -> Drawing:
    """Return the drawing of a map.

    Args:
        content: from `build_map_content`.
        title: the scenario's name.
        facts: name -> text, written below the title.
        heading: True to draw title and facts, for a standalone picture.
        legend: True to draw the legend below the map.
    """
    top = _HEAD + _LINE * (len(_lines(facts)) - 1) if heading else TOP
    world = Map.around(extent(content), top)
    x, y, width, height = world.box
    paper = max(x + width + _RIGHT, _LEAST_WIDTH)
    entries, bottom = _legend(content, world, x, y + height + 46.0, paper - _RIGHT)
    if not legend:
        paper, entries, bottom = x + width + _RIGHT, [], y + height + _RIGHT
    head = _heading(title, facts) if heading else iter(())
    ground = ((0.0, 0.0), (paper, 0.0), (paper, bottom), (0.0, bottom))
    return Drawing(
        width=paper,
        height=bottom,
        map_box=world.box,
        title=title,
        facts=dict(facts),
        shapes=(
            Path(points=ground, role="page", closed=True, inside=False),
            *head,
            *shapes(content, world),
            *entries,
        ),
    )


def _lines(facts: Mapping[str, str]) -> list[str]:
    """Return short facts on one line, and the hash on its own."""
    long = [f"{k}: {v}" for k, v in facts.items() if len(v) > 40]
    short = " · ".join(f"{k}: {v}" for k, v in facts.items() if len(v) <= 40)
    return [line for line in (short, *long) if line]


def _heading(title: str, facts: Mapping[str, str]) -> Iterator[Shape]:
    yield Text(at=(LEFT, 30.0), text=title, role="text-strong", size=18)
    for i, line in enumerate(_lines(facts)):
        yield Text(at=(LEFT, 50.0 + 17.0 * i), text=line, role="text-muted", size=12)


def _legend(
    content: MapContent, world: Map, left: float, top: float, right: float
) -> tuple[list[Shape], float]:
    """Return swatch and label of everything on the map, and the bottom edge, px."""
    return legend_of(_entries(content), world, left, top, right)


def legend_of(
    entries: Iterable[tuple[str, str]], world: Map, left: float, top: float, right: float
) -> tuple[list[Shape], float]:
    """Return swatch and label of entries, the scale at their right, and the bottom edge, px."""
    made: list[Shape] = []
    x, y = left, top
    ruler = list(world.ruler(right, top + 4.0))
    limit = min(p[0] for s in ruler if isinstance(s, Path) for p in s.points) - 20.0
    for role, label in entries:
        width = _SWATCH + 8.0 + 6.6 * len(label) + 20.0
        if x + width > limit and x > left:
            x, y = left, y + _LINE
        made += [
            *_swatch(role, x, y),
            Text(at=((x + 2.0 * _SWATCH), y), text=label, role="text", size=12),
        ]
        x += width + _SWATCH
    return [*made, *ruler], y + 22.0


def _entries(content: MapContent) -> Iterator[tuple[str, str]]:
    parts = content.parts
    if len(content.people):
        yield "ramp", f"people, 0–{fastest(content.people):g} m/s"
        yield "arrow", "way of 1 s at preferred speed"
    if (content.people.group >= 0).any():
        yield "group", "group"
    if any(content.people.goals):
        yield "route", "their routes"
    yield from _robot_entries(content)
    if any(robot.sensors for robot in content.robots):
        yield "sensor", "what its sensors reach"
    if content.ways.margins:
        yield "mesh", "mesh: no centre of a body beyond, and lines of sight"
    yield from _wall_entries(parts)
    if len(parts.portals):
        yield "portal", "portal"
    if parts.periodic_boundary is not None:
        yield "torus", "border that leads to the other side"
    for role, label in (("spawn", "spawn area"), ("goal-area", "goal area")):
        if content.areas.get(role):
            yield role, label


def _robot_entries(content: MapContent) -> Iterator[tuple[str, str]]:
    """Yield legend entries of robots and of what their tasks are about."""
    if not content.robots:
        return
    yield "robot", "robot"
    has_target = any(robot.targets for robot in content.robots)
    if not has_target or any(robot.goal for robot in content.robots):
        yield "goal", "its goal"
    if has_target:
        yield "wanted", "person of its task"


def _wall_entries(parts: EnvironmentParts) -> Iterator[tuple[str, str]]:
    """Yield legend entries of walls and obstacles."""
    solids = {solid_role(*heights) for heights in parts.solid_heights.tolist()}
    for role, label in (
        ("solid", "block"),
        ("solid-low", f"not higher than {LOW:g} m"),
        ("solid-raised", "raised: open below"),
    ):
        if role in solids:
            yield role, label
    alone = ~parts.sides()
    stops = parts.stops_robot[alone].tolist(), parts.stops_crowd[alone].tolist()
    pairs = list(zip(*stops, strict=True))
    for role, pair, label in (
        ("wall", (True, True), "wall"),
        ("wall-robot", (True, False), "wall for robots only"),
        ("wall-crowd", (False, True), "wall for people only"),
    ):
        if pair in pairs:
            yield role, label
    if parts.left_out:
        yield "left-out", "too small: left out"


def _swatch(role: str, x: float, y: float) -> Iterator[Shape]:
    low, high = y - 9.0, y + 1.0
    middle, end = 0.5 * (low + high), x + _SWATCH + 4.0
    if role == "ramp":
        step = (end - x) / len(SPEEDS)
        for i in range(len(SPEEDS)):
            box = _box(x + i * step, low, x + (i + 1) * step, high)
            yield Path(points=box, role=f"ramp-{i}", closed=True, inside=False)
    elif role in ("robot", "wanted"):
        yield Disc(centre=(x + 8.0, middle), radius=6.0, role=role, inside=False)
    elif role == "arrow":
        yield Path(points=((x, middle), (end, middle)), role=role, inside=False)
        wings = ((end - 5.0, middle - 3.0), (end, middle), (end - 5.0, middle + 3.0))
        yield Path(points=wings, role=role, inside=False)
    elif role.startswith("wall") or role in ("group", "route", "thought", "torus", "mesh"):
        yield Path(points=((x, middle), (end, middle)), role=role, inside=False)
    else:
        yield Path(points=_box(x, low, end, high), role=role, closed=True, inside=False)


def _box(x0: float, y0: float, x1: float, y1: float) -> tuple[tuple[float, float], ...]:
    return ((x0, y0), (x1, y0), (x1, y1), (x0, y1))
