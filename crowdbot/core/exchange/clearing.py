"""Move people and places out of solids: other simulators allow overlap, crowdbot does not.

People are moved to the nearest place with room for their body, where their own simulator's contact
would push them, too; so are goals and areas that have no room at all.
"""

from __future__ import annotations

import math
from typing import Any

from crowdbot.core.exchange.report import Report, Trace
from crowdbot.core.exchange.rows import PartOutcome
from crowdbot.core.exchange.scene import USUAL_RADIUS, Data, Draft, Path
from crowdbot.core.geometry.valid_shape import valid_shape

#: Room that is kept to what is solid, m; side of an area in place of one without room, m.
_APART, _SIDE = 0.01, 0.2
#: Least area of a part that is kept, m^2.
_LEAST = 1e-6
#: Digits of places that are moved.
_DIGITS = 4


class FreeFloor:
    """The part of a scene's floor where the middle of a body can be.

    Args:
        scene: the scene, whose obstacles and border count.
    """

    def __init__(self, scene: Draft) -> None:
        self._floor, self._solid = _floor(scene), _solid(scene.environment)
        self._extent = scene.extent()
        self._known: dict[float, Any] = {}

    @property
    def bounded(self) -> bool:
        """Return True if the floor has a border or obstacles."""
        return self._floor is not None or not self._solid.is_empty

    def of(self, radius: float) -> Any:
        """Return the free floor for a body of a radius (m) as a shape; None: everywhere."""
        if radius not in self._known:
            free = self._whole() if self._floor is None else self._floor
            shrunk = free.buffer(-radius - _APART) if self._floor is not None else free
            self._known[radius] = shrunk.difference(self._solid.buffer(radius + _APART))
        return self._known[radius]

    def _whole(self) -> Any:
        from shapely import box  # type: ignore[import-untyped,unused-ignore]

        x0, x1, y0, y1 = self._extent
        far = 10.0 + max(x1 - x0, y1 - y0)
        return box(x0 - far, y0 - far, x1 + far, y1 + far)

    def blocks(self, x: float, y: float, radius: float) -> bool:
        """Return True if a body (radius m) has no room at a place."""
        from shapely import Point  # type: ignore[import-untyped,unused-ignore]

        at = Point(x, y)
        if self._floor is not None and not (
            self._floor.covers(at) and self._floor.boundary.distance(at) >= radius - 1e-7
        ):
            return True
        near = self._solid.distance(at) < radius - 1e-7 if not self._solid.is_empty else False
        return bool(near or self._solid.contains(at))

    def nearest(self, x: float, y: float, radius: float) -> list[float] | None:
        """Return the nearest place for a body of a radius (m); None if there is none."""
        from shapely import Point  # type: ignore[import-untyped,unused-ignore]
        from shapely.ops import nearest_points  # type: ignore[import-untyped,unused-ignore]

        free = self.of(radius)
        if free.is_empty:
            return None
        found, _ = nearest_points(free, Point(x, y))
        return [round(found.x, _DIGITS), round(found.y, _DIGITS)]

    def within(self, place: Data) -> Data | None:
        """Return the part of an area inside the border; None if that is all of it, or nothing."""
        if self._floor is None:
            return None
        x0, y0, x1, y1 = self._floor.bounds
        a0, b0, a1, b1 = shape_of(place).bounds
        left, right, low, high = max(a0, x0), min(a1, x1), max(b0, y0), min(b1, y1)
        if (left, low, right, high) == (a0, b0, a1, b1) or left >= right or low >= high:
            return None
        return {
            "centre": [round(0.5 * (left + right), 6), round(0.5 * (low + high), 6)],
            "size": [round(right - left - 2e-6, 6), round(high - low - 2e-6, 6)],
        }

    def pockets(self) -> list[Any]:
        """Return the places that walls close off from all sides, as polygons."""
        from shapely import Polygon  # type: ignore[import-untyped,unused-ignore]

        parts = getattr(self._solid, "geoms", [self._solid])
        return [Polygon(ring) for part in parts for ring in getattr(part, "interiors", ())]

    def joins(self, start: Any, goal: Any, radius: float) -> bool:
        """Return True if one connected part of the free floor has room in both shapes."""
        free = self.of(radius)
        parts = getattr(free, "geoms", [free])
        return any(part.intersects(start) and part.intersects(goal) for part in parts)


def step_out(scene: Draft, report: Report) -> None:
    """Move people, goals and areas of a scene out of solids; record each change."""
    _clip_blocks(scene, report)
    floor = FreeFloor(scene)
    if not floor.bounded:
        return
    body = scene.crowd.get("body", {}).get("radius", USUAL_RADIUS)
    finds_path = scene.crowd.get("routing", {}).get("kind") == "mesh"
    for number, agent in enumerate(scene.agents):
        radius = agent.get("radius", body)
        path = ("crowd", "agents", str(number))
        if not _replayed(scene, agent):
            _start(scene, agent, floor, (path, radius), report)
            _goals(scene, agent, floor, (path, radius if finds_path else 0.0), report)
    for kind, fields in (("streams", ("origin", "destination", "area")), ("spawns", ("area",)),
                         ("goal_areas", ("area",))):  # fmt: skip
        for name, part in scene.crowd.get(kind, {}).items():
            radius = part.get("body", {}).get("radius", body)
            places = [part[field] for field in fields if field in part] + part.get("via", [])
            for place in places:
                _area(scene, place, floor, (("crowd", kind, name), radius), report)


def _clip_blocks(scene: Draft, report: Report) -> None:
    """Clip blocks at the border of a walled floor, since parts outside cannot be seen.

    Blocks that lie outside as a whole are left out.
    """
    from shapely import Polygon  # type: ignore[import-untyped,unused-ignore]

    floor = _floor(scene) if "wkt" not in scene.environment else None
    blocks = scene.environment.get("blocks", {})
    if floor is None:
        return
    for name in list(blocks):
        whole = Polygon(blocks[name]["corners"]).buffer(0)
        if floor.covers(whole):
            continue
        inside = whole.intersection(floor)
        parts = [part for part in getattr(inside, "geoms", [inside]) if part.area > _LEAST]
        path: Path = ("environment", "blocks", name)
        kept = blocks.pop(name)
        for part in parts:
            corners = [list(p) for p in part.exterior.coords[:-1]]
            scene.part("blocks", name, {**kept, "corners": corners}, scene.origins[path])
        note = "its part outside of the floor is left out" if parts else "is outside of the floor"
        _record(scene, path, "obstacle", ".".join(path[:2]), note, report)


def _replayed(scene: Draft, agent: Data) -> bool:
    used = scene.policies.get(agent.get("policy", ""), {})
    return bool(used.get("policy", {}).get("kind") == "replay")


_At = tuple[Path, float]


def _start(scene: Draft, agent: Data, floor: FreeFloor, at: _At, report: Report) -> None:
    path, radius = at
    x, y = agent["x"], agent["y"]
    if not floor.blocks(x, y, radius):
        return
    found = floor.nearest(x, y, radius)
    if found is None:
        return
    agent["x"], agent["y"] = found
    stands = agent.get("goals") == [[x, y]]
    if stands:
        agent["goals"] = [found]
    note = f"stands in something solid: moved {math.dist((x, y), found):.2g} m to where there is "
    note += "room for its body"
    _record(scene, path, "start", "crowd.agents.x, y", note, report)


def _goals(scene: Draft, agent: Data, floor: FreeFloor, at: _At, report: Report) -> None:
    path, radius = at
    for number, (x, y) in enumerate(agent.get("goals", [])):
        if floor.blocks(x, y, radius) and (found := floor.nearest(x, y, radius)) is not None:
            agent["goals"][number] = found
            note = f"lies in something solid: moved {math.dist((x, y), found):.2g} m out of it"
            _record(scene, path, f"goal {number}", "crowd.agents.goals", note, report)


def _area(scene: Draft, place: Data, floor: FreeFloor, at: _At, report: Report) -> None:
    path, radius = at
    if "centre" not in place:
        return
    if (rest := floor.within(place)) is not None:
        place |= rest
        note = "a part of it is outside of the floor and is left out"
        _record(scene, path, "area", ".".join(path[:2]), note, report)
    if floor.of(radius).intersects(shape_of(place)):
        return
    x, y = place["centre"]
    found = floor.nearest(x, y, radius + 0.5 * _SIDE) or floor.nearest(x, y, radius)
    if found is not None:
        place |= {"centre": found, "size": [_SIDE, _SIDE]}
        note = f"no body has room in it: a place {math.dist((x, y), found):.2g} m away instead"
        _record(scene, path, "area", ".".join(path[:2]), note, report)


def shape_of(place: Data) -> Any:
    """Return an area that is written in a stream or spawn as a shape."""
    from shapely import box  # type: ignore[import-untyped,unused-ignore]

    (x, y), (width, height) = place["centre"], place["size"]
    return box(x - 0.5 * width, y - 0.5 * height, x + 0.5 * width, y + 0.5 * height)


def _record(
    scene: Draft, path: Path, theirs: str, ours: str, note: str, report: Report
) -> None:  # fmt: skip
    place = scene.origins.get(path)
    report.entries.append(Trace(PartOutcome.INTERPRETED, theirs, place, ours, note))
    if path[1] == "agents" and path not in scene.comments:
        scene.comments[path] = f"its {theirs} {note}"


def _floor(scene: Draft) -> Any:
    """Return the floor within its border as a shape; None without a border."""
    from shapely import box, from_wkt  # type: ignore[import-untyped,unused-ignore]

    env = scene.environment
    if "wkt" in env:
        return valid_shape(from_wkt(env["wkt"])).buffer(0)  # polygons only
    if env.get("border") != "walls" or "area" not in env:
        return None
    (x0, x1), (y0, y1) = env["area"]["x"], env["area"]["y"]
    return box(x0, y0, x1, y1)


def _solid(environment: Data) -> Any:
    """Return walls, blocks and pillars as one shape."""
    from shapely import LineString, Point, Polygon, unary_union  # type: ignore[import-untyped,unused-ignore]

    parts = [Polygon(b["corners"]).buffer(0) for b in environment.get("blocks", {}).values()]
    parts += [
        LineString([w["start"], w["end"]]).buffer(0.5 * w["thickness"], cap_style="square")
        for w in environment.get("walls", {}).values()
        if math.dist(w["start"], w["end"]) > 0.0
    ]
    parts += [
        Point(p["x"], p["y"]).buffer(p["radius"], 64)
        for p in environment.get("pillars", {}).values()
    ]
    return unary_union(parts)
