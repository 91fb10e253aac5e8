"""Hard places for crowds, in YAML: pillars, doors, thin walls, a pocket, an island, borders."""

from __future__ import annotations

import math

import numpy as np
import shapely  # type: ignore[import-untyped,unused-ignore]
from numpy.typing import NDArray

Array = NDArray[np.float64]
WIDE, DEEP = 12.0, 8.0  # m, of the halls


def _box(x0: float, x1: float, y0: float, y1: float) -> str:
    return (
        f"{{centre: [{(x0 + x1) / 2:g} m, {(y0 + y1) / 2:g} m], "
        f"size: [{x1 - x0:g} m, {y1 - y0:g} m]}}"
    )


def _hall(solid: str) -> str:
    return f"{{kind: floor, area: {{x: [0 m, {WIDE:g} m], y: [0 m, {DEEP:g} m]}}, {solid}}}"


#: The areas that people walk between; all lie a body's width inside the walls.
_WEST, _EAST = _box(0.3, 1.3, 0.5, DEEP - 0.5), _box(WIDE - 1.3, WIDE - 0.3, 0.5, DEEP - 0.5)
_SOUTH, _NORTH = _box(0.5, WIDE - 0.5, 0.3, 1.3), _box(0.5, WIDE - 0.5, DEEP - 1.3, DEEP - 0.3)
_ALL = _box(0.3, WIDE - 0.3, 0.3, DEEP - 0.3)


def _stream(begin: str, end: str, density: float) -> str:
    return (
        f"{{kind: through, origin: {begin}, destination: {end}, start: {_ALL}, "
        f"count: {round(density * WIDE * DEEP)}}}"
    )


def _people(streams: list[str], routing: bool) -> str:
    named = ", ".join(f"s{k}: {stream}" for k, stream in enumerate(streams))
    ways = "routing: {kind: mesh}, " if routing else ""
    return f"{{{ways}streams: {{{named}}}}}"


def _both(density: float) -> list[str]:
    return [_stream(_WEST, _EAST, density / 2), _stream(_EAST, _WEST, density / 2)]


def _crossing(density: float) -> list[str]:
    return [_stream(_WEST, _EAST, density / 2), _stream(_SOUTH, _NORTH, density / 2)]


def _grid(pitch: float, radius: float, shift: float = 0.0) -> str:
    """Pillars in a grid, in the middle of a hall whose y begins at `shift`."""
    xs = np.arange(2.0, WIDE - 1.9, pitch)
    ys = shift + np.arange(0.5 * pitch, DEEP - radius, pitch)
    each = [
        f"p{i}: {{x: {x:g} m, y: {y:g} m, radius: {radius:g} m}}"
        for i, (x, y) in enumerate((x, y) for x in xs for y in ys)
    ]
    return f"pillars: {{{', '.join(each)}}}"


def _bars(count: int, seed: int) -> str:
    """Thin walls at any angle, with room for a body between any two."""
    rng, found = np.random.default_rng(seed), list[tuple[Array, Array]]()
    while len(found) < count:
        at, angle = rng.uniform([2.0, 0.8], [WIDE - 2.0, DEEP - 0.8]), rng.uniform(0.0, math.pi)
        half = rng.uniform(0.3, 1.2) / 2.0 * np.array([math.cos(angle), math.sin(angle)])
        line = shapely.LineString([at - half, at + half])
        if all(line.distance(shapely.LineString(other)) > 0.8 for other in found):
            found.append((at - half, at + half))
    each = [
        f"b{i}: {{start: [{a[0]:.3f} m, {a[1]:.3f} m], end: [{b[0]:.3f} m, {b[1]:.3f} m], "
        "thickness: 2 cm}"
        for i, (a, b) in enumerate(found)
    ]
    return f"walls: {{{', '.join(each)}}}"


def _door(count: int, thickness: str) -> tuple[str, str]:
    """A room of 7.6 m x 8 m that `count` people leave through a door of 0.8 m."""
    walls = (
        f"walls: {{below: {{start: [8 m, 0 m], end: [8 m, 3.6 m], thickness: {thickness}}}, "
        f"above: {{start: [8 m, 4.4 m], end: [8 m, {DEEP:g} m], thickness: {thickness}}}}}"
    )
    room, beyond = _box(0.3, 7.5, 0.3, DEEP - 0.3), _box(10.0, 11.5, 1.0, DEEP - 1.0)
    stream = (
        f"{{kind: through, origin: {room}, destination: {beyond}, at_destination: leave, "
        f"count: {count}}}"
    )
    return _hall(walls), _people([stream], routing=True)


def _torus(pillars: str, density: float, directions: str) -> tuple[str, str]:
    """A floor without end; each of its people walks on in one direction, of those given if any."""
    count = round(density * WIDE * DEEP)
    own = f", directions: {directions}" if directions else ""
    stream = f"{{kind: directions, area: {_ALL}, count: {count}{own}}}"
    return _hall(f"border: torus, {pillars}"), _people([stream], routing=False)


def _portals(pillars: str, density: float, goal: str) -> tuple[str, str]:
    """A corridor with portals at both ends."""
    ys = f"y: [{-DEEP / 2:g} m, {DEEP / 2:g} m]"
    place = (
        f"{{kind: corridor, length: {WIDE:g} m, width: {DEEP:g} m, {pillars}, "
        f"zones: {{crowd: {{x: [1 m, {WIDE - 1:g} m], {ys}}}}}, "
        f"portals: {{a: {{x: [-1 m, 0 m], {ys}}}, b: {{x: [{WIDE:g} m, {WIDE + 1:g} m], {ys}}}}}}}"
    )
    flow = f"{{direction: both, density: {density:g} 1/m^2, area: crowd}}"
    return place, f"{{flow: {flow}, goal_point: {goal}}}"


_POCKET = (
    "[[5 m, 2 m], [8 m, 2 m], [8 m, 6 m], [5 m, 6 m], [5 m, 5.6 m], [7.6 m, 5.6 m], "
    "[7.6 m, 2.4 m], [5 m, 2.4 m]]"
)
_ISLAND = "[[5 m, 2.5 m], [7 m, 2 m], [7.5 m, 5 m], [5.5 m, 5.5 m]]"
#: Pitch and radius of pillars, m.
_GRIDS = ((0.9, 0.15), (1.2, 0.15), (1.6, 0.3), (1.6, 0.5), (2.4, 0.3), (2.4, 0.6))
_DENSITIES = (0.2, 0.5, 1.0, 2.0)


def places() -> dict[str, tuple[str, str]]:
    """The environment and the people of each place, in YAML; `straight`: without routing."""
    found = dict[str, tuple[str, str]]()
    for density in _DENSITIES:
        for pitch, radius in _GRIDS:
            pillars, name = _grid(pitch, radius), f"pillars-{pitch:g}-{radius:g}"
            for flow, streams in (("both", _both(density)), ("crossing", _crossing(density))):
                for ways in ("", "-straight"):
                    people = _people(streams, routing=not ways)
                    found[f"{name}-{flow}-{density:g}{ways}"] = _hall(pillars), people
            for k, ways in enumerate(("[0 deg, 180 deg]", "[0 deg, 90 deg]", "")):
                found[f"{name}-torus{k}-{density:g}"] = _torus(pillars, density, ways)
            middle = _grid(pitch, radius, -0.5 * DEEP)
            for goal in ("ahead", "random"):
                found[f"{name}-{goal}-{density:g}"] = _portals(middle, density, goal)
        flow, straight = (_people(_both(density), routing=ways) for ways in (True, False))
        for name, solid in (
            ("corridor", "border: walls"),
            ("bars", _bars(14, 3)),
            ("pocket", f"blocks: {{u: {{corners: {_POCKET}}}}}"),
            ("island", f"blocks: {{i: {{corners: {_ISLAND}}}}}"),
        ):
            found[f"{name}-{density:g}"] = _hall(solid), flow
            found[f"{name}-{density:g}-straight"] = _hall(solid), straight
    for count in (50, 75, 100):
        for thickness in ("2 cm", "30 cm"):
            found[f"door-{count}-{thickness.replace(' ', '')}"] = _door(count, thickness)
    return found
