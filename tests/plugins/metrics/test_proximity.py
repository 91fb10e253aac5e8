"""Distances, gaps and zones: hand cases and failures."""

from __future__ import annotations

import math

import numpy as np
import pytest

from crowdbot.core.trajectories.trajectories import Trajectories
from tests.plugins.metrics.scenes import (
    REACH,
    Body,
    grid,
    line,
    present_during,
    scene,
    scores_of,
    value_of,
    values,
    why,
)

T = grid(10)
STILL = line(T, (0, 0), (0, 0))


def around(*places: tuple[float, float]) -> Trajectories:
    """A robot and people who stand."""
    return scene(T, STILL, [line(T, p, (0, 0)) for p in places])


def test_constant_distance() -> None:  # b06, f03
    ring = [(2 * math.cos(a), 2 * math.sin(a)) for a in np.arange(6) * math.pi / 3]
    for run in (around((2, 0)), around(*ring)):
        found = scores_of("proximity", run)
        assert values(found) == pytest.approx(
            {"literal": 101 * 0.5, "corrected": 0.5, "outline": 1 / (2 - REACH)}
        )
        assert found["corrected"].extras == pytest.approx(
            {"shortest_distance": 2, "harmonic_mean_distance": 2}
        )


def test_passing() -> None:  # f05, b02, e12
    t = grid(10, 0.005)
    run = scene(t, line(t, (0, 0), (1, 0)), [line(t, (5, 2), (0, 0))])
    assert value_of(scores_of("proximity", run)) == pytest.approx(0.2 * math.asinh(2.5), rel=1e-6)
    run = scene(t, line(t, (0, 0), (1, 0)), [line(t, (10, 1), (-1, 0))])
    assert value_of(scores_of("proximity", run)) == pytest.approx(math.asinh(10) / 10, rel=1e-6)


def test_the_nearest_counts_by_its_centre_not_below_the_floor() -> None:
    run = around((0.05, 0), (4, 0))
    assert values(scores_of("proximity", run)) == pytest.approx(
        {"literal": 101 * 20, "corrected": 10, "outline": 10}
    )
    found = scores_of("proximity", around((0, 0), (4, 0)))
    assert found["literal"].reason == "zero_distance"
    assert value_of(found) == pytest.approx(10)
    assert value_of(scores_of("proximity", run, proximity_floor="20 cm")) == pytest.approx(5)


def test_moments_with_nobody_add_nothing() -> None:
    half = present_during(line(T, (2, 0), (0, 0)), T <= 5 + 1e-9)
    found = scores_of("proximity", scene(T, STILL, [half]))
    assert values(found) == pytest.approx(
        {"literal": 51 * 0.5, "corrected": 0.505 * 0.5, "outline": 0.505 / (2 - REACH)}
    )
    never = present_during(line(T, (2, 0), (0, 0)), T < 0)
    for run in (scene(T, STILL), scene(T, STILL, [never])):
        assert why(scores_of("proximity", run)) == {("undefined", "no_agents")}


# --------------------------------------------------------------------- normalized
def test_spread_and_barycentre() -> None:  # f01, f03, f04, b06
    found = scores_of("normalized_proximity", around((1, 0), (-3, 0)))
    assert values(found) == pytest.approx({"literal": 0.5, "corrected": 0.5, "barycentre": 0.5})
    found = scores_of("normalized_proximity", around((1, 0), (0, 2)))
    assert value_of(found) == pytest.approx(1 / 3)
    assert value_of(found, "barycentre") == pytest.approx(math.hypot(0.5, 1) / 1.5)
    ring = [(2 * math.cos(a), 2 * math.sin(a)) for a in np.arange(6) * math.pi / 3]
    found = scores_of("normalized_proximity", around(*ring))
    assert values(found) == pytest.approx(dict.fromkeys(found, 0.0), abs=1e-12)
    found = scores_of("normalized_proximity", around((2, 0), (3.01, 0)))
    assert values(found) == {"literal": 0.0, "corrected": None, "barycentre": pytest.approx(1)}
    assert found["corrected"].reason == "fewer_than_two_neighbours"


def test_spread_over_time() -> None:
    first = present_during(line(T, (1, 0), (0, 0)), T <= 2 + 1e-9)
    run = scene(T, STILL, [first, line(T, (-3, 0), (0, 0))])
    found = scores_of("normalized_proximity", run)
    assert value_of(found, "literal") == pytest.approx(0.5 * 21 / 101)
    assert value_of(found) == pytest.approx(0.5)
    assert found["corrected"].extras["coverage"] == pytest.approx(2.05 / 10)
    assert value_of(found, "barycentre") == pytest.approx((0.5 * 2.05 + 1 * 7.95) / 10)
    assert why(scores_of("normalized_proximity", around((9, 0)))) == {
        ("undefined", "no_neighbours")
    }
    found = scores_of("normalized_proximity", around((0, 0), (0, 0)))
    assert why(found) == {("undefined", "zero_distance")}


def test_crowding() -> None:
    half = present_during(line(T, (2, 0), (0, 0)), T <= 5 + 1e-9)
    run = scene(T, STILL, [half, line(T, (0, 3), (0, 0)), line(T, (9, 0), (0, 0))])
    assert value_of(scores_of("neighbour_count", run)) == pytest.approx(1.505)
    assert value_of(scores_of("local_density", run)) == pytest.approx(1.505 / (9 * math.pi))


# ---------------------------------------------------------------------- clearance
def at_gap(gap: float) -> Trajectories:
    return around((REACH + gap, 0), (20, 0))


def zones(run: Trajectories) -> list[float]:
    names = ("intimate_time_fraction", "personal_time_fraction", "social_time_fraction")
    return [value_of(scores_of(name, run)) for name in names]


@pytest.mark.parametrize(
    ("gap", "shares", "complies"),
    [
        (-0.1, [1, 0, 0], 0),
        (0.44, [1, 0, 0], 0),
        (0.45, [0, 1, 0], 0),
        (0.5, [0, 1, 0], 0),
        (0.51, [0, 1, 0], 1),
        (1.19, [0, 1, 0], 1),
        (1.2, [0, 0, 1], 1),
        (3.59, [0, 0, 1], 1),
        (3.6, [0, 0, 0], 1),
    ],
)
def test_zones_are_between_surfaces(gap: float, shares: list[float], complies: float) -> None:
    assert zones(at_gap(gap)) == pytest.approx(shares)
    assert value_of(scores_of("space_compliance", at_gap(gap))) == pytest.approx(complies)
    assert value_of(scores_of("min_clearance", at_gap(gap))) == pytest.approx(gap)


def test_clearance_over_time() -> None:
    x = np.where(T <= 4 + 1e-9, REACH + 0.2, REACH + 0.8)
    run = scene(T, STILL, [Body(x, 0 * T, 0 * T, 0 * T)])
    assert zones(run) == pytest.approx([0.405, 0.595, 0])
    assert value_of(scores_of("avg_clearance", run)) == pytest.approx(0.2 * 0.405 + 0.8 * 0.595)
    half = scene(T, STILL, [present_during(Body(x, 0 * T, 0 * T, 0 * T), T <= 4 + 1e-9)])
    assert zones(half) == pytest.approx([0.405, 0, 0])
    assert value_of(scores_of("avg_clearance", half)) == pytest.approx(0.2)
    assert value_of(scores_of("space_compliance", half)) == pytest.approx(0.595)


def test_reasons_of_clearance() -> None:
    for metric in ("min_clearance", "avg_clearance", "intimate_time_fraction", "space_compliance"):
        assert why(scores_of(metric, scene(T, STILL))) == {("undefined", "no_agents")}
        crowd = scene(T, None, [STILL])
        assert why(scores_of(metric, crowd)) == {("undefined", "invalid_no_robot")}
