"""How differences lie in the bytes of a recording: as documented, and back again."""

from __future__ import annotations

import numpy as np

from crowdbot.core.recording.motion.difference_bytes import EXACT, carry, mark_exact


def test_differences_lie_byte_by_byte_without_those_that_are_nothing() -> None:
    rng = np.random.default_rng(5)
    taken = rng.integers(0, 100, (6, 7)).astype(np.uint8)
    difference = rng.integers(-(2**63), 2**63 - 1, (4, 6, 7))
    difference[:, rng.random((6, 7)) < 0.6] = 0
    difference[1:, 2, 3] = 0  # one number of four differs
    difference[0, 2, 3] = -1
    others = difference.any(axis=0)
    plain, marked = taken.copy(), np.where(others, taken, taken | EXACT)

    count = mark_exact(taken, difference)
    data = np.empty(taken.size + 32 * count, np.uint8)
    carry(True, taken, difference, data)
    rest = np.ascontiguousarray(difference[:, others], "<i8")
    planes = rest.view(np.uint8).reshape(4, count, 8)
    assert count == others.sum() > 5
    assert data.tobytes() == marked.tobytes() + planes.transpose(0, 2, 1).tobytes()

    back = np.zeros_like(taken), np.zeros_like(difference)
    carry(False, *back, data)
    assert np.array_equal(back[0], plain)
    assert np.array_equal(back[1], difference)
