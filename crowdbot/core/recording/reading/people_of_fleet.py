"""Add the people of a recording with several robots to the run of one robot."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from crowdbot.core.support.immutable import immutable
from crowdbot.core.trajectories.tracks import AgentTracks, Trips
from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.errors import InputError


def among(own: Trajectories, people: Trajectories, until: float) -> Trajectories:
    """Return one robot's run with the people, cut at its end.

    Args:
        own: run of the robot alone.
        people: run of the people alone, with the same sample times, perhaps longer.
        until: end of the robot's run, s.

    Raises:
        InputError: the sample times differ.
    """
    count, agents, trips = len(own.t), people.agents, people.trips
    if len(people.t) < count or not np.array_equal(own.t, people.t[:count]):
        raise InputError("robots and people are not sampled at the same times")
    if agents is None or trips is None:
        return own
    cut = trips.t1 > until
    row = np.argsort(np.argsort(agents.id))[np.searchsorted(np.sort(agents.id), trips.agent)]
    going_on = np.flatnonzero(cut & (trips.t0 <= until))
    begun = np.concatenate([np.flatnonzero(~cut), going_on[np.argsort(row[going_on])]])
    return replace(
        own,
        agents=AgentTracks(
            id=agents.id, radius=agents.radius, mass=agents.mass,
            x=immutable(agents.x[:count]), y=immutable(agents.y[:count]),
            vx=immutable(agents.vx[:count]), vy=immutable(agents.vy[:count]),
            jump=None if agents.jump is None else immutable(agents.jump[: count - 1]),
        ),
        trips=Trips(
            agent=immutable(trips.agent[begun]),
            t0=immutable(trips.t0[begun]),
            t1=immutable(np.minimum(trips.t1, until)[begun]),
            reached=immutable((trips.reached & ~cut)[begun]),
        ),
    )  # fmt: skip
