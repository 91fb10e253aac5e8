"""Ray casting against analytic scenes and an independent numpy reference."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import ArrayLike, NDArray

from crowdbot.core.sensing.scene import Scene
from tests.core.sensing.sensing_worlds import (
    NO_WALLS,
    Array,
    crowd_of,
    cylinders,
    scene_of,
    walls_of,
)
from tests.examples import costly

R = 0.33  # of the pillars of this page


def posts(where: ArrayLike, walls: ArrayLike = NO_WALLS, height: float = 1.7) -> Scene:
    """Pillars (P, 2) of radius `R`; pillar i is the body ``post(i, scene)``."""
    centres = np.reshape(np.asarray(where, np.float64), (-1, 2))
    round_ones = np.column_stack([centres, np.full(len(centres), R)])
    return scene_of(walls=walls, pillars=round_ones, pillar_heights=(0.0, height))


def post(i: int, scene: Scene) -> int:
    """Body number of a pillar."""
    return -(2 + len(scene.walls) + i)


def one(
    scene: Scene, origin: object, direction: object, reach: float = 100.0
) -> tuple[float, float, int]:
    d, a, b = scene.cast(np.array([origin], float), np.array([direction], float), reach)
    return float(d[0]), float(a[0]), int(b[0])


# ------------------------------------------------------------------------- reference
Cylinder = tuple[float, float, float, float, float, int]


def reference(
    scene: Scene, solids: list[Cylinder], o: Array, d: Array, reach: float
) -> tuple[float, float, int]:
    """By another road than the kernel: implicit surfaces as polynomials in t, all hits listed."""
    d = d / np.linalg.norm(d)
    hits: list[tuple[float, float, int]] = []
    for k, (wall, (low, high)) in enumerate(zip(scene.walls, scene.wall_heights, strict=True)):
        a, b = np.append(wall[:2], 0.0), np.append(wall[2:], 0.0)
        normal = np.cross(b - a, [0.0, 0.0, 1.0])
        normal /= np.linalg.norm(normal)
        slope = float(normal @ d)
        if slope == 0.0:
            continue
        t = float(normal @ (a - o)) / slope
        p = o + t * d
        s = float((p - a)[:2] @ (b - a)[:2]) / float((b - a) @ (b - a))
        if t >= 0.0 and 0.0 <= s <= 1.0 and low <= p[2] <= high:
            hits.append((t, math.acos(min(1.0, abs(slope))), -(2 + k)))
    for x, y, r, bottom, top, i in solids:
        c = np.array([x, y])
        if np.hypot(*(o[:2] - c)) <= r and bottom <= o[2] <= top:
            hits.append((0.0, 0.0, i))
            continue
        q = o[:2] - c
        poly = [d[:2] @ d[:2], 2.0 * q @ d[:2], q @ q - r * r]
        for root in np.roots(poly) if poly[0] > 0.0 else []:
            p = o + root.real * d
            if abs(root.imag) < 1e-12 and root.real >= 0.0 and bottom <= p[2] <= top:
                cosine = abs(float((p[:2] - c) @ d[:2])) / r
                hits.append((float(root.real), math.acos(min(1.0, cosine)), i))
        for plane in (bottom, top):
            t = (plane - o[2]) / d[2] if d[2] != 0.0 else -1.0
            if t >= 0.0 and np.hypot(*(o + t * d - np.append(c, 0.0))[:2]) <= r:
                hits.append((float(t), math.acos(min(1.0, abs(d[2]))), i))
    hits = [h for h in hits if h[0] <= reach]
    return min(hits) if hits else (math.inf, 0.0, -1)


@pytest.mark.slow
@costly(150)
@given(st.integers(0, 2**32 - 1), st.booleans())
def test_equals_brute_force(seed: int, flat: bool) -> None:
    rng = np.random.default_rng(seed)
    count = int(rng.integers(0, 12))
    walls, heights = walls_of(rng, int(rng.integers(0, 6)))
    pillar = rng.uniform((-8, -8, 0.1), (8, 8, 0.8))
    scene = Scene(walls, heights, np.full(count, 0.4), 1.6, [pillar], (0.2, 1.9))
    xyv, direction, walked = crowd_of(seed, count)
    present = rng.random(count) < 0.8
    scene.update(None, xyv, present, direction, walked)
    solids = [c for c in cylinders(xyv, direction, walked, 1.6, 0.4) if present[c[-1]]]
    solids.append((*pillar.tolist(), 0.2, 1.9, -2 - len(walls)))
    rays = 24
    origins = np.repeat(rng.uniform(-4, 4, (rays // 4, 3)), 4, axis=0)
    origins[:, 2] = rng.uniform(0.1, 2.5, rays)
    directions = rng.normal(size=(rays, 3))
    if flat:
        directions[:, 2] = 0.0
    distance, incidence, body = scene.cast(origins, directions, 9.0)
    expected = [reference(scene, solids, origins[k], directions[k], 9.0) for k in range(rays)]
    d, a, b = zip(*expected, strict=True)
    np.testing.assert_allclose(distance, d, rtol=1e-6, atol=1e-8)
    np.testing.assert_array_equal(body, b)
    np.testing.assert_allclose(incidence, a, rtol=1e-6, atol=1e-4)  # acos is blunt at 0


@costly(60)
@given(st.integers(0, 2**32 - 1))
def test_permutation_of_people_changes_no_scan(seed: int) -> None:
    rng = np.random.default_rng(seed)
    count = int(rng.integers(2, 60))
    people = rng.uniform(-6, 6, (count, 2))
    order = rng.permutation(count)
    angle = np.linspace(-np.pi, np.pi, 91)
    rays = np.column_stack([np.cos(angle), np.sin(angle), np.zeros(91)])
    origins = np.tile([0.0, 0.0, 0.25], (91, 1))
    d1, a1, b1 = scene_of(people).cast(origins, rays, 10.0)
    d2, a2, b2 = scene_of(people[order]).cast(origins, rays, 10.0)
    inside = d1 == 0.0  # several bodies may hold the sensor: the nearest centre is named
    np.testing.assert_array_equal(d1, d2)
    np.testing.assert_array_equal(a1, a2)
    hit = (b1 >= 0) & ~inside
    np.testing.assert_array_equal(b1[hit], order[b2[hit]])


# -------------------------------------------------------------------------- analytic
def test_head_on() -> None:
    assert one(posts([(5.0, 0.0)]), (0, 0, 0.25), (1, 0, 0)) == pytest.approx((4.67, 0.0, -2))


def test_somebody_who_walks_towards_the_sensor() -> None:
    """Between the legs the ray passes; at their sides it meets them, higher up the trunk."""
    scene, apart = scene_of([(5.0, 0.0)], facing=math.pi), 0.5 * 0.9 * 0.191 * 1.7
    for y in (apart, -apart):
        assert one(scene, (0, y, 0.25), (1, 0, 0)) == pytest.approx((4.93, 0.0, 0))
    assert one(scene, (0, 0, 0.25), (1, 0, 0))[2] == -1
    trunk = 5.0 - 0.5 * 0.259 * 1.7
    assert one(scene, (0, 0, 1.2), (1, 0, 0)) == pytest.approx((trunk, 0.0, 0))
    assert one(scene, (0, 0, 1.75), (1, 0, 0))[2] == -1


def test_grazing_and_just_beside() -> None:
    near = posts([(5.0, R - 1e-9)])
    d, a, b = one(near, (0, 0, 0.25), (1, 0, 0))
    assert d == pytest.approx(5.0, abs=1e-3)
    assert b == -2
    assert a == pytest.approx(math.pi / 2, abs=1e-3)
    assert one(posts([(5.0, R + 1e-9)]), (0, 0, 0.25), (1, 0, 0))[2] == -1


def test_incidence_on_a_wall() -> None:
    scene = posts([], [[3.0, -9.0, 3.0, 9.0]])
    for angle in (0.0, 0.3, -1.2):
        ray = (math.cos(angle), math.sin(angle), 0.0)
        d, a, b = one(scene, (0, 0, 0.25), ray)
        assert (d, a, b) == pytest.approx((3.0 / math.cos(angle), abs(angle), -2), abs=1e-7)


def test_heights_count() -> None:
    low = posts([(5.0, 0.0)], [[8.0, -1.0, 8.0, 1.0]], height=1.0)
    assert one(low, (0, 0, 1.5), (1, 0, 0))[2] == -2  # over the head, onto the wall
    assert one(low, (0, 0, 3.0), (1, 0, 0))[2] == -1  # over both
    assert one(low, (0, 0, 0.25), (1, 0, 0))[2] == post(0, low)
    assert one(low, (0, 0, -0.1), (1, 0, 0))[2] == -1  # below the floor


def test_top_of_a_head() -> None:
    assert one(scene_of([(5.0, 0.0)]), (5.1, 0.0, 3.0), (0, 0, -1)) == pytest.approx((1.3, 0.0, 0))


def test_inside_is_distance_zero() -> None:
    scene = posts([(0.2, 0.0)])
    for direction in ((1, 0, 0), (-1, 0, 0), (0.3, -2, 0.1)):
        assert one(scene, (0, 0, 0.25), direction) == (0.0, 0.0, -2)


def test_nearest_of_wall_and_person() -> None:
    scene = posts([(5.0, 0.0), (3.0, 0.0)], [[4.0, -1.0, 4.0, 1.0], [2.0, 3.0, 2.0, 5.0]])
    assert one(scene, (0, 0, 0.2), (1, 0, 0))[2] == post(1, scene)
    assert one(scene, (3.5, 0, 0.2), (1, 0, 0))[2] == -2
    assert one(scene, (0, 4, 0.2), (1, 0, 0))[2] == -3


def test_no_gap_in_the_corner_of_walls() -> None:
    scene = posts([], [[0.1, 0.7, 3.3, 0.7], [3.3, 0.7, 3.3, -2.9]])
    for x in np.linspace(-2.0, 2.0, 41):
        for y in np.linspace(-2.0, 0.5, 41):
            assert one(scene, (x, y, 0.2), (3.3 - x, 0.7 - y, 0.0))[2] != -1


def test_range_presence_and_length_of_direction() -> None:
    scene = posts([(5.0, 0.0)])
    assert one(scene, (0, 0, 0.2), (1, 0, 0), 4.66) == (math.inf, 0.0, -1)
    assert one(scene, (0, 0, 0.2), (7, 0, 0), 4.68)[0] == pytest.approx(4.67)
    scene = scene_of([(5.0, 0.0)])
    assert one(scene, (0, 0, 1.2), (1, 0, 0))[2] == 0
    scene.update(None, scene.people, np.zeros(1, dtype=np.bool_))
    assert one(scene, (0, 0, 1.2), (1, 0, 0))[2] == -1


def test_empty_scene() -> None:
    assert one(posts([]), (0, 0, 0), (1, 0, 0)) == (math.inf, 0.0, -1)


# ----------------------------------------------------------------------------- scene
def test_update_keeps_views_and_protects_them() -> None:
    buffer = np.zeros((2, 6))
    people, present = buffer[:, 1:5], np.array([True, False])
    people[0, :2] = (5.0, 0.0)
    scene = Scene(NO_WALLS, [0.0, 1.0], [0.33, 0.33], 1.7)
    trunk = 0.5 * 0.259 * 1.7
    scene.update(None, people, present)
    people[0, 0], people[1, 0], present[1] = 4.0, 2.0, True  # in place, before the first look
    assert one(scene, (0, 0, 1.2), (1, 0, 0))[::2] == pytest.approx((2.0 - trunk, 1))
    people[1, 0] = 3.0  # after it
    assert one(scene, (0, 0, 1.2), (1, 0, 0))[0] == pytest.approx(2.0 - trunk)
    scene.update(None, people, present)
    assert one(scene, (0, 0, 1.2), (1, 0, 0))[0] == pytest.approx(3.0 - trunk)
    with pytest.raises(ValueError, match="read-only"):
        scene.people[0, 0] = 1.0


@pytest.mark.parametrize(
    ("people", "present"),
    [
        (np.zeros((3, 4)), np.ones(2, dtype=np.bool_)),
        (np.zeros((2, 4)), np.ones(3, dtype=np.bool_)),
        (np.zeros((2, 4), dtype=np.float32), np.ones(2, dtype=np.bool_)),
        (np.zeros((2, 4)), np.ones(2)),
    ],
)
def test_update_checks_shapes(people: Array, present: NDArray[np.bool_]) -> None:
    with pytest.raises(ValueError, match="must be"):
        Scene(NO_WALLS, [0.0, 1.0], [0.3, 0.3], 1.7).update(None, people, present)
