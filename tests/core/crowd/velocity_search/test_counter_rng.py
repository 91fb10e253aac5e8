"""Counter-based draws: uniform, independent, the same for ever."""

from __future__ import annotations

import numpy as np
import pytest

from crowdbot.core.crowd.velocity_search.counter_rng import ENTRY, GOAL, uniform

KEY = np.uint64(20200430)


def _many(vary: str, count: int = 20_000) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
    fixed = {"agent": 3, "trip": 2, "purpose": GOAL, "counter": 1}
    return np.array(
        [uniform(KEY, *(i if name == vary else v for name, v in fixed.items()))
         for i in range(count)]
    )  # fmt: skip


@pytest.mark.parametrize("vary", ["agent", "trip", "counter"])
def test_uniform_along_every_counter(vary: str) -> None:
    draws = _many(vary)
    assert np.all((draws >= 0.0) & (draws < 1.0))
    assert len(np.unique(draws)) == len(draws)
    ordered = np.sort(draws)
    distance = np.max(np.abs(ordered - (np.arange(len(draws)) + 0.5) / len(draws)))
    assert distance < 1.95 / np.sqrt(len(draws))  # Kolmogorov-Smirnov at 0.1 %
    neighbours = np.corrcoef(draws[:-1], draws[1:])[0, 1]
    assert abs(neighbours) < 4.0 / np.sqrt(len(draws))


def test_keys_and_purposes_are_independent() -> None:
    a = np.array([uniform(KEY, i, 0, GOAL, 0) for i in range(5000)])
    for b in (
        np.array([uniform(KEY, i, 0, ENTRY, 0) for i in range(5000)]),
        np.array([uniform(KEY + np.uint64(1), i, 0, GOAL, 0) for i in range(5000)]),
        np.array([uniform(KEY, i, 0, GOAL, 1) for i in range(5000)]),
        np.array([uniform(KEY, 0, i, GOAL, 0) for i in range(5000)]),
    ):
        assert not np.any(a[1:] == b[1:])
        assert abs(np.corrcoef(a, b)[0, 1]) < 0.06


def test_counters_do_not_mix() -> None:
    """Exchanged counters are other draws: (agent 1, trip 2) is not (agent 2, trip 1)."""
    square = {
        uniform(KEY, agent, trip, purpose, counter)
        for agent in range(12) for trip in range(12) for purpose in (0, 1) for counter in range(12)
    }  # fmt: skip
    assert len(square) == 12 * 12 * 2 * 12


def test_golden_values() -> None:
    """Locked crowds depend on these; they must never change."""
    assert [uniform(np.uint64(k), *rest).hex() for k, *rest in GOLDEN] == list(GOLDEN.values())


def test_the_mixer_is_splitmix64() -> None:
    """The same in plain Python, with integers of any size."""
    for key, *words in GOLDEN:
        state = int(key)
        for word in words:
            z = (state + 0x9E3779B97F4A7C15 * (word + 1)) % 2**64
            z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9 % 2**64
            z = (z ^ (z >> 27)) * 0x94D049BB133111EB % 2**64
            state = z ^ (z >> 31)
        assert uniform(np.uint64(key), *words) == (state >> 11) / 2**53


GOLDEN = {
    (0, 0, 0, 0, 0): "0x1.0983a45556400p-3",
    (20200430, 7, 3, 1, 12): "0x1.ddbb35eaf18c0p-1",
    (2**64 - 1, 199, 40, 0, 1): "0x1.a25f6b49d47edp-1",
}
