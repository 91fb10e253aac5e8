"""Numbers that nothing real has."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from crowdbot.core.registry.registry import discover
from crowdbot.core.scoring.evaluate import score
from crowdbot.core.trajectories.sizes import check_sizes
from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.errors import InputError

RUN: dict[str, Any] = {
    "t": [0.0, 1.0], "robot_x": [0.0, 1.0], "robot_y": [0.0, 0.0], "robot_theta": [0.0, 0.0],
    "robot_radius": 0.2, "robot_mass": 10.0, "agent_x": [[0.0], [1.0]], "agent_y": [[0.0], [1.0]],
    "agent_vx": [[0.0], [0.0]], "agent_vy": [[0.0], [0.0]], "agent_radius": 0.3,
    "agent_mass": 75.0,
}  # fmt: skip


@pytest.mark.parametrize(
    ("changes", "name"),
    [
        ({"robot_x": [0.0, 1e300]}, "robot_x has a number beyond 1e\\+12"),
        ({"agent_vy": [[0.0], [-1e155]]}, "agent_vy"),
        ({"robot_mass": 1e308}, "robot_mass"),
        ({"agent_radius": 1e13}, "agent_radius"),
        ({"t": [0.0, 1e30]}, "t has a number beyond 1e\\+20"),
    ],
)
def test_what_would_overflow_is_refused_by_name(changes: dict[str, Any], name: str) -> None:
    run = Trajectories.from_arrays(**{**RUN, **changes})
    with pytest.raises(InputError, match=f"trajectories: {name}"):
        score(discover(allow=()), run, metrics="spl")


def test_what_units_make_large_is_left_to_the_warnings() -> None:
    large = {"t": [1.7e18, 1.8e18], "robot_x": [5e9, 5e9], "robot_y": [np.nan, np.inf]}
    check_sizes(Trajectories.from_arrays(**{**RUN, **large}))
