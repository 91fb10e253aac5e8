"""Compile the crowd's slowest functions in a second process while a first run prepares.

A run needs them late: first it builds robot, planner and cost functions. They are compiled by
calling them with at most one person, the slowest first, so that two processes rarely compile the
same one.
"""

from __future__ import annotations

from contextlib import AbstractContextManager

import numpy as np

from crowdbot.core.crowd.agents import Agents
from crowdbot.core.crowd.engine import CrowdEngine
from crowdbot.core.crowd.policy import CrowdView
from crowdbot.core.crowd.state import TICK
from crowdbot.core.crowd.velocity_search.candidates import Sampling
from crowdbot.core.crowd.velocity_search.sampling import Sampler
from crowdbot.core.crowd.velocity_search.weighted_costs import WeightedCosts
from crowdbot.core.crowd.world import CrowdWorld
from crowdbot.core.support.compiling.compile_ahead import compiled_ahead
from crowdbot.core.types.arrays import Array


def crowd_compiled_ahead() -> AbstractContextManager[None]:
    """Compile in a second process while the context is open, if nothing is compiled yet."""
    return compiled_ahead(__name__)


class _Chooses:
    """A policy that samples velocities, like those of most crowds, but has no cost functions."""

    def __init__(self, agents: Agents) -> None:
        self._sampler = Sampler(Sampling(), WeightedCosts((), agents))

    def accelerations(self, view: CrowdView) -> Array:
        return self._sampler.choose(view)


def compile_ahead() -> None:
    """Call ticks without robots, a decision, and a tick with a robot, so that they are compiled.

    Only the types matter, which are those of a run.
    """
    nobody = CrowdEngine(Agents.of(x=[], y=[]), CrowdWorld(), _Chooses)
    state = nobody.initial_state()
    state[TICK] = 1.0  # no decision is due
    nobody.advance_alone(state, 1)
    box = np.array([[0.0, 1.0, 0.0, 1.0]])
    person = CrowdEngine(Agents.of(x=0.0, y=0.0), CrowdWorld(entrance=box, out=box + 5.0), _Chooses)
    far_away = np.array([[50.0, 50.0, 0.0, 0.0, 0.3, 0.3, 0.0, 0.0]])
    person.advance(person.initial_state(), far_away)
