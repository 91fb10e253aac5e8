from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from crowdbot.core.geometry.polygon import distance_to, entry_fraction, inside

ZONE = np.array([[45.0, -5.0], [50.0, -5.0], [50.0, 5.0], [45.0, 5.0]])
L_SHAPE = np.array([[0, 0], [4, 0], [4, 2], [2, 2], [2, 4], [0, 4]], float)
STAR = np.array([[0, 3], [0.7, 1], [3, 1], [1, -0.5], [2, -3], [0, -1.2], [-2, -3], [-1, 0]], float)
POLYGONS = {"zone": ZONE, "l": L_SHAPE, "star": STAR}
POINT = st.tuples(st.floats(-4.0, 6.0), st.floats(-4.0, 6.0))


@pytest.mark.parametrize("turned", [ZONE, ZONE[::-1].copy(), np.roll(ZONE, 1, axis=0)])
def test_inside_in_any_orientation(
    turned: np.ndarray[tuple[int, int], np.dtype[np.float64]],
) -> None:
    assert inside(turned, 47.0, 0.0)
    assert not inside(turned, 44.999999, 0.0)
    assert inside(turned, 45.000001, 4.999)
    assert not inside(turned, 47.0, 5.000001)
    assert not inside(turned, 1e9, 0.0)


def test_inside_of_a_polygon_with_a_corner_inwards() -> None:
    assert inside(L_SHAPE, 1.0, 3.0)
    assert inside(L_SHAPE, 3.0, 1.0)
    assert not inside(L_SHAPE, 3.0, 3.0)


def test_a_level_with_a_corner_counts_once() -> None:
    """Rays through corners of the polygon."""
    diamond = np.array([[0.0, -1.0], [1.0, 0.0], [0.0, 1.0], [-1.0, 0.0]])
    assert inside(diamond, 0.0, 0.0)
    assert inside(diamond, -0.5, 0.0)
    assert not inside(diamond, -2.0, 0.0)
    assert not inside(diamond, 2.0, 0.0)
    assert not inside(diamond, -2.0, 1.0)


def test_entry_is_where_the_way_crosses_the_border() -> None:
    assert entry_fraction(ZONE, 44.0, 0.0, 46.0, 0.0) == pytest.approx(0.5)
    assert entry_fraction(ZONE, 44.9, 0.0, 45.1, 0.3) == pytest.approx(0.5)
    assert entry_fraction(ZONE, 44.0, 0.0, 54.0, 0.0) == pytest.approx(0.1)  # right through
    assert entry_fraction(ZONE, 44.0, 4.5, 46.0, 5.5) == pytest.approx(0.5)
    assert entry_fraction(ZONE, 45.0, 0.0, 46.0, 0.0) == pytest.approx(0.0)
    assert entry_fraction(ZONE, 46.0, 0.0, 47.0, 0.0) == 1.0
    assert entry_fraction(ZONE, 46.0, 0.0, 46.0, 0.0) == 1.0


@pytest.mark.parametrize("name", list(POLYGONS))
@given(a=POINT, b=POINT)
@settings(max_examples=100)
def test_entry_matches_sampling(name: str, a: tuple[float, float], b: tuple[float, float]) -> None:
    zone = POLYGONS[name] - (np.array([42.0, 0.0]) if name == "zone" else 0.0)
    assume(not inside(zone, *a) and math.dist(a, b) > 0.01)
    s = np.linspace(0.0, 1.0, 2001)
    within = [inside(zone, a[0] + f * (b[0] - a[0]), a[1] + f * (b[1] - a[1])) for f in s]
    if not any(within):
        return
    first = float(s[int(np.argmax(within))])
    fraction = entry_fraction(zone, *a, *b)
    assert fraction <= first + 1e-9
    x, y = a[0] + fraction * (b[0] - a[0]), a[1] + fraction * (b[1] - a[1])
    assert distance_to(zone, x, y) < 1e-6


@pytest.mark.slow
@pytest.mark.parametrize("name", list(POLYGONS))
@given(p=POINT)
@settings(max_examples=100)
def test_distance_matches_sampling(name: str, p: tuple[float, float]) -> None:
    zone = POLYGONS[name] - (np.array([42.0, 0.0]) if name == "zone" else 0.0)
    found = distance_to(zone, *p)
    if inside(zone, *p):
        assert found == 0.0
        return
    s = np.linspace(0.0, 1.0, 1001)[:, np.newaxis]
    border = np.concatenate(
        [q + s * (r - q) for q, r in zip(zone, np.roll(zone, -1, 0), strict=True)]
    )
    sampled = float(np.min(np.hypot(*(border - p).T)))
    assert sampled - 0.011 <= found <= sampled + 1e-9
