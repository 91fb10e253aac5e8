"""The pieces of DWA, each against something known."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import ArrayLike, NDArray

import crowdbot.plugins.planners.dwa.parameters_build as entries
import crowdbot.plugins.planners.dwa.rollouts_build as rollout
import crowdbot.plugins.planners.dwa.window_build as window
from crowdbot.plugins.planners.dwa.cost_build import evaluate
from crowdbot.plugins.planners.dwa.direction_build import choose_direction, free_time
from crowdbot.plugins.planners.shared.local_map_build import remembered, way_out
from crowdbot.plugins.planners.shared.points_build import (
    apart,
    apparent_velocity,
    minimum,
    nearest_per_sector,
)

Array = NDArray[np.float64]
NOTHING = np.empty((0, 2))


def points(*where: tuple[float, float]) -> Array:
    return np.array(where, dtype=np.float64).reshape(-1, 2)


# ---------------------------------------------------------------------------- points
@given(st.integers(0, 2**32 - 1))
def test_thinning_keeps_the_nearest_of_each_sector(seed: int) -> None:
    rng = np.random.default_rng(seed)
    cloud = rng.uniform(-8, 8, (int(rng.integers(0, 200)), 2))
    edge = np.deg2rad(10.0) * rng.integers(-18, 18, 30) + rng.uniform(-2e-5, 2e-5, 30)
    at_edges = rng.uniform(1, 7, 30)[:, None] * np.column_stack([np.cos(edge), np.sin(edge)])
    cloud = np.concatenate([cloud, at_edges])
    thin = nearest_per_sector(cloud, 36, 6.0)
    sector = ((np.arctan2(cloud[:, 1], cloud[:, 0]) / (2 * np.pi) + 0.5) * 36).astype(int) % 36
    gap = np.hypot(*cloud.T)
    expected = [
        cloud[k]
        for s in range(36)
        for k in np.flatnonzero((sector == s) & (gap < 6.0))
        if gap[k] == gap[(sector == s)].min()
    ]
    np.testing.assert_array_equal(thin, np.reshape(expected, (-1, 2)))


def test_apparent_velocity() -> None:
    before = points((5.0, 0.0), (0.0, 3.0))
    now = points((4.6, 0.0), (0.0, 3.02), (9.0, 9.0))
    got = apparent_velocity(now, before, 0.25, 0.3, 2.5)
    np.testing.assert_allclose(got, [[-1.6, 0.0], [0.0, 0.0], [0.0, 0.0]])
    assert not apparent_velocity(now, NOTHING, 0.25, 0.3, 2.5).any()


@given(st.integers(0, 2**32 - 1), st.sampled_from([0.25, 1.0]))
def test_apparent_velocity_is_that_of_the_first_nearest_neighbour(seed: int, dt: float) -> None:
    rng = np.random.default_rng(seed)
    now, before = (rng.integers(-9, 10, (int(n), 2)) / 8.0 for n in rng.integers(1, 60, 2))
    square = ((now[:, None] - before) ** 2).sum(axis=2)
    nearest = square.argmin(axis=1)  # on a grid many are equally near: the first of them
    best = square.min(axis=1)
    moves = (best > (0.3 * dt) ** 2) & (best < (2.5 * dt) ** 2)
    expected = np.where(moves[:, None], (now - before[nearest]) / dt, 0.0)
    np.testing.assert_array_equal(apparent_velocity(now, before, dt, 0.3, 2.5), expected)


@given(st.integers(0, 2**32 - 1))
def test_apart_from_all_others(seed: int) -> None:
    rng = np.random.default_rng(seed)
    cloud, others = (rng.integers(-6, 7, (int(n), 2)) / 5.0 for n in rng.integers(0, 30, 2))
    gap = np.hypot(*(cloud[:, None] - others).T).T.min(axis=1, initial=np.inf)
    np.testing.assert_array_equal(apart(cloud, others, 0.4), gap > 0.4)
    assert not apart(points((np.nan, 0.0)), points((0.0, 0.0)), 0.4).any()


def test_free_time_of_still_and_moving_points() -> None:
    ahead, rest = points((3.0, 0.0)), points((0.0, 0.0))
    assert free_time(ahead, rest, 0.5, 0.0, 0.5, 10.0) == pytest.approx(5.0)
    assert free_time(ahead, points((-0.5, 0.0)), 0.5, 0.0, 0.5, 10.0) == pytest.approx(2.5)
    assert free_time(ahead, points((0.5, 0.0)), 0.5, 0.0, 0.5, 10.0) == 10.0
    assert free_time(ahead, rest, 0.0, 0.5, 0.5, 10.0) == 10.0
    touching = points((0.4, 0.0))
    assert free_time(touching, rest, 0.5, 0.0, 0.5, 10.0) == 0.0
    assert free_time(touching, rest, -0.5, 0.0, 0.5, 10.0) == 10.0


def test_direction_is_the_goals_when_free_and_goes_round_when_not() -> None:
    around = (4.0, 1.0, math.pi, 0.15)
    assert choose_direction(NOTHING, NOTHING, 0.3, 0.3, 0.6, 0.3, *around) == (0.3, 4.0)
    wall = points(*((1.0, y) for y in np.linspace(-2.0, 0.4, 25)))
    angle, free = choose_direction(wall, np.zeros_like(wall), 0.0, 0.0, 0.6, 0.3, *around)
    assert 0.5 < angle < 1.6
    assert free == 4.0


def test_direction_stays_within_the_swerve_whoever_comes() -> None:
    """A front of people who come on: only flight would be free for long."""
    front = points(*((2.0, y) for y in np.linspace(-4.0, 4.0, 41)))
    coming = np.tile([-1.4, 0.0], (len(front), 1))
    for swerve in (0.5, 1.3, math.pi):
        for previous in (0.0, 3.0):
            angle, _ = choose_direction(
                front, coming, 0.2, previous, 0.6, 0.3, 4.0, 0.2, swerve, 0.15
            )
            assert abs(angle - 0.2) <= swerve + 1e-12
    assert abs(angle - 0.2) > 1.3  # it would have fled


def test_it_holds_to_its_last_direction() -> None:
    """Two gaps that are as good: that on the side of the last choice is taken."""
    block = points(*((1.5, y) for y in np.linspace(-0.8, 0.8, 17)))
    still = np.zeros_like(block)
    for previous in (-0.9, 0.9):
        angle, _ = choose_direction(block, still, 0.0, previous, 0.6, 0.3, 4.0, 1.0, 1.3, 0.3)
        assert angle * previous > 0.0


# -------------------------------------------------------------------------- rollouts
def parameters(**changed: float) -> Array:
    p = np.zeros(entries.PARAMETERS)
    values = {
        "A_MAX": 1.0, "ALPHA_MAX": 2.0, "HORIZON": 2.5, "TURN_TIME": 1.0, "RADIUS": 0.2,
        "MARGIN": 0.05, "COMFORT": 0.4, "GROWTH": 0.0, "PERIOD": 0.0625, "PROGRESS": 1.0,
        "HEADING": 0.4, "CLEARANCE": 0.5, "IMPACT": 1.0, "SMOOTHNESS": 0.0, "V_MAX": 1.0,
        "W_MAX": 3.0, "REACH": 0.2, **changed,
    }  # fmt: skip
    for name, value in values.items():
        p[getattr(entries, name)] = value
    return p


def roll(
    cloud: Array, speeds: Array, p: Array, v: float, w: float, vt: float, wt: float
) -> tuple[float, float, float, float, float]:
    ahead = rollout.foreseen(cloud, speeds, p)
    known = rollout.rollouts(ahead)
    rolled: tuple[float, float, float, float, float] = rollout.roll(
        ahead, p, NOTHING, (v, w, 0.0), (vt, wt, 0.0), *known
    )
    return rolled


def test_every_parameter_has_its_own_place() -> None:
    places = sorted(v for k, v in vars(entries).items() if k.isupper() and type(v) is int)
    assert places == [*range(entries.PARAMETERS), entries.PARAMETERS]


def test_a_straight_rollout_with_a_ramp() -> None:
    """From rest at 1 m/s^2 to 0.5 m/s: 0.125 m in 0.5 s, then 2 s at 0.5 m/s."""
    x, y, angle, hit, close = roll(NOTHING, NOTHING, parameters(), 0.0, 0.0, 0.5, 0.0)
    assert (x, y, angle, hit, close) == pytest.approx((1.125, 0.0, 0.0, 2.5, 0.0))


def test_an_arc_turns_for_the_turning_time() -> None:
    angle = roll(NOTHING, NOTHING, parameters(), 0.5, 1.0, 0.5, 1.0)[2]
    assert angle == pytest.approx(1.0 + 0.25)  # 1 s at 1 rad/s, then half a second to stop
    x, y = roll(NOTHING, NOTHING, parameters(TURN_TIME=9.0), 0.5, 1.0, 0.5, 1.0)[:2]
    assert x == pytest.approx(0.5 * math.sin(2.5), abs=2e-3)
    assert y == pytest.approx(0.5 * (1 - math.cos(2.5)), abs=2e-3)


def test_hits_still_and_moving_points() -> None:
    p, ahead = parameters(), points((1.5, 0.0))
    hit = roll(ahead, np.zeros((1, 2)), p, 1.0, 0.0, 1.0, 0.0)[3]
    assert hit == pytest.approx(1.25, abs=rollout.STEP)
    hit = roll(ahead, points((-1.0, 0.0)), p, 1.0, 0.0, 1.0, 0.0)[3]
    assert hit == pytest.approx(0.625, abs=rollout.STEP)
    assert roll(ahead, points((1.0, 0.0)), p, 1.0, 0.0, 1.0, 0.0)[3] == 2.5


@settings(max_examples=60)
@given(st.floats(-0.3, 1.0), st.floats(0.0, 1.0), st.integers(2, 9), st.integers(3, 9))
def test_candidates_are_every_speed_with_every_rate(
    low: float, more: float, speeds: int, rates: int
) -> None:
    high = low + more
    v = np.unique(np.append(np.linspace(low, high, speeds), max(low, min(0.0, high))))
    w = np.append(np.linspace(-1.5, 0.7, rates), (0.3, 0.0))
    found = window.candidates(low, high, speeds, -1.5, 0.7, rates, 0.3)
    np.testing.assert_array_equal(found[:, 0], np.repeat(v, len(w)))
    np.testing.assert_array_equal(found[:, 1], np.tile(w, len(v)))


@given(st.lists(st.floats(allow_nan=False)))
def test_minimum(values: list[float]) -> None:
    assert minimum(np.array(values, dtype=np.float64)) == min(values, default=math.inf)


@settings(max_examples=60)
@given(st.integers(0, 40), st.integers(0, 2**32 - 1))
def test_what_rollouts_know_of_each_other_changes_none(count: int, seed: int) -> None:
    rng = np.random.default_rng(seed)
    cloud, speeds = rng.uniform(-2.0, 2.0, (count, 2)), rng.uniform(-1.0, 1.0, (count, 2))
    p = parameters(GROWTH=0.05)
    ahead = rollout.foreseen(cloud, speeds, p)
    known = rollout.rollouts(ahead)
    for vt, wt in rng.uniform(-1.0, 1.0, (30, 2)):
        shared = rollout.roll(ahead, p, NOTHING, (0.3, 0.1, 0.0), (vt, wt, 0.0), *known)
        assert shared == roll(cloud, speeds, p, 0.3, 0.1, vt, wt)


@settings(max_examples=60)
@given(st.floats(0.0, 1.0), st.floats(0.3, 3.0), st.integers(0, 2**32 - 1))
def test_what_is_chosen_can_stop_before_anything_still(v: float, gap: float, seed: int) -> None:
    """After one period of the chosen command and full braking no still point is touched."""
    rng = np.random.default_rng(seed)
    angle = rng.uniform(-0.6, 0.6, 12)
    still = np.column_stack([np.cos(angle), np.sin(angle)]) * (0.25 + v * v / 2 + v * 0.2 + gap)
    speeds, rates = np.meshgrid(np.linspace(max(0.0, v - 0.5), v, 6), np.linspace(-1, 1, 9))
    candidates = np.column_stack([speeds.ravel(), rates.ravel()])
    p = parameters()
    index, cost = evaluate(
        still, np.zeros_like(still), p, NOTHING, (v, 0.0, 0.0), candidates, 0.0, 0.0, (v, 0.0, 0.0)
    )
    if index < 0:
        return
    assert math.isfinite(cost)
    vt = candidates[index, 0]
    speed = max(vt, v - 0.0625)
    way = v * 0.0625 + speed**2 / 2.0
    assert np.hypot(*still.T).min() - way > 0.2


@settings(max_examples=60)
@given(st.integers(0, 40), st.floats(0.3, 3.0), st.integers(0, 2**32 - 1))
def test_whoever_is_passed_over_would_not_have_won(count: int, horizon: float, seed: int) -> None:
    rng = np.random.default_rng(seed)
    cloud, speeds = rng.uniform(-2.0, 2.0, (count, 2)), rng.uniform(-1.0, 1.0, (count, 2))
    names = "PROGRESS", "HEADING", "CLEARANCE", "IMPACT"
    weights = dict(zip(names, rng.uniform(0.0, 2.0, 4) * rng.integers(0, 2, 4), strict=True))
    p = parameters(HORIZON=horizon, TURN_TIME=9.0, GROWTH=0.05, SMOOTHNESS=0.1, **weights)
    wishes = np.round(rng.uniform(-1.0, 1.0, (20, 2 + seed % 2)), 1)
    wishes[::2, 1] *= 3.0  # in circles: not all who are stopped would have come farther
    state = (0.3, 0.1, 0.0), (0.2, 0.0, 0.0)

    def chosen(which: Array) -> tuple[int, float]:
        now, last = state
        found: tuple[int, float] = evaluate(cloud, speeds, p, NOTHING, now, which, 0.4, -0.3, last)
        return found

    costs = [chosen(wishes[k : k + 1])[1] for k in range(len(wishes))]
    best = min(costs)
    assert chosen(wishes) == (costs.index(best) if best < math.inf else -1, best)


def test_no_candidate_is_admissible_before_a_wall() -> None:
    wall = points((0.35, -0.1), (0.35, 0.0), (0.35, 0.1))
    moving = np.array([[1.0, 0.0], [0.8, 0.0]])
    rest = np.zeros_like(wall)
    p = parameters()
    zero, fast = (0.0, 0.0, 0.0), (1.0, 0.0, 0.0)
    assert evaluate(wall, rest, p, NOTHING, fast, moving, 0.0, 0.0, zero)[0] == -1
    spot = np.array([[0.0, 1.0]])
    assert evaluate(wall, rest, p, NOTHING, zero, spot, 0.0, 0.0, zero)[0] == 0


def test_reachable_drops_only_what_cannot_matter() -> None:
    cloud = points((0.5, 0.0), (4.0, 0.0), (4.0, 0.0))
    speed = points((0.0, 0.0), (0.0, 0.0), (-1.5, 0.0))
    near, going = rollout.reachable(cloud, speed, parameters())
    np.testing.assert_array_equal(near, cloud[[0, 2]])
    np.testing.assert_array_equal(going, speed[[0, 2]])


# ------------------------------------------------------------------------------- map
def bearing(obstacles: ArrayLike, goal: tuple[float, float] = (20.0, 0.0)) -> float | None:
    where = np.reshape(np.asarray(obstacles, dtype=np.float64), (-1, 2))
    found, way = way_out(where, 0.0, 0.0, *goal, 0.25)
    return way if found else None


def line(x0: float, y0: float, x1: float, y1: float) -> list[tuple[float, float]]:
    s = np.linspace(0.0, 1.0, 60)
    return list(zip(x0 + s * (x1 - x0), y0 + s * (y1 - y0), strict=True))


@pytest.mark.parametrize("goal", [(20.0, 0.0), (0.0, -30.0), (-2.0, 2.0)])
def test_an_empty_map_leads_straight(goal: tuple[float, float]) -> None:
    assert bearing([], goal) == pytest.approx(math.atan2(goal[1], goal[0]), abs=0.15)


def test_out_of_a_cup() -> None:
    """Open behind, closed towards the goal: the way begins backwards."""
    cup = line(1, -1, 1, 1) + line(-1.5, 1, 1, 1) + line(-1.5, -1, 1, -1)
    way = bearing(cup)
    assert way is not None
    assert abs(way) > 2.0


def test_through_the_wider_gap_only() -> None:
    gaps = line(1, -6, 1, -0.2) + line(1, 0.2, 1, 1.5) + line(1, 2.3, 1, 6)
    way = bearing(gaps)  # 0.4 m wide straight ahead, 0.8 m wide to the left
    assert way is not None
    assert 0.4 < way < 1.6  # on a grid, up first and then across is as short as straight


def test_no_way_out_of_a_ring() -> None:
    ring = [(1.0 * math.cos(a), 1.0 * math.sin(a)) for a in np.arange(0, 6.28, 0.1)]
    assert bearing(ring) is None


def test_memory_keeps_what_is_hidden_and_forgets_what_is_gone() -> None:
    wall = points(*line(3, -1, 3, 1))
    memory = remembered(NOTHING, wall, 0.0, 0.0, 6.0)
    screen = points(*line(1, -1, 1, 1))
    assert len(remembered(memory, screen, 0.0, 0.0, 6.0)) > len(memory)  # hidden behind the screen
    assert len(remembered(memory, points((-2, 0)), 0.0, 0.0, 6.0)) == 1  # seen to be gone
    assert len(remembered(memory, points((-2, 0)), -9.0, 0.0, 6.0)) == len(memory) + 1  # far away
    again = remembered(memory, wall, 0.0, 0.0, 6.0)
    np.testing.assert_allclose(np.sort(again, axis=0), np.sort(memory, axis=0), atol=0.1)
