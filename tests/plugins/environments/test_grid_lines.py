"""Lines along the cells of a grid: no cell changes sides, thin walls stand, outlines are valid."""

from __future__ import annotations

import math

import numpy as np
import pytest
import shapely  # type: ignore[import-untyped,unused-ignore]
from numpy.typing import NDArray
from scipy import ndimage

from crowdbot.plugins.environments.floor_plan_grid_build import floor_polygons

Cells = NDArray[np.bool_]


def _floor(free: Cells, tolerance: float) -> tuple[list[shapely.Polygon], Cells]:
    """Return the polygons and the cells whose centres they contain."""
    polygons = floor_polygons(free, tolerance, lambda p: p)
    assert all(p.is_valid for p in polygons)
    whole = shapely.union_all(polygons)
    y, x = np.mgrid[: free.shape[0], : free.shape[1]]
    return polygons, shapely.contains_xy(whole, x + 0.5, y + 0.5)


def _noise(seed: int) -> Cells:
    rng = np.random.default_rng(seed)
    values = rng.random((40, 60))
    smooth = ndimage.gaussian_filter(values, (0.0, 0.7, 1.5, 4.0)[seed % 4])
    return np.asarray(smooth > np.quantile(smooth, rng.uniform(0.1, 0.9)))


@pytest.mark.parametrize("tolerance", [0.0, 0.1, 0.3, 0.5])
@pytest.mark.parametrize("seed", range(8))
def test_no_centre_of_a_cell_changes_sides(seed: int, tolerance: float) -> None:
    free = _noise(seed)
    polygons, found = _floor(free, tolerance)
    np.testing.assert_array_equal(found, free)
    assert len(polygons) == ndimage.label(free)[1]  # diagonal gaps are closed
    touching = shapely.union_all(polygons).area - sum(p.area for p in polygons)
    assert touching == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("seed", range(4))
def test_lines_stay_within_the_tolerance(seed: int) -> None:
    free = _noise(seed)
    exact = shapely.union_all(
        [shapely.box(i, j, i + 1, j + 1) for j, i in zip(*np.nonzero(free), strict=True)]
    )
    for tolerance in (0.2, 0.5):
        polygons, _ = _floor(free, tolerance)
        lines = shapely.segmentize(shapely.union_all([p.boundary for p in polygons]), 0.1)
        points = shapely.points(shapely.get_coordinates(lines))
        assert shapely.distance(points, exact.boundary).max() <= tolerance + 1e-9


@pytest.mark.parametrize("angle", [0, 3, 4, 7, 14, 30, 45, 58, 90])
def test_a_wall_of_one_cell_stands_at_any_angle(angle: int) -> None:
    """Drawn as a line from cell to cell, along which no one gets from one side to the other."""
    free = np.ones((100, 100), np.bool_)
    steps = np.arange(81)
    c, s = math.cos(math.radians(angle)), math.sin(math.radians(angle))
    scale = max(abs(c), abs(s))
    free[
        np.rint(10 + steps * s / scale).astype(int), np.rint(10 + steps * c / scale).astype(int)
    ] = 0
    polygons, _ = _floor(free, 0.5)
    (polygon,) = polygons
    (wall,) = [shapely.Polygon(hole) for hole in polygon.interiors]
    assert wall.area == pytest.approx(81, rel=0.15)
    assert len(wall.exterior.coords) < 40
    assert not wall.buffer(-0.01).is_empty
    assert len(shapely.get_parts(wall.buffer(-0.01))) == 1


def test_rectangles_keep_their_corners() -> None:
    free = np.ones((20, 30), np.bool_)
    free[3:5, 4:9], free[10, 10], free[12:18, 20] = False, False, False
    (polygon,) = _floor(free, 0.5)[0]
    assert polygon.exterior.bounds == (0, 0, 30, 20)
    areas = sorted(shapely.Polygon(hole).area for hole in polygon.interiors)
    assert areas == [1.0, 6.0, 10.0]
    assert shapely.get_num_coordinates(polygon) == 4 * 5


def test_a_turned_room_has_few_corners() -> None:
    y, x = np.mgrid[:300, :300] - 150.0
    c, s = math.cos(0.3), math.sin(0.3)
    u, v = c * x + s * y, -s * x + c * y
    (polygon,) = _floor((np.abs(u) < 100) & (np.abs(v) < 60), 0.5)[0]
    assert len(polygon.exterior.coords) < 30
    assert polygon.area == pytest.approx(200 * 120, rel=0.01)
