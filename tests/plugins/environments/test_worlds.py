"""Worlds: what their parameters promise, measured in the arrays that everybody reads."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
import shapely  # type: ignore[import-untyped,unused-ignore]
from pydantic import ValidationError

from crowdbot.plugin import EnvironmentParts, EnvironmentSpec
from crowdbot.plugins.environments.corridor import CorridorSpec
from crowdbot.plugins.environments.place_build import build
from crowdbot.plugins.environments.walkways import WalkwaySpec
from tests.built_in import built_in

SPECS = {component.kind: component.spec for component in built_in("environment")}


def _spec(kind: str, **fields: Any) -> EnvironmentSpec:
    found = SPECS[kind].model_validate(fields)
    assert isinstance(found, EnvironmentSpec)
    return found


def _parts(kind: str, **fields: Any) -> EnvironmentParts:
    return build(_spec(kind, **fields))


def _floor(parts: EnvironmentParts) -> Any:
    """The one polygon that walls enclose, solids taken out."""
    lines = shapely.linestrings(parts.walls[parts.stops_robot].reshape(-1, 2, 2))
    rings = shapely.get_parts(shapely.polygonize(shapely.get_parts(shapely.union_all(lines))))
    solids = shapely.union_all([shapely.Polygon(s) for s in parts.solids])
    return shapely.difference(shapely.union_all(rings), solids)


@pytest.mark.parametrize("component", built_in("environment"), ids=lambda c: c.kind)
def test_their_places_lie_on_their_floor(component: Any) -> None:
    for example in component.examples:
        spec = component.spec.model_validate(example)
        parts = build(spec)
        if not isinstance(spec, WalkwaySpec):
            continue
        floor = _floor(parts)
        assert floor.geom_type == "Polygon"
        for zone in parts.zones.values():
            centre = shapely.Point(zone.mean(axis=0))
            assert floor.buffer(1e-9).contains(centre)
        for x0, x1, y0, y1 in parts.portals.values():
            portal = shapely.box(x0, y0, x1, y1)
            assert portal.intersection(floor).area < 1e-9
            assert portal.intersection(floor).length > 0.5  # a common side


def test_crossing_corridors() -> None:
    square = _floor(_parts("crossing_corridor", width=4, cross_width=6, length=20, cross_length=30))
    assert square.area == pytest.approx(20 * 4 + 30 * 6 - 4 * 6)
    slanted = _floor(_parts("crossing_corridor", width=4, cross_width=6, angle="60 deg"))
    crossing = 4 * 6 / math.sin(math.pi / 3)
    assert slanted.area == pytest.approx(30 * 4 + 30 * 6 - crossing, rel=1e-6)
    rounded = _floor(_parts("crossing_corridor", corner_radius=1.0))
    plain = _floor(_parts("crossing_corridor"))
    assert rounded.area - plain.area == pytest.approx(4 * (1 - math.pi / 4), rel=0.03)
    assert rounded.buffer(1e-9).contains(plain)


@pytest.mark.parametrize("angle", [30, 60, 90, 120, 150])
def test_corners_keep_their_width(angle: int) -> None:
    floor = _floor(_parts("corner", width=2.0, angle=f"{angle} deg", length=12, beyond=12))
    # Both parts by their middle lines; what the turn adds outside, it lacks inside.
    assert floor.area == pytest.approx(2.0 * 24.0, rel=1e-6)


def test_a_t_junction() -> None:
    floor = _floor(_parts("t_junction", length=20, width=4, stem_length=10, stem_width=3))
    assert floor.area == pytest.approx(80 + 30)


@pytest.mark.parametrize("kind", ["doorway", "bottleneck"])
def test_a_way_is_as_wide_as_it_says(kind: str) -> None:
    parts = _parts(kind, opening=1.3, offset=0.5)
    ray = shapely.LineString([(0.0, -9.0), (0.0, 9.0)])
    free = _floor(parts).intersection(ray)
    assert free.length == pytest.approx(1.3)
    assert free.centroid.y == pytest.approx(0.5)


def test_a_funnel() -> None:
    plain, cut = _floor(_parts("bottleneck")), _floor(_parts("bottleneck", funnel=1.0))
    assert cut.area - plain.area == pytest.approx(2 * 0.5)
    assert cut.bounds == plain.bounds


def test_kerbs_stop_wheels_and_nobody_else() -> None:
    parts = _parts("street", length=20, roadway=6, crossings={"a": {"at": 2.0, "width": 4.0}})
    assert parts.solid_heights.tolist() == [[0.0, 0.12]] * 4
    assert not np.any(parts.solids_stop_crowd)
    kerbs = shapely.union_all([shapely.Polygon(s) for s in parts.solids])
    assert kerbs.area == pytest.approx(2 * (20 - 4) * 0.15)
    assert not kerbs.intersects(shapely.box(0.0, -9.0, 4.0, 9.0).buffer(-1e-6))
    walls, _, solids = parts.in_the_way(1.7)
    assert len(solids) == 0
    assert np.abs(walls[:, [1, 3]]).min() == pytest.approx(6.0)  # façades
    assert len(_parts("street", kerbs="flush").solids) == 0


def test_furniture_of_a_street() -> None:
    items = ("bench", "bin", "bollard", "lamp", "planter", "stall", "tree")
    furniture = {
        item: {"item": item, "x": -9.0 + 3 * k, "y": 4.5, "heading": "30 deg"}
        for k, item in enumerate(items)
    }
    parts = _parts("street", kerbs="flush", furniture=furniture)
    areas = sorted(float(shapely.Polygon(s).area) for s in parts.solids)
    assert areas == pytest.approx(sorted([1.8 * 0.5, 1.2 * 0.6, 2.5 * 1.5]))
    assert sorted(parts.pillars[:, 2].tolist()) == pytest.approx([0.1, 0.1, 0.2, 0.25])


def test_gates_and_low_walls_of_a_shed() -> None:
    parts = _parts("shed")
    assert sorted(map(tuple, parts.solid_heights.tolist())) == [(0.0, 0.3)] * 2 + [(0.3, 1.1)] * 2
    gate = {"boom": {"start": [0, 0], "end": [0, 3], "height": 2.0}}
    parts = _parts("shed", gates=gate, low_walls={})
    assert parts.solid_heights.tolist() == [[0.0, 2.0]]


@pytest.mark.parametrize("seed", range(5))
def test_random_pillars_keep_their_gaps(seed: int) -> None:
    field = {"count": 15, "seed": seed, "radius": 0.2, "largest_radius": 0.5, "gap": 1.0}
    pillars = _parts("corridor", length=30, width=10, pillar_field=field).pillars
    assert len(pillars) == 15
    assert np.all((pillars[:, 2] >= 0.2) & (pillars[:, 2] <= 0.5))
    away = np.hypot(*(pillars[:, None, :2] - pillars[None, :, :2]).transpose(2, 0, 1))
    gap = away - pillars[:, None, 2] - pillars[None, :, 2] + 99.0 * np.eye(15)
    assert gap.min() >= 1.0
    assert np.min(5.0 - np.abs(pillars[:, 1]) - pillars[:, 2]) >= 1.0
    again = _parts("corridor", length=30, width=10, pillar_field=field).pillars
    assert np.array_equal(pillars, again)
    other = _parts("corridor", length=30, width=10, pillar_field=field | {"seed": seed + 9})
    assert not np.array_equal(pillars, other.pillars)


def test_a_grid_of_pillars() -> None:
    grid = {"columns": 4, "rows": 1, "radius": 0.25, "area": {"x": [10, 20], "y": [-1, 1]}}
    parts = _parts("corridor", pillar_grid=grid)
    assert parts.pillars.tolist() == [[12, 0, 0.25], [14, 0, 0.25], [16, 0, 0.25], [18, 0, 0.25]]


def test_a_corridor_without_pillars_says_nothing_of_them() -> None:
    words = CorridorSpec().model_dump(mode="json")
    assert set(words) == {"kind", "zones", "portals", "length", "width", "wall_height"}


@pytest.mark.parametrize(
    ("kind", "fields", "message"),
    [
        ("crossing_corridor", {"length": 3.0}, "longer than the crossing"),
        ("crossing_corridor", {"corner_radius": 20.0}, "too large for the arms"),
        ("crossing_corridor", {"angle": "10 deg"}, "greater than or equal"),
        ("corner", {"length": 0.5}, "longer than the turn"),
        ("corner", {"corner_radius": 30.0}, "too large for the turn"),
        ("t_junction", {"stem_width": 30.0}, "must be smaller than length"),
        ("doorway", {"opening": 9.0}, "within the width"),
        ("doorway", {"opening": 1.0, "offset": 3.8}, "within the width"),
        ("bottleneck", {"funnel": 4.0, "width": 20}, "funnel must be smaller"),
        ("shed", {"blocks": {"b": {"corners": [[0, 0], [99, 0], [0, 1]]}}}, "leaves the floor"),
        ("shed", {"gates": {"g": {"start": [0, 0], "end": [0, 50]}}}, "'g' leaves the floor"),
        ("shed", {"openings": {"o": {"side": "west", "at": 12.0}}}, "does not fit into the west"),
        ("plaza", {"pillar_field": {"count": 900}}, r"only \d+ of 900 pillars fit"),
        ("corridor", {"pillars": {"p": {"x": 60, "y": 0, "radius": 1}}}, "leaves the corridor"),
        ("street", {"doors": {"d": {"side": "east", "at": 0.0}}}, "south or north"),
        ("street", {"doors": {"west": {"side": "north", "at": 0.0}}}, "called 'west'"),
        ("street", {"furniture": {"f": {"item": "bin", "x": 0, "y": 9}}}, "leaves the street"),
    ],
)
def test_what_does_not_fit_is_refused(kind: str, fields: dict[str, Any], message: str) -> None:
    with pytest.raises(ValidationError, match=message):
        _spec(kind, **fields)


def test_openings_beside_each_other() -> None:
    openings = {
        "a": {"side": "south", "at": -3.0, "width": 2.0},
        "b": {"side": "south", "at": 3.0, "width": 2.0},
        "c": {"side": "north", "at": 3.0, "width": 2.0},
    }
    parts = _parts("plaza", openings=openings, fountain=0.0)
    only_robot = parts.walls[~parts.stops_crowd]
    assert sorted(np.abs(only_robot[:, 2] - only_robot[:, 0])) == pytest.approx([2.0] * 3)
    assert _floor(parts).area == pytest.approx(600.0)
    with pytest.raises(ValidationError, match="opening 'b' does not fit"):
        _parts("plaza", openings=openings | {"b": {"side": "south", "at": -2.0}})
