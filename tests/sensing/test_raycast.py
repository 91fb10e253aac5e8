"""Ray casting against analytic scenes and an independent numpy reference."""

import math
import time

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import ArrayLike, NDArray

from crowdbot.core.sensing.scene import Scene

Array = NDArray[np.float64]
NO_WALLS = np.empty((0, 4))


def scene_of(
    people: ArrayLike, walls: ArrayLike = NO_WALLS, height: float = 1.7, r: float = 0.33
) -> Scene:
    where = np.reshape(np.asarray(people, dtype=np.float64), (-1, 2))
    xyv = np.column_stack([where, np.zeros_like(where)])
    scene = Scene(walls, [0.0, 2.5], np.full(len(xyv), r), height)
    scene.update(None, xyv, np.ones(len(xyv), dtype=np.bool_))
    return scene


def one(
    scene: Scene, origin: object, direction: object, reach: float = 100.0
) -> tuple[float, float, int]:
    d, a, b = scene.cast(np.array([origin], float), np.array([direction], float), reach)
    return float(d[0]), float(a[0]), int(b[0])


# ------------------------------------------------------------------------- reference
def reference(scene: Scene, o: Array, d: Array, reach: float) -> tuple[float, float, int]:
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
    for i in np.flatnonzero(scene.present):
        c, r, h = scene.people[i, :2], scene.people_radius[i], scene.people_height[i]
        if np.hypot(*(o[:2] - c)) <= r and 0.0 <= o[2] <= h:
            hits.append((0.0, 0.0, int(i)))
            continue
        q = o[:2] - c
        poly = [d[:2] @ d[:2], 2.0 * q @ d[:2], q @ q - r * r]
        for root in np.roots(poly) if poly[0] > 0.0 else []:
            p = o + root.real * d
            if abs(root.imag) < 1e-12 and root.real >= 0.0 and 0.0 <= p[2] <= h:
                cosine = abs(float((p[:2] - c) @ d[:2])) / r
                hits.append((float(root.real), math.acos(min(1.0, cosine)), int(i)))
        for plane in (0.0, h):
            t = (plane - o[2]) / d[2] if d[2] != 0.0 else -1.0
            if t >= 0.0 and np.hypot(*(o + t * d - np.append(c, 0.0))[:2]) <= r:
                hits.append((float(t), math.acos(min(1.0, abs(d[2]))), int(i)))
    hits = [h for h in hits if h[0] <= reach]
    return min(hits) if hits else (math.inf, 0.0, -1)


@settings(max_examples=150, deadline=None)
@given(st.integers(0, 2**32 - 1), st.booleans())
def test_equals_brute_force(seed: int, flat: bool) -> None:
    rng = np.random.default_rng(seed)
    people, walls = rng.integers(0, 12), rng.integers(0, 6)
    heights = np.sort(rng.uniform(0.0, 2.5, (walls, 2)), axis=1)
    scene = Scene(
        rng.uniform(-8, 8, (walls, 4)),
        heights,
        rng.uniform(0.1, 0.8, people),
        rng.uniform(0.5, 2.0, people),
    )
    xyv = np.column_stack([rng.uniform(-8, 8, (people, 2)), np.zeros((people, 2))])
    scene.update(None, xyv, rng.random(people) < 0.8)
    rays = 24
    origins = np.repeat(rng.uniform(-4, 4, (rays // 4, 3)), 4, axis=0)
    origins[:, 2] = rng.uniform(0.1, 2.5, rays)
    directions = rng.normal(size=(rays, 3))
    if flat:
        directions[:, 2] = 0.0
    distance, incidence, body = scene.cast(origins, directions, 9.0)
    for k in range(rays):
        d, a, b = reference(scene, origins[k], directions[k], 9.0)
        assert distance[k] == pytest.approx(d, abs=1e-8)
        assert body[k] == b
        assert incidence[k] == pytest.approx(a, abs=1e-4)  # acos is blunt at 0


@settings(max_examples=60, deadline=None)
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
    assert one(scene_of([(5.0, 0.0)]), (0, 0, 0.25), (1, 0, 0)) == pytest.approx((4.67, 0.0, 0))


def test_grazing_and_just_beside() -> None:
    r = 0.33
    near = scene_of([(5.0, r - 1e-9)])
    d, a, b = one(near, (0, 0, 0.25), (1, 0, 0))
    assert d == pytest.approx(5.0, abs=1e-3)
    assert b == 0
    assert a == pytest.approx(math.pi / 2, abs=1e-3)
    assert one(scene_of([(5.0, r + 1e-9)]), (0, 0, 0.25), (1, 0, 0))[2] == -1


def test_incidence_on_a_wall() -> None:
    scene = scene_of([], [[3.0, -9.0, 3.0, 9.0]])
    for angle in (0.0, 0.3, -1.2):
        ray = (math.cos(angle), math.sin(angle), 0.0)
        d, a, b = one(scene, (0, 0, 0.25), ray)
        assert (d, a, b) == pytest.approx((3.0 / math.cos(angle), abs(angle), -2), abs=1e-7)


def test_heights_count() -> None:
    low = scene_of([(5.0, 0.0)], [[8.0, -1.0, 8.0, 1.0]], height=1.0)
    assert one(low, (0, 0, 1.5), (1, 0, 0))[2] == -2  # over the head, onto the wall
    assert one(low, (0, 0, 3.0), (1, 0, 0))[2] == -1  # over both
    assert one(low, (0, 0, 0.25), (1, 0, 0))[2] == 0
    assert one(low, (0, 0, -0.1), (1, 0, 0))[2] == -1  # below the floor


def test_top_of_a_head() -> None:
    assert one(scene_of([(5.0, 0.0)]), (5.1, 0.0, 3.0), (0, 0, -1)) == pytest.approx((1.3, 0.0, 0))


def test_inside_is_distance_zero() -> None:
    scene = scene_of([(0.2, 0.0)])
    for direction in ((1, 0, 0), (-1, 0, 0), (0.3, -2, 0.1)):
        assert one(scene, (0, 0, 0.25), direction) == (0.0, 0.0, 0)


def test_nearest_of_wall_and_person() -> None:
    scene = scene_of([(5.0, 0.0), (3.0, 0.0)], [[4.0, -1.0, 4.0, 1.0], [2.0, 3.0, 2.0, 5.0]])
    assert one(scene, (0, 0, 0.2), (1, 0, 0))[2] == 1
    assert one(scene, (3.5, 0, 0.2), (1, 0, 0))[2] == -2
    assert one(scene, (0, 4, 0.2), (1, 0, 0))[2] == -3


def test_no_gap_in_the_corner_of_walls() -> None:
    scene = scene_of([], [[0.1, 0.7, 3.3, 0.7], [3.3, 0.7, 3.3, -2.9]])
    for x in np.linspace(-2.0, 2.0, 41):
        for y in np.linspace(-2.0, 0.5, 41):
            assert one(scene, (x, y, 0.2), (3.3 - x, 0.7 - y, 0.0))[2] != -1


def test_range_presence_and_length_of_direction() -> None:
    scene = scene_of([(5.0, 0.0)])
    assert one(scene, (0, 0, 0.2), (1, 0, 0), 4.66) == (math.inf, 0.0, -1)
    assert one(scene, (0, 0, 0.2), (7, 0, 0), 4.68)[0] == pytest.approx(4.67)
    scene.update(None, scene.people, np.zeros(1, dtype=np.bool_))
    assert one(scene, (0, 0, 0.2), (1, 0, 0))[2] == -1


def test_empty_scene() -> None:
    assert one(scene_of([]), (0, 0, 0), (1, 0, 0)) == (math.inf, 0.0, -1)


# ----------------------------------------------------------------------------- scene
def test_update_keeps_views_and_protects_them() -> None:
    buffer = np.zeros((2, 6))
    people, present = buffer[:, 1:5], np.array([True, False])
    people[0, :2] = (5.0, 0.0)
    scene = Scene(NO_WALLS, [0.0, 1.0], [0.33, 0.33], 1.7)
    scene.update(None, people, present)
    assert one(scene, (0, 0, 0.2), (1, 0, 0))[0] == pytest.approx(4.67)
    people[0, 0], people[1, 0], present[1] = 4.0, 2.0, True  # in place, no second update
    assert one(scene, (0, 0, 0.2), (1, 0, 0))[::2] == pytest.approx((1.67, 1))
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


def test_many_people_cost_little() -> None:
    """Far above the 150 us it should take, so that a busy machine does not fail it."""
    rng = np.random.default_rng(1)
    scene = scene_of(rng.uniform((0, -5), (20, 5), (200, 2)))
    angle = np.radians(np.arange(480) / 2 - 120)
    rays = np.column_stack([np.cos(angle), np.sin(angle), np.zeros(480)])
    origins = np.tile([10.0, 0.0, 0.25], (480, 1))
    scene.cast(origins, rays, 10.0)
    best = math.inf
    for _ in range(50):
        start = time.perf_counter()
        scene.cast(origins, rays, 10.0)
        best = min(best, time.perf_counter() - start)
    assert best < 1.5e-3
