"""Entry areas from which no path leads out: gaps between pillars, strips behind walls.

Other simulators push people straight to their goals; crowdbot's people need a path.
"""

from __future__ import annotations

from typing import Any

from crowdbot.core.exchange.clearing import FreeFloor, shape_of
from crowdbot.core.exchange.report import Report, Trace
from crowdbot.core.exchange.rows import PartOutcome
from crowdbot.core.exchange.scene import USUAL_RADIUS, Data, Draft, Path

#: Least area in which a body could be placed, m^2.
_LEAST = 1e-4
#: Least share of a goal that a part of the floor has to have.
_SHARE = 0.05


def keep_ways(scene: Draft, report: Report) -> None:
    """Make sure that each entry area has paths to all its goals; record each change.

    An area is cut to the part of the floor with paths, and pockets closed by walls are filled.
    Spawns for which that does not suffice walk straight to their goals.
    """
    if scene.crowd.get("routing", {}).get("kind") != "mesh":
        return
    body = scene.crowd.get("body", {}).get("radius", USUAL_RADIUS)
    areas = scene.crowd.get("goal_areas", {})
    for name, spawn in scene.crowd.get("spawns", {}).items():
        goals = [areas[goal]["area"] for goal in spawn.get("goals", {}).get("areas", ())]
        _keep(scene, (("crowd", "spawns", name), body), spawn["area"], goals, report)
    for name, stream in scene.crowd.get("streams", {}).items():
        if "origin" in stream:
            radius = stream.get("body", {}).get("radius", body)
            goals = [stream["destination"], *stream.get("via", ())]
            _keep(scene, (("crowd", "streams", name), radius), stream["origin"], goals, report)
    if any(_lost(scene, body, spawn, areas) for spawn in scene.crowd.get("spawns", {}).values()):
        del scene.crowd["routing"]
        note = "straight to their goals: from some places no way leads there"
        report.added("crowd.routing", note)


def _lost(scene: Draft, radius: float, spawn: Data, areas: Data) -> bool:
    goals = [areas[goal]["area"] for goal in spawn.get("goals", {}).get("areas", ())]
    good, bad = _parts(FreeFloor(scene), radius, spawn["area"], goals)
    return bool(goals) and (not good or bool(bad))


def _parts(floor: FreeFloor, radius: float, area: Data, goals: list[Data]) -> tuple[Any, Any]:
    """Return the parts of the floor in an area: those with a path to the goals, and the others."""
    free, start = floor.of(radius), shape_of(area)
    good: list[Any] = []
    bad: list[Any] = []
    for part in getattr(free, "geoms", [free]):
        if part.intersection(start).area > _LEAST:
            joined = all(_is_in(part, shape_of(goal)) for goal in goals)
            (good if joined else bad).append(part)
    return good, bad


def _is_in(part: Any, goal: Any) -> bool:
    """Return True if more than a corner of a goal is in a part of the floor."""
    return bool(part.intersection(goal).area > _SHARE * goal.area)


def _keep(
    scene: Draft, at: tuple[Path, float], area: Data, goals: list[Data], report: Report
) -> None:
    path, radius = at
    floor = FreeFloor(scene)
    good, bad = _parts(floor, radius, area, goals)
    if not (goals and good and bad):
        return
    _cut(scene, path, area, max(good, key=lambda part: part.intersection(shape_of(area)).area),
         report)  # fmt: skip
    for pocket in floor.pockets():
        inside = pocket.intersection(shape_of(area)).area > _LEAST
        if inside and not any(pocket.intersects(shape_of(goal)) for goal in goals):
            corners = [list(point) for point in pocket.exterior.coords[:-1]]
            scene.part("blocks", "pocket", {"corners": corners}, scene.origins[path])
            note = "a part of the area that walls close off is filled"
            _record(scene, path, "environment.blocks", note, report)


def _cut(scene: Draft, path: Path, area: Data, part: Any, report: Report) -> None:
    """Cut an area to the bounds of a part of the floor."""
    x0, y0, x1, y1 = part.intersection(shape_of(area)).bounds
    a0, b0, a1, b1 = shape_of(area).bounds
    left, right = max(a0, x0), min(a1, x1)
    low, high = max(b0, y0), min(b1, y1)
    if (left, low, right, high) != (a0, b0, a1, b1):
        area |= {"centre": [round(0.5 * (left + right), 6), round(0.5 * (low + high), 6)],
                 "size": [round(right - left, 6), round(high - low, 6)]}  # fmt: skip
        note = "cut to the part from which a way leads to all goals"
        _record(scene, path, ".".join(path[:2]), note, report)


def _record(scene: Draft, path: Path, ours: str, note: str, report: Report) -> None:
    report.entries.append(
        Trace(PartOutcome.INTERPRETED, "area", scene.origins.get(path), ours, note)
    )
