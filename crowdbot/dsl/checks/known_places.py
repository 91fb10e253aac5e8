"""A cache of environments' places, so that a suite builds each once.

Scenarios of a suite share the environment that no axis changes; it is identified by ``id`` and kept
alive in the cache, so that the id is not reused.
"""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

from crowdbot.dsl.spec.component_specs import EnvironmentSpec
from crowdbot.dsl.spec.place import Place
from crowdbot.dsl.spec.spec import Rectangle
from crowdbot.errors import InputError

_MOST = 64


class _Same:
    """A cache key for an environment, compared by identity."""

    __slots__ = ("environment",)

    def __init__(self, environment: EnvironmentSpec) -> None:
        self.environment = environment

    def __hash__(self) -> int:
        return id(self.environment)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Same) and self.environment is other.environment


def place_of(environment: EnvironmentSpec) -> Place | None:
    """Return the parts of an environment.

    Raises:
        InputError: as in `EnvironmentSpec.place`.
    """
    return _place(_Same(environment))


def known_place(environment: EnvironmentSpec) -> Place | None:
    """Return `place_of`, or None if it cannot be read."""
    try:
        return place_of(environment)
    except InputError:
        return None


@lru_cache(maxsize=_MOST)
def _place(same: _Same) -> Place | None:
    return same.environment.place()


def bounds_of(environment: EnvironmentSpec) -> Rectangle | None:
    """Return the box around all zones, and around the environment if known; m; or None."""
    return _bounds(_Same(environment))


@lru_cache(maxsize=_MOST)
def _bounds(same: _Same) -> Rectangle | None:
    zones = list(same.environment.zones.values())
    try:
        whole = same.environment.extent()
    except InputError:  # reported with the environment
        return None
    zones += [] if whole is None else [whole]
    if not zones:
        return None
    xs, ys = [x for z in zones for x in z.x], [y for z in zones for y in z.y]
    return Rectangle(x=(min(xs), max(xs)), y=(min(ys), max(ys)))


@lru_cache(maxsize=_MOST)
def bodies_of(place: Place, height: float) -> Place:
    """Return the obstacles for people of a height (m)."""
    return place.bodies(height)


@lru_cache(maxsize=_MOST)
def standing_in(place: Place) -> Place:
    """Return the obstacles for every robot: those that stand on the floor."""
    return replace(
        place,
        faces=tuple(f for f in place.faces if f.stops_robot and f.heights[0] == 0.0),
        solids=tuple(s for s in place.solids if s.heights[0] == 0.0),
        pillars=tuple(p for p in place.pillars if p.heights[0] == 0.0),
    )
