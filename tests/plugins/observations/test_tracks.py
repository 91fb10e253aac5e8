"""The compiled rows of the nearest people, against numpy."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from crowdbot.core.learning.seen import LearningContext, RobotInputs
from crowdbot.core.types.robot import RobotBody, RobotLimits
from crowdbot.plugins.observations.tracks import TracksSpec
from crowdbot.plugins.observations.tracks_build import build

LIMITS = RobotLimits(v_min=-0.2, v_max=0.8, w_max=1.0, a_max=1.0, alpha_max=2.0)
BODY = RobotBody(
    drive="differential", radius=0.2, footprint=None, front=0.2, back=0.2, half_width=0.2
)
SPEC = TracksSpec(people=4, range=3.0, fastest=1.5)


def _expected(people: Any, pose: Any) -> Any:
    """Return the rows (K, 6) of the nearest people (M, 5) of one world."""
    offset = people[:, :2] - pose[:2]
    away = np.hypot(*offset.T)
    turn = np.array([[np.cos(pose[2]), np.sin(pose[2])], [-np.sin(pose[2]), np.cos(pose[2])]])
    found = np.zeros((SPEC.people, 6))
    near = [j for j in np.argsort(away, kind="stable") if away[j] <= SPEC.range]
    for row, j in zip(found, near, strict=False):
        velocity = np.clip(turn @ people[j, 2:4] / SPEC.fastest, -1.0, 1.0)
        row[:] = 1.0, *(turn @ offset[j] / SPEC.range), *velocity, people[j, 4]
    return found


@pytest.mark.parametrize("count", [0, 2, 4, 30])
def test_the_nearest_people_come_first_in_the_robots_frame(count: int) -> None:
    rng, worlds = np.random.default_rng(count), 5
    people = rng.uniform(-4.0, 4.0, (worlds, count, 5))
    people[rng.random((worlds, count)) < 0.2] = np.nan  # absent
    people[:, 1::7] = people[:, ::7][:, : len(people[0, 1::7])]  # equally far
    pose = rng.uniform(-2.0, 2.0, (worlds, 3))
    none = np.zeros(worlds, np.bool_)
    seen = RobotInputs(
        fresh=none, stepped=~none, pose=pose, twist=np.zeros((worlds, 3)),
        goal=np.ones((worlds, 2)), people=people,
    )  # fmt: skip
    found = build(SPEC, LearningContext(worlds=worlds, limits=LIMITS, body=BODY)).observe(seen)
    assert found.dtype == np.float32
    for w in range(worlds):
        assert found[w, :24].reshape(4, 6) == pytest.approx(_expected(people[w], pose[w]), abs=1e-6)
