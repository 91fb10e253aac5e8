"""Packed motion comes back bit by bit, in few bytes where people walk as the simulation does."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import pytest
import zstandard
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from crowdbot.core.recording.motion.candidates import CandidateGroup
from crowdbot.core.recording.motion.codec import GAINS, MotionCodec, Packed
from crowdbot.core.types.arrays import Array
from crowdbot.core.types.candidates import VelocityCandidates

ANY = st.floats(width=64, allow_nan=True, allow_infinity=True, allow_subnormal=True)
TICK = 1.0 / 128.0


def there_and_back(
    t: Array,
    motion: Array,
    block: int,
    choosers: Sequence[CandidateGroup] = (),
    goals: Array | None = None,
) -> tuple[Array, list[Packed]]:
    """What comes back of samples that are packed in blocks."""
    packs, unpacks = (MotionCodec(motion.shape[2], choosers) for _ in range(2))
    blocks = [slice(k, k + block) for k in range(0, len(t), block)]
    known = [None if goals is None else goals[part] for part in blocks]
    packed = [packs.pack(t[b], motion[b], g) for b, g in zip(blocks, known, strict=True)]
    back = [unpacks.unpack(t[b], one, g) for b, one, g in zip(blocks, packed, known, strict=True)]
    return np.concatenate(back), packed


def deciders(samples: int, people: int) -> tuple[Array, Array, Array, CandidateGroup]:
    """People who take one of some velocities around the way to their goal in each step."""
    rng = np.random.default_rng(11)
    angles = np.linspace(-math.pi / 2, math.pi / 2, 19)
    unit = np.concatenate(
        [part * np.column_stack([np.cos(angles), np.sin(angles)]) for part in (0.5, 1.0)]
    )
    x, v = rng.uniform(-20.0, 20.0, (2, people)), rng.normal(0.0, 1.0, (2, people))
    speed, goal = rng.uniform(0.8, 1.6, people), rng.uniform(40.0, 60.0, (2, people))
    rows = []
    for _ in range(samples):
        rows.append(np.concatenate([x, v]))
        way = goal - x
        ahead = speed / np.sqrt(way[0] * way[0] + way[1] * way[1]) * way
        ex, ey = speed * (ahead / np.sqrt(ahead[0] * ahead[0] + ahead[1] * ahead[1]))
        cx, cy = unit[rng.integers(0, len(unit), people)].T
        a = (np.array([cx * ex - cy * ey, cx * ey + cy * ex]) - v) / 0.5
        for _ in range(8):
            v = v + a * TICK
            x = x + v * TICK
    some = np.arange(people - 1)  # the last one's candidates are not known
    group = CandidateGroup(
        candidates=VelocityCandidates(unit, 0.5),
        rows=some,
        preferred_speed=speed[some],
        radius=np.full(len(some), 0.3),
        max_acceleration=np.full(len(some), 20.0),
    )
    goals = np.repeat(goal[np.newaxis], samples, axis=0)
    return np.arange(samples) / 16.0, np.array(rows), goals, group


def walkers(samples: int, people: int, ticks: int = 8) -> tuple[Array, Array]:
    """People who turn now and then, and come closer to what they want by an eighth in each step."""
    rng = np.random.default_rng(7)
    x, v = rng.uniform(-20.0, 20.0, (2, people)), rng.normal(0.0, 1.0, (2, people))
    speed = rng.uniform(0.8, 1.6, people)
    rows, angle = [], np.zeros(people)
    for _ in range(samples):
        rows.append(np.concatenate([x, v]))
        turns = rng.random(people) < 0.3
        angle = np.where(turns, rng.uniform(-math.pi, math.pi, people), angle)
        a = (speed * np.array([np.cos(angle), np.sin(angle)]) - v) / 0.5
        for _ in range(ticks):
            v = v + a * TICK
            x = x + v * TICK
    return np.arange(samples, dtype=np.float64) * ticks * TICK, np.array(rows, np.float64)


@pytest.mark.slow
@settings(max_examples=60)
@given(
    data=st.data(),
    n=st.integers(1, 6),
    m=st.integers(0, 3),
    block=st.integers(1, 6),
    gaps=st.sampled_from([1 / 128, 1 / 16, 0.1, 1.0, 7.0]),
)
def test_any_numbers_come_back(
    data: st.DataObject, n: int, m: int, block: int, gaps: float
) -> None:
    motion = data.draw(arrays(np.float64, (n, 4, m), elements=ANY))
    back, _ = there_and_back(np.arange(n, dtype=np.float64) * gaps, motion, block)
    assert back.tobytes() == motion.tobytes()


@pytest.mark.parametrize("value", [np.inf, -np.inf, np.nan, 1.7e308])
def test_what_is_beyond_all_numbers_comes_back(value: float) -> None:
    motion = np.full((4, 4, 2), value)
    back, _ = there_and_back(np.arange(4) / 16.0, motion, 2)
    assert back.tobytes() == motion.tobytes()


@pytest.mark.parametrize("block", [1, 16, 200])
def test_walkers_come_back_in_few_bytes(block: int) -> None:
    t, motion = walkers(200, 50)
    back, packed = there_and_back(t, motion, block)
    assert back.tobytes() == motion.tobytes()
    if block == 16:
        assert {one.gain for one in packed[1:]} == {8.0}
        squeezed = sum(len(zstandard.compress(one.data)) for one in packed)
        assert squeezed < motion.nbytes / 4  # a third turns, and then one number of four is new


def test_of_who_takes_a_known_candidate_only_the_choice_is_stored() -> None:
    t, motion, goals, group = deciders(64, 20)
    back, (packed,) = there_and_back(t, motion, 64, [group], goals)
    assert back.tobytes() == motion.tobytes()
    exact = (np.frombuffer(packed.data, np.uint8)[: 64 * 20] >= 128).reshape(64, 20)
    assert exact[1:, :-1].all()
    assert exact[1:, -1].mean() < 0.5


def test_wrong_goals_and_pushes_cost_bytes_and_no_bits() -> None:
    t, motion, goals, group = deciders(40, 6)
    motion[20, 2, 1] += 1e-3
    motion[10:14, :, 2] = np.nan
    goals[30, :, 3] = np.nan
    goals[:, :, 4] = motion[:, :2, 4]  # who is at the goal prefers no direction
    for block in (1, 7):
        back, _ = there_and_back(t, motion, block, [group], goals)
        assert back.tobytes() == motion.tobytes()


@pytest.mark.slow
@settings(max_examples=40)
@given(data=st.data(), n=st.integers(1, 5), block=st.integers(1, 5))
def test_any_numbers_come_back_whatever_the_goals(data: st.DataObject, n: int, block: int) -> None:
    _, _, _, group = deciders(1, 4)
    motion = data.draw(arrays(np.float64, (n, 4, 4), elements=ANY))
    goals = data.draw(arrays(np.float64, (n, 2, 4), elements=ANY))
    back, _ = there_and_back(np.arange(n) / 16.0, motion, block, [group], goals)
    assert back.tobytes() == motion.tobytes()


def test_positions_follow_from_velocities() -> None:
    t, motion = walkers(64, 20)
    _, packed = there_and_back(t, motion, 64)
    data = np.frombuffer(packed[0].data, np.uint8)
    taken, rest = data[: 64 * 20].reshape(64, 20), data[64 * 20 :].reshape(4, 8, -1)
    later = np.count_nonzero(taken[0] < 128)  # the first sample follows from nothing
    assert not rest[:2, 1:, later:].any()  # the lowest byte tells all
    assert rest[2:, 1:, later:].any()


def test_absent_people_and_other_rates() -> None:
    for ticks in (1, 2, 4, 16):
        t, motion = walkers(40, 6, ticks)
        motion[10:20, :, 2] = np.nan
        motion[30, :2, 4] += 50.0
        back, _ = there_and_back(t, motion, 16)
        assert back.tobytes() == motion.tobytes()


def test_data_of_another_size_are_refused() -> None:
    codec = MotionCodec(3)
    with pytest.raises(ValueError, match="2 samples of 3 people"):
        codec.unpack(np.array([0.0, 0.1]), Packed(GAINS[0], bytes(10)))
