"""MPPI in closed cases: straight, a wall ahead, people who cross and come; and its sampler."""

from __future__ import annotations

import math

import numpy as np
import pytest

from crowdbot.plugins.planners.mppi import rollouts_build as rollouts
from crowdbot.plugins.planners.mppi import samples_build
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
    world = World([person], goal=(9.0, 0.0), truth=True)
    out = world.run(_mppi(**TOLD), time_limit=14.0, stop_at=8.0)
    assert out.arrived
    assert out.contacts == []


def test_who_stands_in_the_way_is_driven_around_on_one_side() -> None:
    """The mean of plans on both sides would lead into the person."""
    world = World([[5.0, 0.0, 0.0, 0.0]], goal=(9.0, 0.0), truth=True)
    out = world.run(_mppi(**TOLD), time_limit=12.0, stop_at=7.5)
    assert out.arrived
    assert out.contacts == []


def _around() -> tuple[rollouts.RolloutObstacles, np.ndarray, samples_build.Samples]:
    planner = _mppi(samples=500)
    world = World()
    planner.reset(world.task, LIMITS, {n: s.info() for n, s in world.sensors.items()}, 3)
    field = DistanceField()
    field.fill(np.array([[1.2, 0.6], [1.3, -0.7]]), 0.0, 0.0)
    people = np.array([[1.5, 0.2, -0.5, 0.0, 0.25], [1.0, -1.5, 0.0, 0.8, 0.25]])
    robot = np.array([[0.0, 0.0, 0.2]])
    around = rollouts.RolloutObstacles(people, field.values, field.corner, robot, (9.0, 0.0))
    return around, planner._p, planner._samples


def test_a_rollout_ends_early_only_if_it_costs_more_than_counts() -> None:
    around, p, samples = _around()
    rollouts._predict(around, p, STATE, samples)
    samples_build.drive(around.goal, p, STATE, samples, 0, True)

    def costs(bound: float) -> list[float]:
        need = 0.05, 0.05, bound
        return [rollouts._cost(around, p, samples, i, 9.0, need) for i in range(100)]

    full = costs(math.inf)
    bound = float(np.median(full))
    for cost, short in zip(full, costs(bound), strict=True):
        assert short == cost if cost <= bound else short in (cost, math.inf)
    assert costs(min(full)).count(math.inf) > 20


@pytest.mark.parametrize("vy_max", [0.0, 0.4])
def test_lanes_move_as_one_rollout_does(vy_max: float) -> None:
    around, p, samples = _around()
    p[samples_build.VY_MAX] = vy_max
    samples.plan[:] = 0.3, 0.2, 0.1
    samples_build.drive(around.goal, p, STATE, samples, 0, True)
    steps, knots = len(samples.plan), samples.noise.shape[0]
    sizes = [p[samples_build.V_NOISE], p[samples_build.W_NOISE], p[samples_build.V_NOISE]]
    low = [p[samples_build.V_MIN], -p[samples_build.W_MAX], -vy_max]
    high = [p[samples_build.TOP], p[samples_build.W_MAX], vy_max]
    slew = (
        np.array([p[samples_build.A_MAX], p[samples_build.ALPHA_MAX], p[samples_build.A_MAX]])
        * p[samples_build.DT]
    )
    at = np.linspace(0.0, steps - 1, knots)
    for i in (0, 7, 99):
        noise = samples.noise[:, :, i]
        x, y, yaw, twist = 0.0, 0.0, 0.0, np.array(STATE[3:])
        for n in range(steps):
            more = [size * np.interp(n, at, noise[:, k]) for k, size in enumerate(sizes)]
            wish = np.clip(samples.plan[n] + more, low, high)
            twist = np.clip(wish, twist - slew, twist + slew)
            yaw += twist[1] * p[samples_build.DT]
            x += (twist[0] * math.cos(yaw) - twist[2] * math.sin(yaw)) * p[samples_build.DT]
            y += (twist[0] * math.sin(yaw) + twist[2] * math.cos(yaw)) * p[samples_build.DT]
        lane = samples.lanes
        assert (lane.x[i], lane.y[i], lane.v[i]) == pytest.approx((x, y, twist[0]), abs=1e-3)


def test_the_new_plan_is_the_weighted_mean_of_all_rollouts() -> None:
    around, p, samples = _around()
    samples.plan[:, 0] = 0.4
    before, simple = samples.plan.copy(), samples.simple.copy()
    least = rollouts.improve(around, p, STATE, samples)
    weights, knots, steps = samples.costs, samples.noise.shape[0], len(before)
    assert least > 0.0
    assert weights.max() == 1.0
    at = np.linspace(0.0, steps - 1, knots)
    noise = np.array([[np.interp(np.arange(steps), at, row[:, c]) for c in (0, 1)]
                      for row in samples.noise.transpose(2, 0, 1)[:500]])  # fmt: skip
    noisy = before[None, :, :2] + noise.transpose(0, 2, 1) * [
        p[samples_build.V_NOISE],
        p[samples_build.W_NOISE],
    ]
    everything = np.concatenate([noisy, simple[:, :, :2]])
    mean = (weights[:, None, None] * everything).sum(axis=0) / weights.sum()
    mean[:, 0] = np.clip(mean[:, 0], p[samples_build.V_MIN], p[samples_build.TOP])
    assert samples.plan[:, :2] == pytest.approx(mean, abs=1e-6)
