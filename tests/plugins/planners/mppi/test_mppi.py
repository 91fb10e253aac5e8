"""MPPI in closed cases: straight, a wall ahead, people who cross and come; and its sampler."""

from __future__ import annotations

import math

import numpy as np
import pytest

from crowdbot.plugins.planners.mppi import rollouts_build as rollouts
from crowdbot.plugins.planners.mppi.mppi import MppiSpec
from crowdbot.plugins.planners.mppi.mppi_build import Mppi, build
from crowdbot.plugins.planners.shared.distance_field_build import DistanceField
from tests.plugins.planners.world import LIMITS, World

TOLD = {"tracks": "truth", "localisation": "truth"}
STATE = (0.0, 0.0, 0.0, 0.5, 0.0, 0.0)


def _mppi(**parameters: object) -> Mppi:
    return build(MppiSpec.model_validate({"kind": "mppi", "samples": 2000, **parameters}))


def test_straight_it_drives_at_full_speed_without_weaving() -> None:
    world = World(goal=(9.0, 0.0))
    out = world.run(_mppi(), time_limit=6.0, stop_at=5.5)
    assert out.arrived
    assert out.t < 3.0 / LIMITS.v_max + 1.0
    assert max(abs(p.y) for p in out.path) < 0.1


def test_a_wall_ahead_stops_it() -> None:
    walls = np.array([[5.0, -5.0, 5.0, 5.0], [0.0, -5.0, 0.0, 5.0]])
    out = World(goal=(9.0, 0.0), walls=walls).run(_mppi(), time_limit=8.0, stop_at=8.0)
    assert out.least_wall_gap > 0.0


@pytest.mark.parametrize("person", [[5.5, -3.6, 0.0, 0.8], [8.0, 0.05, -0.8, 0.0]])
def test_people_who_cross_and_who_come_are_let_past(person: list[float]) -> None:
    world = World([person], goal=(9.0, 0.0), told=True)
    out = world.run(_mppi(**TOLD), time_limit=14.0, stop_at=8.0)
    assert out.arrived
    assert out.contacts == []


def test_who_stands_in_the_way_is_driven_around_on_one_side() -> None:
    """The mean of plans on both sides would lead into the person."""
    world = World([[5.0, 0.0, 0.0, 0.0]], goal=(9.0, 0.0), told=True)
    out = world.run(_mppi(**TOLD), time_limit=12.0, stop_at=7.5)
    assert out.arrived
    assert out.contacts == []


def _around() -> tuple[rollouts.Around, np.ndarray, rollouts.Samples]:
    planner = _mppi(samples=500)
    world = World()
    planner.reset(world.task, LIMITS, {n: s.info() for n, s in world.sensors.items()}, 3)
    field = DistanceField()
    field.fill(np.array([[1.2, 0.6], [1.3, -0.7]]), 0.0, 0.0)
    people = np.array([[1.5, 0.2, -0.5, 0.0, 0.25], [1.0, -1.5, 0.0, 0.8, 0.25]])
    robot = np.array([[0.0, 0.0, 0.2]])
    around = rollouts.Around(people, field.values, field.corner, robot, (9.0, 0.0))
    return around, planner._p, planner._samples


def test_a_rollout_ends_early_only_if_it_costs_more_than_counts() -> None:
    around, p, samples = _around()
    rollouts._predict(around, p, STATE, samples)
    touch = 0.05
    full = [rollouts._cost(around, p, STATE, samples, b, (touch, touch, math.inf))
            for b in range(100)]  # fmt: skip
    bound = float(np.median(full))
    for b, cost in enumerate(full):
        short = rollouts._cost(around, p, STATE, samples, b, (touch, touch, bound))
        assert short == cost if cost <= bound else short in (cost, math.inf)
    ended = [rollouts._cost(around, p, STATE, samples, b, (touch, touch, min(full)))
             for b in range(100)]  # fmt: skip
    assert ended.count(math.inf) > 20


def test_the_new_plan_is_the_weighted_mean_of_all_rollouts() -> None:
    around, p, samples = _around()
    samples.plan[:, 0] = 0.4
    before, simple = samples.plan.copy(), samples.simple.copy()
    least = rollouts.improve(around, p, STATE, samples)
    weights, knots, steps = samples.costs, samples.noise.shape[1], len(before)
    assert least > 0.0
    assert weights.max() == 1.0
    at = np.linspace(0.0, steps - 1, knots)
    noise = np.array([[np.interp(np.arange(steps), at, row[:, c]) for c in (0, 1)]
                      for row in samples.noise])  # fmt: skip
    noisy = before[None, :, :2] + noise.transpose(0, 2, 1) * [
        p[rollouts.V_NOISE],
        p[rollouts.W_NOISE],
    ]
    everything = np.concatenate([noisy, simple[:, :, :2]])
    mean = (weights[:, None, None] * everything).sum(axis=0) / weights.sum()
    mean[:, 0] = np.clip(mean[:, 0], p[rollouts.V_MIN], p[rollouts.TOP])
    assert samples.plan[:, :2] == pytest.approx(mean, abs=1e-6)
