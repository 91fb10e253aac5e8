"""Trips belong to people who exist."""

from __future__ import annotations

import numpy as np
import pytest

from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.errors import InputError


def run(*travellers: int) -> Trajectories:
    walk = np.arange(6.0).reshape(3, 2)
    n = len(travellers)
    return Trajectories.from_arrays(
        t=np.arange(3.0), agent_x=walk, agent_y=walk, agent_id=[4, 9], agent_radius=0.3,
        agent_mass=70.0, trip_agent=list(travellers), trip_t0=[0.0] * n, trip_t1=[1.0] * n,
        trip_reached=[True] * n,
    )  # fmt: skip


def test_trips_of_people_who_are_there() -> None:
    trips = run(9, 4, 9).trips
    assert trips is not None
    assert trips.agent.tolist() == [9, 4, 9]
    assert run().trips is not None


@pytest.mark.parametrize("who", [(0,), (4, 1), (9, -1)])
def test_trips_of_nobody_are_refused(who: tuple[int, ...]) -> None:
    with pytest.raises(InputError, match="trip_agent has ids that no agent_id has"):
        run(*who)


def test_what_metrics_get_cannot_be_written_to() -> None:
    found = run(4)
    assert found.agents is not None
    assert found.trips is not None
    for array in (found.t, found.agents.x, found.agents.id, found.trips.t0):
        with pytest.raises(ValueError, match="WRITEABLE"):
            array.setflags(write=True)
