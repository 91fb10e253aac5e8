"""The compiled and the vectorised cost are one function."""

from __future__ import annotations

import numpy as np
from crowdbot.testing import costs_at, random_view

from crowdbot_acme import personal_space_build, personal_space_numpy_build
from crowdbot_acme.personal_space import PersonalSpaceNumpySpec, PersonalSpaceSpec


def test_both_cost_the_same() -> None:
    compiled = personal_space_build.build(PersonalSpaceSpec())
    vectorised = personal_space_numpy_build.build(PersonalSpaceNumpySpec())
    for seed in range(10):
        view = random_view(seed)
        velocities = np.random.default_rng(seed).uniform(-1.5, 1.5, (len(view.agents), 20, 2))
        one, two = (costs_at(cost, view, velocities) for cost in (compiled, vectorised))
        np.testing.assert_allclose(one, two, rtol=1e-9)
        assert one.max() > 1.0
