"""CompiledWalk: the same numbers as one decision of the engine after the other."""

from __future__ import annotations

import numpy as np
import pytest

from crowdbot.core.batch.imagined_crowd import ImaginedCrowd
from crowdbot.core.types.arrays import Array, Mask

SPEEDS = np.repeat(np.linspace(0.3, 1.9, 6), 4)
STEP = 0.32


def _scene(seed: int) -> tuple[Array, Array, Array, Mask, Array]:
    rng = np.random.default_rng(seed)
    position, velocity = rng.uniform(-3, 3, (24, 2)), rng.normal(0.0, 0.7, (24, 2))
    goal, present = position + 20.0 * velocity, rng.random(24) < 0.8
    goal[0] = position[0]  # who has arrived
    robots = np.column_stack([rng.uniform(-1, 1, (4, 2)), rng.normal(0.0, 0.4, (4, 2))])
    return position, velocity, goal, present, robots


@pytest.mark.slow
@pytest.mark.parametrize("name", ["calibrated", "human", "giving_way"])
def test_it_equals_single_decisions_bit_by_bit(name: str) -> None:
    crowd = ImaginedCrowd(name, SPEEDS)
    assert crowd.is_compiled
    for seed in range(8):
        position, velocity, goal, present, robots = _scene(seed)
        given = [a.copy() for a in (position, velocity, goal)]
        places, speeds, pulls = crowd.walk(*_scene(seed), 0.3, STEP)
        for k, (x, y, vx, vy) in enumerate(robots.tolist()):
            robot = np.array([[x, y, vx, vy, 0.3, 0.3, 0.0, 0.0]])
            pull = crowd.accelerations(position, velocity, goal, present, robot)
            assert np.array_equal(places[k], position)
            assert np.array_equal(speeds[k], velocity)
            assert np.array_equal(pulls[k], pull)
            after = velocity + STEP * pull
            position, velocity = position + 0.5 * STEP * (velocity + after), after
        assert np.any(pulls)
        assert not np.any(pulls[:, ~present])
        assert all(np.array_equal(a, b) for a, b in zip(given, _scene(seed), strict=False))


def test_crowds_that_do_not_sample_walk_too() -> None:
    crowd = ImaginedCrowd("social_forces", SPEEDS)
    assert not crowd.is_compiled
    position, velocity, goal, present, robots = _scene(1)
    places, _, pulls = crowd.walk(position, velocity, goal, present, robots, 0.3, STEP)
    assert np.array_equal(places[0], position)
    assert np.any(pulls[0])
    _, _, unseen = crowd.walk(position, velocity, goal, present, robots, None, STEP)
    assert np.array_equal(unseen[0], crowd.accelerations(position, velocity, goal, present))
