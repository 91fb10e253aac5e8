"""Which worlds each thread steps."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from crowdbot.core.batch.parallel import parts_of


@given(st.integers(1, 200), st.integers(1, 16), st.integers(0, 500))
def test_every_world_has_one_thread_and_every_thread_a_world(
    worlds: int, threads: int, people: int
) -> None:
    parts = parts_of(worlds, threads, people)
    assert [w for first, end in parts for w in range(first, end)] == list(range(worlds))
    assert len(parts) == min(worlds, threads)
    sizes = [end - first for first, end in parts]
    assert min(sizes) >= 1
    assert sizes[0] >= max(sizes) - 1
    assert max(sizes[1:], default=0) - min(sizes[1:], default=0) <= 1


def test_the_thread_that_need_not_wake_up_steps_a_hundred_people_more() -> None:
    assert parts_of(64, 2, 19) == [(0, 34), (34, 64)]
    assert parts_of(64, 2, 1000) == [(0, 32), (32, 64)]
    assert parts_of(3, 2, 0) == [(0, 2), (2, 3)]
