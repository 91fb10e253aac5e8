"""Facts shared by all checks of a scenario, and common diagnostics."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from crowdbot.dsl.checks.known_places import bounds_of
from crowdbot.dsl.checks.pydantic_errors import mark_of
from crowdbot.dsl.scenario.crowd import Crowd
from crowdbot.dsl.scenario.scenario import Scenario
from crowdbot.dsl.spec.areas import Area
from crowdbot.dsl.spec.spec import Rectangle
from crowdbot.dsl.text.diagnostics import Diagnostic, Mark
from crowdbot.dsl.text.nodes import Node
from crowdbot.errors import did_you_mean, nearest

Path = tuple[str | int, ...]

_WHOLE = 1e-6
_TOLERANCE = 1e-9


@dataclass(frozen=True)
class Facts:
    """A validated scenario and its source tree."""

    scenario: Scenario
    tree: Node

    @property
    def crowd(self) -> Crowd:
        """Return the crowd of a scenario that has one."""
        assert self.scenario.crowd is not None
        return self.scenario.crowd

    @property
    def bounds(self) -> Rectangle | None:
        """Return the box around all zones, or the environment if known; m; or None."""
        return bounds_of(self.scenario.environment)

    def mark(self, *path: str | int) -> Mark:
        """Return the position of a value, or of its nearest parent."""
        return mark_of(self.tree, *path)

    def unknown(
        self, category: str, name: str, known: Iterable[str], *path: str | int
    ) -> Diagnostic:
        """Return the error for a name that the environment or the crowd does not have."""
        names = sorted(known)
        owner = "environment" if category in ("zone", "portal") else "crowd"
        hint = did_you_mean(nearest(name, names)).removeprefix("; ")
        hint = hint or (
            f"known: {', '.join(names)}" if names else f"the {owner} has no {category}s"
        )
        return Diagnostic("E130", f"the {owner} has no {category} '{name}'", self.mark(*path), hint)

    def portals(
        self, names: tuple[str, str], subject: str, *path: str | int
    ) -> Iterator[Diagnostic]:
        """Check that two different portals exist in the environment."""
        known = self.scenario.environment.portals
        for i, name in enumerate(names):
            if name not in known:
                yield self.unknown("portal", name, known, *path, i)
        if names[0] == names[1]:
            yield Diagnostic("E130", f"{subject} needs two different portals", self.mark(*path))

    def outside(
        self, subject: str, points: Iterable[tuple[float, float]], *path: str | int
    ) -> Iterator[Diagnostic]:
        """Yield an error for the first point outside the box around all zones.

        Args:
            subject: name of the point; ``{at}`` is replaced by its coordinates.
            points: x and y, m.
        """
        box = self.bounds
        if box is None:
            return
        (x0, x1), (y0, y1), gap = box.x, box.y, _TOLERANCE
        for x, y in points:
            if not (x0 - gap <= x <= x1 + gap and y0 - gap <= y <= y1 + gap):
                at = f"({x:g}, {y:g})"
                text = f"{subject.replace('{at}', at)} lies outside the environment's zones"
                hint = f"they reach from ({x0:g}, {y0:g}) to ({x1:g}, {y1:g}); add a zone around it"
                yield Diagnostic("E132", text, self.mark(*path), hint)
                return

    def area(self, place: str | Area, subject: str, *path: str | int) -> Iterator[Diagnostic]:
        """Check that a zone exists, or that an area lies inside the environment."""
        zones = self.scenario.environment.zones
        if isinstance(place, Area):
            yield from self.outside(f"the corner {{at}} of {subject}", place.corners, *path)
        elif place not in zones:
            yield self.unknown("zone", place, zones, *path)

    def resolve(self, place: str | Area) -> Area | None:
        """Return a place as an area; None for an unknown zone."""
        zone = self.scenario.environment.zones.get(place) if isinstance(place, str) else None
        return place if isinstance(place, Area) else Area.of(zone) if zone else None

    def whole(self, density: float, floor: float, where: str, *path: str) -> Iterator[Diagnostic]:
        """Check that a density gives a whole number of people."""
        count = density * floor
        if abs(count - round(count)) <= _WHOLE and round(count) >= 1:
            return
        fits = [n for n in (math.floor(count), math.ceil(count)) if n >= 1]
        hint = " or ".join(f"{n / floor:.10g} 1/m^2 ({people(n)})" for n in fits)
        text = (
            f"{density:g} 1/m^2 on the {floor:g} m^2 of {where} is {count:.6g} people, "
            "not a whole number"
        )
        yield Diagnostic("E131", text, self.mark(*path), f"nearest: {hint}")


def people(count: int) -> str:
    """Return a number with its noun, such as ``1 person`` or ``2 people``."""
    return "1 person" if count == 1 else f"{count} people"
