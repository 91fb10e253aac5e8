"""A run is freed with its last reference, without garbage collection."""

from __future__ import annotations

import gc
import weakref
from collections.abc import Iterator

import numpy as np
import pytest

from crowdbot.core.trajectories.evasion import ghost_run
from crowdbot.core.trajectories.preprocess import truncate_at_arrival, with_velocities
from crowdbot.core.trajectories.trajectories import Trajectories


@pytest.fixture(autouse=True)
def _no_collections() -> Iterator[None]:
    gc.disable()
    yield
    gc.enable()


def _run() -> Trajectories:
    row, people = np.linspace(0.0, 1.0, 9), np.zeros((9, 2))
    return Trajectories.from_arrays(
        t=row, robot_x=row, robot_y=row, robot_theta=row, robot_radius=0.2, robot_mass=9.0,
        robot_goal_time=None, agent_id=[0, 1], agent_x=people, agent_y=people + 1.0,
        agent_radius=[0.2, 0.2], agent_mass=[70.0, 70.0],
    )  # fmt: skip


def test_a_run_whose_cache_names_the_run_itself() -> None:
    run = with_velocities(_run())
    assert truncate_at_arrival(run) is run
    assert truncate_at_arrival(run) is run  # from the cache
    times = weakref.ref(run.t)
    del run
    assert times() is None


def test_a_run_with_a_ghost() -> None:
    run, alone = _run(), _run()
    both = ghost_run(run, alone)
    assert both is not None
    assert both[0] is run
    times = weakref.ref(run.t)
    del run, both
    assert times() is None
