"""Foresight: what is foreseen comes true, and asking changes nothing."""

from __future__ import annotations

import numpy as np
import pytest

from crowdbot.core.crowd import state as s
from crowdbot.core.sim.foresight import AWAY, Foresight
from crowdbot.core.types.arrays import Array
from tests.core.crowd.crowd_reference import agents_of
from tests.core.crowd.crowd_worlds import TICKS, rows, walkers

STEP = 0.125
ROW = np.array([0.0, 0.0, 0.0, 0.0, 0.18, 0.18, 0.0, 0.0])
DISC = np.zeros((1, 0, 2))


def _engine(count: int = 24) -> tuple[Foresight, object, Array]:
    rng = np.random.default_rng(3)
    grid = [(8.0 + 1.4 * (n // 4), -2.0 + 1.3 * (n % 4)) for n in range(count)]
    at = np.array(grid) + rng.uniform(-0.3, 0.3, (count, 2))
    engine = walkers(agents_of(at, rng.uniform(0.8, 1.5, count)))
    return Foresight(engine, ROW, DISC, 30000.0), engine, engine.initial_state()


def _path(steps: int) -> Array:
    """A robot that drives towards them at half a metre a second."""
    return np.column_stack([
        18.0 - 0.5 * STEP * np.arange(steps + 1), np.zeros(steps + 1), np.full(steps + 1, np.pi)
    ])  # fmt: skip


def _walk(engine: object, flat: Array, ticks: int, path: Array | None) -> Array:
    """Advance a crowd tick by tick, independently of what is tested; places (N, 2)."""
    for n in range(ticks):
        robots = np.zeros((0, 8))
        if path is not None:
            x = np.interp((n + 1) / TICKS, STEP * np.arange(len(path)), path[:, 0])
            robots = np.array([[x, 0.0, -0.5, 0.0, 0.18, 0.18, np.pi, 0.0]])
        engine.advance(flat, robots)  # type: ignore[attr-defined]
    return rows(flat)[:, s.X : s.Y + 1].copy()


@pytest.mark.parametrize("beside", [False, True])
def test_what_is_foreseen_comes_true(beside: bool) -> None:
    seer, engine, flat = _engine()
    path = _path(24) if beside else None
    before = flat.copy()
    found = seer.places(flat, 24, STEP, path)
    assert np.array_equal(flat, before)
    assert found[7] == pytest.approx(_walk(engine, flat.copy(), 128, path), abs=1e-9)
    assert found[-1] == pytest.approx(_walk(engine, flat, 384, path), abs=1e-9)


def test_a_robot_changes_what_is_foreseen() -> None:
    seer, _, flat = _engine()
    found = seer.places(flat, 24, STEP, _path(24)) - seer.places(flat, 24, STEP)
    assert 0.05 < np.hypot(*found[-1].T).max() < 3.0


def test_steps_need_not_be_whole_ticks() -> None:
    seer, _, flat = _engine()
    fine, coarse = seer.places(flat, 256, 1 / TICKS), seer.places(flat, 12, 0.16)
    between = 0.16 * 12 * TICKS
    part, k = between % 1.0, int(between)
    meant = (1.0 - part) * fine[k - 1] + part * fine[k]
    assert coarse[-1] == pytest.approx(meant, abs=1e-3)


def test_who_is_not_there_is_far_away() -> None:
    seer, _, flat = _engine()
    rows(flat)[2, s.WAITING] = s.GONE
    found = seer.places(flat, 2, STEP)
    assert np.all(found[:, 2] == AWAY)
    assert np.all(np.delete(found, 2, axis=1) < 100.0)


def test_wrong_questions_are_refused() -> None:
    seer, _, flat = _engine()
    with pytest.raises(ValueError, match="at most 60 s"):
        seer.places(flat, 1000, 0.1)
    with pytest.raises(ValueError, match="4 steps has 5 rows"):
        seer.places(flat, 4, STEP, np.zeros((4, 3)))
