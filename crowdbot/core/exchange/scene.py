"""A scene of another simulator in crowdbot's terms: plain data of one scenario, and its origin."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, field
from typing import Any

from crowdbot.dsl.text.diagnostics import Mark

Path = tuple[str, ...]
Data = dict[str, Any]

#: Radius of a person where a scene has none, m.
USUAL_RADIUS = 0.33
#: Room around everything that a scene without a border of its own gets, m.
MARGIN = 10.0
_NOT_IN_IDS = re.compile(r"[^A-Za-z0-9_.-]+")


@dataclass(slots=True)
class Draft:
    """A scenario that is read from files of another simulator.

    Attributes:
        id: its name, as far as files have one.
        title: for people.
        environment: as in the language; a floor without `area` gets one around everything.
        crowd: all fields but agents and policies.
        policies: name -> ``{policy, costs}``; the first is the crowd's own.
        agents: rows; their `policy` is a name in ``policies``.
        robots: as in the language.
        tables: name of a file beside the document -> its content.
        origins: place in our document -> position in theirs.
        comments: place in our document -> what a reader should know.
        notes: lines at the head of the document.
    """

    id: str = "imported"
    title: str = ""
    environment: Data = field(default_factory=lambda: {"kind": "floor", "border": "open"})
    crowd: Data = field(default_factory=dict)
    policies: dict[str, Data] = field(default_factory=dict)
    agents: list[Data] = field(default_factory=list)
    robots: Data = field(default_factory=dict)
    tables: dict[str, str] = field(default_factory=dict)
    origins: dict[Path, Mark] = field(default_factory=dict)
    comments: dict[Path, str] = field(default_factory=dict)
    notes: list[str] = field(default_factory=list)

    def agent(self, row: Data, origin: Mark, comment: str = "") -> None:
        """Add an agent; without an id, its id is its row number."""
        path = ("crowd", "agents", str(len(self.agents)))
        self.origins[path] = origin
        if comment:
            self.comments[path] = comment
        self.agents.append({"id": len(self.agents), **row})

    def part(self, kind: str, name: str, value: Data, origin: Mark) -> str:
        """Add a named part of the environment, such as a wall; return its name."""
        parts = self.environment.setdefault(kind, {})
        free = free_name(name, parts)
        parts[free] = value
        self.origins["environment", kind, free] = origin
        return free

    def policy(self, value: Data, name: str, origin: Mark) -> str:
        """Add a policy unless an equal one is there; return its name."""
        for known, other in self.policies.items():
            if other == value:
                return known
        free = free_name(name, self.policies)
        self.policies[free] = value
        own = len(self.policies) == 1
        places = [("crowd", "policy"), ("crowd", "costs")] if own else [("crowd", "policies", free)]
        self.origins |= dict.fromkeys(places, origin)
        return free

    def data(self) -> Data:
        """Return the scenario as plain data, without its id."""
        found: Data = {"title": self.title} if self.title else {}
        found["environment"] = self._environment()
        if crowd := self._crowd():
            found["crowd"] = crowd
        if self.robots:
            found["robots"] = self.robots
        return found

    def _crowd(self) -> Data:
        if not (self.policies or "streams" in self.crowd or "spawns" in self.crowd):
            return {}
        found = dict(self.crowd)
        first = next(iter(self.policies), "")
        if first:
            found |= self.policies[first]
        others = {name: value for name, value in self.policies.items() if name != first}
        if others:
            found["policies"] = others
        if self.agents:
            found["agents"] = [
                {k: v for k, v in row.items() if (k, v) != ("policy", first)} for row in self.agents
            ]
        return found

    def _environment(self) -> Data:
        found = dict(self.environment)
        if found["kind"] == "floor" and found.get("border") != "torus":
            x0, x1, y0, y1 = self.extent()
            if "area" not in found:
                found["area"] = around(x0, x1, y0, y1)
            elif found.get("border") == "open":
                x, y = found["area"]["x"], found["area"]["y"]
                found["area"] = {"x": [min(x[0], x0), max(x[1], x1)],
                                 "y": [min(y[0], y0), max(y[1], y1)]}  # fmt: skip
            if found.get("zones"):  # places have to lie within the zones' bounds
                found["zones"] = {**found["zones"], "floor": found["area"]}
        return found

    def extent(self) -> tuple[float, float, float, float]:
        """Return x0, x1, y0, y1 of everything that has a position, m."""
        points = [(0.0, 0.0)] if not (self.agents or self.robots) else []
        points += [(a["x"], a["y"]) for a in self.agents]
        points += [r["task"]["start"][:2] for r in self.robots.values()]
        env = self.environment
        points += [p for w in env.get("walls", {}).values() for p in (w["start"], w["end"])]
        points += [p for b in env.get("blocks", {}).values() for p in b["corners"]]
        for kind in ("streams", "spawns", "goal_areas"):
            points += _corners(self.crowd.get(kind, {}))
        for kind in ("zones", "portals"):
            points += [(z["x"][k], z["y"][k]) for z in env.get(kind, {}).values() for k in (0, 1)]
        if env.get("zones"):
            points += [g for a in self.agents for g in a.get("goals", ())]
        for p in env.get("pillars", {}).values():
            points += [(p["x"] + k * p["radius"], p["y"] + k * p["radius"]) for k in (-1, 1)]
        xs, ys = [p[0] for p in points], [p[1] for p in points]
        return min(xs), max(xs), min(ys), max(ys)


def _corners(parts: Data) -> list[tuple[float, float]]:
    """Return two corners of each area of streams, spawns and goal areas."""
    named = ("origin", "destination", "area")
    areas = [part[name] for part in parts.values() for name in named if name in part]
    areas += [place for part in parts.values() for place in part.get("via", [])]
    return [
        (a["centre"][0] + k * a["size"][0], a["centre"][1] + k * a["size"][1])
        for a in areas
        if "centre" in a
        for k in (-0.5, 0.5)
    ]


def around(x0: float, x1: float, y0: float, y1: float) -> Data:
    """Return a rectangle with `MARGIN` around bounds, in whole metres."""
    return {
        "x": [math.floor(x0 - MARGIN), math.ceil(x1 + MARGIN)],
        "y": [math.floor(y0 - MARGIN), math.ceil(y1 + MARGIN)],
    }


def id_of(text: str) -> str:
    """Return a text as the id of a scenario."""
    return _NOT_IN_IDS.sub("-", text).strip("-.") or "imported"


def name_of(text: str) -> str:
    """Return a text as the name of a part: letters, digits and underscores."""
    name = re.sub(r"[^A-Za-z0-9_]+", "_", text).strip("_").lower()
    return name if name[:1].isalpha() else f"part_{name}" if name else "part"


def free_name(name: str, taken: Data) -> str:
    """Return a name, with a number if it is taken."""
    if name not in taken:
        return name
    number = 2
    while f"{name}_{number}" in taken:
        number += 1
    return f"{name}_{number}"
