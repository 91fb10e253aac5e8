"""Legs are given to tracks as a slow search over all pairs gives them."""

from __future__ import annotations

import math

import numpy as np
import pytest

from crowdbot.core.sensing.tracking import association, clusters, tracks

NONE = association.NONE


def _scene(seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Return tracks and legs at places of which some are equally far apart."""
    rng = np.random.default_rng(seed)
    people = np.zeros((int(rng.integers(0, 20)), tracks.COLUMNS))
    legs = np.zeros((int(rng.integers(0, 30)), clusters.COLUMNS))
    for rows, x, y in ((people, tracks.X, tracks.Y), (legs, clusters.X, clusters.Y)):
        rows[:, [x, y]] = rng.uniform(0.0, 1.5, (len(rows), 2)).round(int(rng.integers(1, 4)))
    people[:, tracks.PERSON] = rng.integers(0, 2, len(people))
    people[:, tracks.PP] = rng.choice([0.0, 0.01, 0.05], len(people))
    legs[:, clusters.WIDTH] = rng.choice([0.1, 0.3], len(legs))
    legs[:, clusters.STILL] = rng.integers(0, 2, len(legs))
    return people, legs


def _slowly(people: np.ndarray, legs: np.ndarray) -> tuple[list[int], list[int]]:
    first, second = [NONE] * len(people), [NONE] * len(people)
    for person in (1.0, 0.0):
        for given in (first, second):
            while True:
                free = set(range(len(legs))) - set(first) - set(second)
                pairs = [
                    (off, i, j)
                    for i in range(len(people))
                    if people[i, tracks.PERSON] == person and given[i] == NONE
                    for j in sorted(free)
                    if (off := _off(people[i], legs, j, person, first[i], given is second)) < 9.0
                ]
                if not pairs:
                    break
                _, i, j = min(pairs)
                given[i] = j
    return first, second


def _off(
    track: np.ndarray, legs: np.ndarray, j: int, person: float, first: int, other: bool
) -> float:
    """Return how far a leg is from where it is expected, m; inf if it cannot be the track's."""
    leg, spread = legs[j], math.sqrt(track[tracks.PP])
    x, y = leg[clusters.X], leg[clusters.Y]
    most = association.gate_of(track)
    if other:
        if first == NONE or max(leg[clusters.WIDTH], legs[first, clusters.WIDTH]) > clusters.LEG:
            return math.inf
        u, v = legs[first, clusters.X], legs[first, clusters.Y]
        if math.hypot(x - u, y - v) > association.APART:
            return math.inf
        x, y, most = 0.5 * (u + x), 0.5 * (v + y), 0.2 + spread
        off = math.hypot(x - track[tracks.X], y - track[tracks.Y])
    else:
        if leg[clusters.STILL] != 0.0 and person == 0.0:
            return math.inf
        off = math.sqrt((x - track[tracks.X]) ** 2 + (y - track[tracks.Y]) ** 2)
    return off if off < most else math.inf


@pytest.mark.parametrize("seed", range(60))
def test_the_nearest_pair_is_first(seed: int) -> None:
    people, legs = _scene(seed)
    first, second = np.full(len(people), 5), np.full(len(people), 5)
    owner = np.full(len(legs), 5)
    association.assign(people, len(people), legs, len(legs), first, second, owner)
    assert (first.tolist(), second.tolist()) == _slowly(people, legs)
    for j, i in enumerate(owner.tolist()):
        assert i == NONE or j in (first[i], second[i])
