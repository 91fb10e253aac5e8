"""The engine as a whole: order, frame, determinism, few people, the corridor of the challenge."""

from __future__ import annotations

import hashlib
import subprocess
import sys
from dataclasses import replace

import numpy as np
import pytest

from crowdbot.core.crowd import Agents, CrowdEngine
from crowdbot.core.crowd import state as s
from tests.core.crowd.crowd_reference import Array, agents_of
from tests.core.crowd.crowd_worlds import ENTRANCE, OUT, TICKS, WALLS, challenge, rows, walkers
from tests.paths import ROOT

RADIUS = 0.33


def _agents(count: int, seed: int = 0) -> Agents:
    """People on a jittered grid, nobody on anybody; few in the way of each other's x."""
    rng = np.random.default_rng(seed)
    columns = (count + 5) // 6
    grid = [(10.0 + 1.5 * c, -3.75 + 1.5 * r) for c in range(columns) for r in range(6)]
    position = np.reshape(grid[:count], (count, 2)) + rng.uniform(-0.35, 0.35, (count, 2))
    return agents_of(position, rng.uniform(0.7, 1.6, count))


def _run(engine: CrowdEngine, seconds: float, robots: Array | None = None) -> Array:
    flat = engine.initial_state()
    for _ in range(int(seconds * TICKS)):
        engine.advance(flat, np.zeros((0, 6)) if robots is None else robots)
    return flat


def test_no_agents() -> None:
    flat = _run(walkers(_agents(0)), 1.0, np.array([[5.0, 0.0, 0.0, 0.0, 0.178, 0.428]]))
    assert len(flat) == s.HEADER_SIZE + s.FELT_SIZE
    assert flat[s.TICK] == TICKS
    assert not np.any(flat[s.TICK + 1 :])


def test_one_agent_walks_straight_on_at_its_speed() -> None:
    engine = walkers(_agents(1))
    start, speed = engine.initial_state(), engine.agents.preferred_speed[0]
    flat = _run(engine, 4.0)
    moved = rows(flat)[0, : s.Y + 1] - rows(start)[0, : s.Y + 1]
    to_goal = rows(start)[0, s.GOAL_X : s.GOAL_Y + 1] - rows(start)[0, : s.Y + 1]
    assert moved == pytest.approx(4.0 * speed * to_goal / np.hypot(*to_goal), abs=1e-9)


@pytest.mark.parametrize("seed", range(3))
def test_the_order_of_agents_does_not_matter(seed: int) -> None:
    """Permuted with their ids, everybody walks the very same way."""
    agents = _agents(50, seed)
    order = np.random.default_rng(seed).permutation(50)
    names = ("id", "x", "y", "preferred_speed", "radius", "max_speed", "max_acceleration", "mass")
    shuffled = Agents.of(**{name: getattr(agents, name)[order] for name in names})
    robots = np.array([[14.0, 0.1, 0.3, 0.0, 0.178, 0.428]])
    first, second = _run(walkers(agents), 3.0, robots), _run(walkers(shuffled), 3.0, robots)
    assert rows(second) == pytest.approx(rows(first)[order], abs=1e-9)


def test_mirrored_at_the_axis() -> None:
    agents = _agents(40, 4)
    engine = walkers(agents)
    mirrored = walkers(replace(agents, y=-agents.y))
    flat, other = engine.initial_state(), mirrored.initial_state()
    for column in (s.Y, s.VY, s.GOAL_Y):  # goals are drawn, so they are mirrored by hand
        rows(other)[:, column] = -rows(flat)[:, column]
    for column in (s.X, s.VX, s.GOAL_X):
        rows(other)[:, column] = rows(flat)[:, column]
    for _ in range(2 * TICKS):
        engine.advance(flat)
        mirrored.advance(other)
    same = np.abs(rows(other)[:, s.Y] + rows(flat)[:, s.Y]) < 1e-6
    assert np.mean(same) > 0.8  # exact ties between mirrored candidates may go either way


@pytest.mark.parametrize("offset", [(0.0, 0.0), (7.0, 3.0)])
@pytest.mark.parametrize("turn", [np.eye(2), np.array([[0.0, -1.0], [1.0, 0.0]])])
def test_moved_and_turned_by_90_degrees(turn: Array, offset: tuple[float, float]) -> None:
    agents = _agents(40, 5)
    at = np.column_stack([agents.x, agents.y]) @ turn.T + offset
    walls = np.concatenate([WALLS[:, :2] @ turn.T + offset, WALLS[:, 2:] @ turn.T + offset], axis=1)
    far = np.array([900.0, 901.0, 900.0, 901.0])  # nobody gets to a portal
    engine = walkers(agents, out=far, entrance=far)
    moved = walkers(
        replace(agents, x=at[:, 0].copy(), y=at[:, 1].copy()), walls=walls, out=far, entrance=far
    )
    flat, other = engine.initial_state(), moved.initial_state()
    for x, y, shift in ((s.X, s.Y, offset), (s.VX, s.VY, (0, 0)), (s.GOAL_X, s.GOAL_Y, offset)):
        rows(flat)[:, s.GOAL_X], rows(flat)[:, s.GOAL_Y] = 50.5, agents.y
        rows(other)[:, [x, y]] = rows(flat)[:, [x, y]] @ turn.T + shift
    for _ in range(2 * TICKS):
        engine.advance(flat)
        moved.advance(other)
    expected = rows(flat)[:, : s.Y + 1] @ turn.T + offset
    assert np.mean(np.hypot(*(rows(other)[:, : s.Y + 1] - expected).T) < 1e-6) > 0.8


def test_awkward_starts() -> None:
    """On each other, on a wall, outside it, at the goal: no NaN, ever."""
    position = np.array(
        [
            [10, 0],
            [10, 0],
            [10, 0],
            [12, 5],
            [12, -5],
            [14, 5.2],
            [50.5, 0],
            [10.3, 0.2],
            [45, 4.99],
        ]
    ).astype(float)
    engine = walkers(agents_of(position, 1.2))
    flat = engine.initial_state()
    rows(flat)[6, s.GOAL_X : s.GOAL_Y + 1] = rows(flat)[6, : s.Y + 1]
    for _ in range(20 * TICKS):
        engine.advance(flat, np.array([[20.0, 0.0, 0.0, 0.0, 0.178, 0.428]]))
        assert np.all(np.isfinite(flat))


def _digest(id_: str, seconds: float) -> str:
    flat = _run(challenge(id_), seconds, np.array([[25.0, 0.0, 0.3, 0.0, 0.178, 0.428]]))
    return hashlib.sha256(flat.tobytes()).hexdigest()


@pytest.mark.slow
def test_same_bytes_twice_and_in_another_process() -> None:
    id_ = "counter-d0500-dispersed-c20-r05"
    here = [_digest(id_, 4.0) for _ in range(2)]
    code = f"from tests.core.crowd.test_engine import _digest; print(_digest({id_!r}, 4.0))"
    there = subprocess.run(
        [sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True,
        check=True,
    )  # fmt: skip
    assert {*here, there.stdout.strip()} == {here[0]}


@pytest.mark.slow
@pytest.mark.parametrize(
    "id_",
    [
        "in-d0125-slow-c01-r02",
        "counter-d0250-dispersed-c20-r05",
        "in-d0500-fast-c50-r10",
        "counter-d0500-slow-c01-r10",
    ],
)
def test_a_minute_in_the_corridor(id_: str) -> None:
    engine = challenge(id_)
    flat, count = engine.initial_state(), len(engine.agents)
    preferred = engine.agents.preferred_speed
    overlap = waiting = 0.0
    speeds = []
    for tick in range(60 * TICKS):
        engine.advance(flat)
        if tick % 8:
            continue
        people = rows(flat)
        assert np.all(np.isfinite(people))
        here = people[:, s.WAITING] == 0.0
        assert np.max(np.abs(people[here, s.Y])) < 5.0
        low, high = min(ENTRANCE[0], OUT[0]), max(ENTRANCE[1], OUT[1])
        assert np.all((people[here, s.X] > low) & (people[here, s.X] < high))
        at = people[here, : s.Y + 1]
        gap = np.hypot(at[:, None, 0] - at[None, :, 0], at[:, None, 1] - at[None, :, 1])
        overlap = max(overlap, 2.0 * RADIUS - float(np.min(gap + 9.0 * np.eye(len(at)))))
        waiting += float(np.sum(~here))
        speeds.append(np.mean(np.hypot(*people[here, s.VX : s.VY + 1].T) / preferred[here]))
    print(f"{id_}: overlap {overlap:.3f} m, speed {np.mean(speeds):.4f}, trips {flat[s.TRIPS]:.0f}")
    assert len(rows(flat)) == count
    assert overlap <= 0.2
    assert 0.97 <= np.mean(speeds) <= 1.03
    assert flat[s.TRIPS] > 0.5 * count * 60.0 * np.mean(preferred) / 50.0
    assert waiting / len(speeds) < 0.1
