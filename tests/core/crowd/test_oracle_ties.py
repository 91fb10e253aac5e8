"""Two ways in which the comparison with the original engine went wrong by rounding."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from crowdbot.core.crowd.agents import Agents
from crowdbot.core.crowd.build import build_cost
from crowdbot.core.crowd.velocity_search.evaluate import Evaluator
from crowdbot.core.crowd.velocity_search.weighted_costs import WeightedCosts
from crowdbot.core.registry.registry import discover
from crowdbot.plugins.crowd.cost_functions.social_forces_avoidance import SocialForcesAvoidanceSpec
from crowdbot.testing.crowd_views import random_view
from scripts.crowd_oracle.judge import CLOSE, PERTURBATION, by_perturbed_input

pytestmark = pytest.mark.slow


def test_a_corner_is_counted_once_wherever_it_lies() -> None:
    """Two edges of an outline end in one corner, which is nearest; the original takes one of them.

    The nearest point is worked out along each edge, so that rounding decides whether it is the
    edge's end to the last digit.
    """
    cost = build_cost(discover(allow=()), SocialForcesAvoidanceSpec())
    velocities = np.array([[[0.5, 0.0], [0.0, 0.5], [-1.0, 0.3]]])
    rng, totals = np.random.default_rng(3), []
    for _ in range(200):
        shift = rng.uniform(-30.0, 30.0, 2)
        corner = shift + np.array([1.0, 0.4])
        ends = shift + np.array([[7.3, 0.9], [1.7, 6.1]])
        goal = shift + np.array([9.0, 0.0])
        walls = np.array([[*ends[1], *corner], [*corner, *ends[0]]])
        agents = Agents.of(x=shift[:1], y=shift[1:], routes=[[(goal[0], goal[1])]])
        view = replace(
            random_view(0, count=1), agents=agents, position=shift[np.newaxis],
            velocity=np.array([[1.0, 0.0]]), goal=goal[np.newaxis],
            present=np.ones(1, np.bool_), robot=np.zeros((0, 5)), walls=walls,
            pillars=np.zeros((0, 3)),
        )  # fmt: skip
        for outline in (walls, walls[:, [2, 3, 0, 1]]):
            costs = WeightedCosts([cost], agents, relaxation_time=0.5, parity=True)
            found = Evaluator(costs).total(replace(view, walls=outline), velocities)[0]
            totals.append(found)
    for way in (totals[::2], totals[1::2]):
        assert np.ptp(np.array(way), axis=0) == pytest.approx(np.zeros(3), abs=1e-9)


class Fussy:
    """Does as the original only if one neighbour moves and no other does."""

    case = SimpleNamespace(dt=0.1, periodic_boundary=None)

    def __init__(self, start: np.ndarray[Any, Any]) -> None:
        self.start, self.calls = start, 0

    def restore(self, random: object) -> None:
        del random

    def step(self, state: Any, who: Any = None) -> Any:
        del who
        self.calls += 1
        moved = np.any(state != self.start, axis=1)
        assert np.abs(state - self.start).max() <= PERTURBATION
        alone = moved[3] and not moved[[0, 1, 2, 4, 5]].any()
        return self.start + (0.0 if alone else 10.0 * CLOSE)


def test_one_subset_of_the_people_is_shaken_at_a_time() -> None:
    start = np.arange(24.0).reshape(6, 4)
    stepper = Fussy(start)
    who = np.array([True] + [False] * 5)
    found = by_perturbed_input(cast(Any, stepper), start, start, [], who)
    assert found.tolist() == who.tolist()
    assert stepper.calls > 256
