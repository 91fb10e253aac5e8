"""What must hold for any crowd: symmetries, few and many people, awkward starts, determinism."""

from __future__ import annotations

import hashlib
import os
import subprocess
import sys

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from crowdbot.core.crowd import STOP, Agents, CrowdEngine
from crowdbot.core.crowd import state as s
from tests.core.crowd.crowd_reference import Array
from tests.core.crowd.crowd_worlds import TICKS, rows, walkers
from tests.paths import ROOT

NOWHERE = np.zeros((0, 4))
PLACE = [s.X, s.Y]
SEEDS = st.integers(0, 2**32 - 1)


def _crowd(agents: Agents, walls: Array = NOWHERE, rate: float = 16.0) -> CrowdEngine:
    return walkers(agents, walls=walls, entrance=NOWHERE, out=NOWHERE, decision_rate=rate)


def _after(engine: CrowdEngine, seconds: float, robots: Array | None = None) -> Array:
    flat = engine.initial_state()
    for _ in range(round(seconds * TICKS)):
        engine.advance(flat, np.zeros((0, 6)) if robots is None else robots)
    assert np.all(np.isfinite(flat))
    return rows(flat)


class Draw:
    """A random crowd, nobody on anybody, that can be moved about."""

    def __init__(self, seed: int, most: int = 14) -> None:
        rng = np.random.default_rng(seed)
        n = int(rng.integers(1, most))
        cells = rng.permutation(36)[:n]
        self.at = np.column_stack([cells % 6, cells // 6]) * 1.6 + rng.uniform(-0.4, 0.4, (n, 2))
        self.goal = self.at + rng.uniform(-30, 30, (n, 2))
        self.speed, self.radius = rng.uniform(0.5, 2.0, n), rng.uniform(0.2, 0.4, n)
        self.ids = rng.permutation(n * 3)[:n]

    def agents(
        self,
        turn: Array | None = None,
        shift: Array | None = None,
        order: NDArray[np.int64] | None = None,
    ) -> Agents:
        turn = np.eye(2) if turn is None else turn
        shift = np.zeros(2) if shift is None else shift
        rows_ = np.arange(len(self.at)) if order is None else order
        at, goal = (p @ turn.T + shift for p in (self.at[rows_], self.goal[rows_]))
        return Agents.of(
            id=self.ids[rows_], x=at[:, 0], y=at[:, 1], preferred_speed=self.speed[rows_],
            radius=self.radius[rows_], routes=[[tuple(g)] for g in goal],
        )  # fmt: skip


def _mostly_equal(a: Array, b: Array) -> bool:
    """Within a micrometre; a crowd of which one exact tie went the other way may differ."""
    return bool(np.all(np.hypot(*(a - b).T) < 1e-6))


def _share(check: object, count: int = 25) -> float:
    return float(np.mean([check(seed) for seed in range(count)]))  # type: ignore[operator]


@pytest.mark.slow
@given(SEEDS)
@settings(max_examples=20)
def test_permutation(seed: int) -> None:
    crowd = Draw(seed)
    order = np.random.default_rng(seed).permutation(len(crowd.at))
    first = _after(_crowd(crowd.agents()), 2.0)
    second = _after(_crowd(crowd.agents(order=order)), 2.0)
    assert second[:, PLACE] == pytest.approx(first[order][:, PLACE], abs=1e-9)


@pytest.mark.parametrize("shift", [(3.0, -7.0), (1000.1, 0.0)])
def test_translation(shift: tuple[float, float]) -> None:
    def same(seed: int) -> bool:
        crowd = Draw(seed)
        still = _after(_crowd(crowd.agents()), 2.0)[:, PLACE]
        moved = _after(_crowd(crowd.agents(shift=np.array(shift))), 2.0)[:, PLACE]
        return _mostly_equal(still + shift, moved)

    assert _share(same) >= 0.9


@pytest.mark.slow
@pytest.mark.parametrize("angle", [0.3, np.pi / 2, 2.0, np.pi])
def test_rotation(angle: float) -> None:
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])

    def same(seed: int) -> bool:
        crowd = Draw(seed)
        still = _after(_crowd(crowd.agents()), 2.0)[:, PLACE]
        return _mostly_equal(still @ turn.T, _after(_crowd(crowd.agents(turn)), 2.0)[:, PLACE])

    assert _share(same) >= 0.9


def test_mirror() -> None:
    mirror = np.array([[1.0, 0.0], [0.0, -1.0]])

    def same(seed: int) -> bool:
        crowd = Draw(seed)
        still = _after(_crowd(crowd.agents()), 2.0)[:, PLACE]
        return _mostly_equal(still @ mirror.T, _after(_crowd(crowd.agents(mirror)), 2.0)[:, PLACE])

    assert _share(same) >= 0.9


@pytest.mark.slow
def test_deciding_twice_as_often_changes_little() -> None:
    """The median walker ends within a hand's breadth after 3 s, most within a body."""
    apart = []
    for seed in range(25):
        crowd = Draw(seed)
        coarse = _after(_crowd(crowd.agents(), rate=16.0), 3.0)[:, PLACE]
        fine = _after(_crowd(crowd.agents(), rate=32.0), 3.0)[:, PLACE]
        apart += np.hypot(*(coarse - fine).T).tolist()
    assert np.median(apart) < 0.1
    assert np.quantile(apart, 0.9) < 0.7


@given(st.data())
@settings(max_examples=40)
def test_awkward_crowds_stay_finite(data: st.DataObject) -> None:
    """Coincident people, no speed, goals at hand and far off, any size, walls through people."""
    count = data.draw(st.integers(0, 8))
    spots = st.sampled_from([(0.0, 0.0), (0.0, 1e-9), (0.3, 0.0), (2.0, 1.0), (5.0, -5.0)])
    far = st.sampled_from([0.0, 1e-12, 0.3, 2.0, 1e5])
    at = [data.draw(spots) for _ in range(count)]
    agents = Agents.of(
        x=[p[0] for p in at], y=[p[1] for p in at],
        preferred_speed=[data.draw(st.sampled_from([0.0, 1e-9, 1.3, 3.0])) for _ in at],
        radius=[data.draw(st.sampled_from([1e-3, 0.33, 2.0])) for _ in at],
        routes=[[(p[0] + data.draw(far), p[1])] * data.draw(st.integers(0, 2)) for p in at],
        at_goal=[data.draw(st.integers(STOP, 3)) for _ in at],
    )  # fmt: skip
    walls = np.array([[-1.0, 0.0, 9.0, 0.0], [0.3, -1.0, 0.3, -1.0], [2.0, 1.0, 2.0, 5.0]])
    robot = np.array([[*data.draw(spots), 0.0, 0.0, 0.178, 0.428]])
    found = _after(_crowd(agents, walls), 1.0, robot)
    assert len(found) == count


def test_one_agent_and_nobody() -> None:
    one = Agents.of(x=0.0, y=0.0, preferred_speed=1.3, routes=[[(40.0, 30.0)]])
    assert _after(_crowd(one), 5.0)[0, PLACE] == pytest.approx([5.2, 3.9])
    assert len(_after(_crowd(Agents.of(x=[], y=[], routes=[])), 1.0)) == 0


@pytest.mark.slow
def test_four_thousand_people_in_a_small_box() -> None:
    """Eight to a square metre, most on each other: finite, and they make room."""
    rng = np.random.default_rng(4)
    side, n = 22.0, 4000
    at = rng.uniform(0.4, side - 0.4, (n, 2))
    box = np.array([[0, 0, side, 0], [side, 0, side, side], [side, side, 0, side], [0, side, 0, 0]])
    agents = Agents.of(
        x=at[:, 0], y=at[:, 1], preferred_speed=rng.uniform(0.8, 1.6, n),
        routes=[[tuple(g)] for g in rng.uniform(1.0, side - 1.0, (n, 2))],
    )  # fmt: skip
    found = _after(_crowd(agents, box), 0.5)
    assert len(found) == n
    assert np.max(np.hypot(found[:, s.VX], found[:, s.VY])) < 30.0


def _digest(seconds: float = 2.0) -> str:
    rng = np.random.default_rng(5)
    n = 150
    agents = Agents.of(
        x=rng.uniform(0, 20, n), y=rng.uniform(-4, 4, n), preferred_speed=rng.uniform(0.8, 1.6, n),
        start_time=np.maximum(0.0, rng.uniform(-1, 1, n)),
        routes=[[tuple(g)] for g in rng.uniform(-4, 20, (n, 2))],
    )  # fmt: skip
    return hashlib.sha256(
        np.ascontiguousarray(_after(_crowd(agents), seconds)).tobytes()
    ).hexdigest()


@pytest.mark.slow
@pytest.mark.parametrize("threads", [1, 2])
def test_same_bytes_in_another_process_with_any_number_of_threads(threads: int) -> None:
    """The engine is serial; this is what would notice if a kernel became parallel."""
    done = subprocess.run(
        [sys.executable, "-c", f"from {__name__} import _digest; print(_digest())"],
        cwd=ROOT, capture_output=True, text=True, check=True,
        env={**os.environ, "NUMBA_NUM_THREADS": str(threads)},
    )  # fmt: skip
    assert done.stdout.strip() == _digest()
