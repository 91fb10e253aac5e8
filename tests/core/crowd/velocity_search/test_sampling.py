"""The sampler's shortcuts change nothing: it takes what an exhaustive search takes."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from crowdbot.core.crowd.policy import CrowdView
from crowdbot.core.crowd.velocity_search.agent_costs import LOWER_BOUNDS
from crowdbot.core.crowd.velocity_search.candidates import CURRENT, MAXIMUM_SPEED, Sampling, fan
from crowdbot.core.crowd.velocity_search.sampling import Sampler
from crowdbot.core.crowd.velocity_search.weighted_costs import WeightedCosts
from crowdbot.plugin import CostFunctionSpec, Range
from crowdbot.plugins.crowd.cost_functions.moussaid import MoussaidSpec
from crowdbot.plugins.crowd.cost_functions.rvo import RvoSpec
from crowdbot.plugins.crowd.cost_functions.ttca_dca.ttca_dca import TtcaDcaSpec
from crowdbot.plugins.crowd.policies.velocity_space import VelocitySpaceSpec
from crowdbot.plugins.crowd.policies.velocity_space_build import VelocitySpace
from tests.core.crowd.crowd_reference import Array, agents_of, choice_costs
from tests.core.crowd.oracle_cases import compiled

WALLS = np.array([[-1.0, -5.0, 51.0, -5.0], [51.0, 5.0, -1.0, 5.0]])
FAN = fan(4, 19, math.pi)
REFLEX = RvoSpec(range=Range(value=0.3, measure="surface"))
MIXES: dict[str, list[CostFunctionSpec]] = {
    f"c{weight:g}-r{reach:g}": [
        TtcaDcaSpec(
            weight=weight, range=Range(value=reach), sigma_ttca=0.3, sigma_dca=0.3,
            sigma_angle_goal=3.0, sigma_speed_goal=0.01,
        ),
        REFLEX,
    ]
    for weight, reach in ((1.0, 2.0), (20.0, 5.0), (50.0, 10.0))
}  # fmt: skip
MIXES["ttca_dca alone"] = [TtcaDcaSpec(weight=20.0)]
MIXES["rvo alone"] = [RvoSpec(range=Range(value=4.0))]
MIXES["wide rvo"] = [TtcaDcaSpec(weight=5.0), RvoSpec(weight=3.0, range=Range(value=6.0))]
MIXES["no weight"] = [TtcaDcaSpec(weight=0.0, range=Range(value=8.0)), REFLEX]


def scene(seed: int, count: int = 60, robots: int = 1, length: float = 12.0) -> CrowdView:
    """A dense patch of a corridor, some people waiting outside."""
    rng = np.random.default_rng(seed)
    position = np.column_stack([rng.uniform(5.0, 5.0 + length, count), rng.uniform(-5, 5, count)])
    heading = rng.normal(0.0, 0.6, count)
    speed = rng.uniform(0.0, 1.8, count)
    agents = agents_of(position, rng.uniform(0.6, 1.6, count), rng.uniform(0.2, 0.4, count))
    return CrowdView(
        agents=agents,
        position=position,
        velocity=np.column_stack([np.cos(heading), np.sin(heading)]) * speed[:, np.newaxis],
        goal=np.column_stack([np.full(count, 50.6), rng.uniform(-4.6, 4.6, count)]),
        present=rng.random(count) > 0.1,
        robot=np.column_stack(
            [rng.uniform(6, 10, robots), rng.uniform(-2, 2, robots),
             rng.uniform(-0.6, 0.6, (robots, 2)), np.full(robots, 0.428)]
        ),
        walls=WALLS,
        dt=1.0 / 16.0,
    )  # fmt: skip


def choose(view: CrowdView, mix: list[CostFunctionSpec]) -> Array:
    return Sampler(Sampling(), WeightedCosts([compiled(c) for c in mix], view.agents)).choose(view)


@pytest.mark.parametrize("mix", list(MIXES))
@pytest.mark.parametrize("seed", range(4))
def test_takes_the_exhaustive_minimum(mix: str, seed: int) -> None:
    view = scene(seed)
    chosen = choose(view, MIXES[mix])
    for i in np.flatnonzero(view.present):
        u, total = choice_costs(view, MIXES[mix], FAN, int(i))
        taken = int(np.argmin(np.hypot(*(u - chosen[i]).T)))
        assert np.hypot(*(u[taken] - chosen[i])) < 1e-9
        assert total[taken] <= np.min(total) + 1e-9 * max(1.0, abs(np.min(total)))
    assert not np.any(chosen[~view.present])


@pytest.mark.parametrize("mix", list(MIXES))
@pytest.mark.parametrize(
    "sampling", [Sampling(), Sampling(base=CURRENT, radius=MAXIMUM_SPEED), Sampling(random=40)]
)
def test_lower_bounds_change_no_choice(mix: str, sampling: Sampling) -> None:
    """To the last bit, with less to evaluate."""
    costs = [compiled(c) for c in MIXES[mix]]
    for seed in range(4):
        view = scene(seed, 80)
        with_bounds = WeightedCosts(costs, view.agents)
        assert np.any(with_bounds.functions[:, LOWER_BOUNDS])
        without = WeightedCosts([replace(c, lower_bound=None) for c in costs], view.agents)
        found, expected = (Sampler(sampling, m).choose(view) for m in (with_bounds, without))
        assert np.array_equal(found, expected)


@pytest.mark.parametrize("d_max", [0.4, 2.5, 10.0])
@pytest.mark.parametrize("relaxation", [0.0, 0.5, 3.0])
@pytest.mark.parametrize("sampling", [Sampling(), Sampling(random=40)])
def test_lower_bounds_of_moussaid_change_no_choice(
    d_max: float, relaxation: float, sampling: Sampling
) -> None:
    cost = compiled(MoussaidSpec(d_max=d_max))
    for count in (6, 80):
        view = scene(count, count)
        costs = [cost, replace(cost, lower_bound=None)]
        bounded, whole = (
            WeightedCosts([c], view.agents, relaxation_time=relaxation) for c in costs
        )
        assert np.any(bounded.functions[:, LOWER_BOUNDS])
        found, expected = (Sampler(sampling, m).choose(view) for m in (bounded, whole))
        assert np.array_equal(found, expected)


def test_equal_costs_go_to_the_first_candidate() -> None:
    """Standing still in front, then slow to fast, right to left: as the original engine does."""
    view = replace(scene(0, 1, 0), present=np.ones(1, np.bool_))
    free: list[CostFunctionSpec] = [TtcaDcaSpec(weight=0.0)]
    assert np.array_equal(choose(view, free), np.zeros((1, 2)))


def _turned(view: CrowdView, matrix: Array, shift: Array) -> CrowdView:
    robot = view.robot.copy()
    robot[:, :2] = view.robot[:, :2] @ matrix.T + shift
    robot[:, 2:4] = view.robot[:, 2:4] @ matrix.T
    walls = np.concatenate(
        [view.walls[:, :2] @ matrix.T + shift, view.walls[:, 2:] @ matrix.T + shift], axis=1
    )
    return replace(
        view,
        position=view.position @ matrix.T + shift,
        velocity=view.velocity @ matrix.T,
        goal=view.goal @ matrix.T + shift,
        robot=robot,
        walls=walls,
    )


TURNS = {
    "moved": (np.eye(2), np.array([3.0, -8.0])),
    "turned by 90 degrees": (np.array([[0.0, -1.0], [1.0, 0.0]]), np.zeros(2)),
    "turned by 180 degrees": (-np.eye(2), np.zeros(2)),
    "mirrored": (np.array([[1.0, 0.0], [0.0, -1.0]]), np.zeros(2)),
}


@pytest.mark.parametrize("turn", list(TURNS))
@pytest.mark.parametrize("mix", ["c1-r2", "c50-r10", "wide rvo"])
def test_the_frame_does_not_matter(turn: str, mix: str) -> None:
    matrix, shift = TURNS[turn]
    view = scene(5)
    expected = choose(view, MIXES[mix]) @ matrix.T
    other = _turned(view, matrix, shift)
    found = choose(other, MIXES[mix])
    for i in np.flatnonzero(np.hypot(*(found - expected).T) > 1e-6):  # only by an exact tie
        u, total = choice_costs(other, MIXES[mix], FAN, int(i))
        costs = [total[np.argmin(np.hypot(*(u - v).T))] for v in (found[i], expected[i])]
        assert math.isclose(*costs, rel_tol=1e-9)


@pytest.mark.parametrize("mix", ["c1-r2", "c50-r10", "rvo alone"])
def test_the_order_of_agents_does_not_matter(mix: str) -> None:
    view = scene(6)
    order = np.random.default_rng(1).permutation(len(view.agents))
    a = view.agents
    shuffled = replace(
        view,
        agents=replace(
            a, preferred_speed=a.preferred_speed[order], radius=a.radius[order],
            max_speed=a.max_speed[order], max_acceleration=a.max_acceleration[order],
            avoided_radius=a.avoided_radius[order],
        ),
        position=view.position[order], velocity=view.velocity[order],
        goal=view.goal[order], present=view.present[order],
    )  # fmt: skip
    assert np.array_equal(choose(shuffled, MIXES[mix]), choose(view, MIXES[mix])[order])


def policy(view: CrowdView, mix: list[CostFunctionSpec]) -> Array:
    made = VelocitySpace(VelocitySpaceSpec(), [compiled(c) for c in mix], view.agents)
    return made.accelerations(view)


@pytest.mark.parametrize("mix", list(MIXES))
def test_awkward_places(mix: str) -> None:
    """Coincident people, people on walls, at their goals, inside a robot, far out of range."""
    view = scene(7, 40)
    position, velocity, goal = view.position.copy(), view.velocity.copy(), view.goal.copy()
    position[1], position[2] = position[0], position[0]
    velocity[2] = velocity[1] = velocity[0] = 0.0
    position[3:6, 1] = (-5.0, 5.0, -5.3)
    goal[6], goal[7] = position[6], position[7] + [0.1, 0.0]
    position[8] = view.robot[0, :2]
    position[9] = position[10] + [0.33 + 0.33, 0.0]
    goal[11] = position[11] + [1e-300, 0.0]
    position[12] = (1e6, -1e6)
    found = policy(
        replace(
            view, position=position, velocity=velocity, goal=goal, present=np.ones(40, np.bool_)
        ),
        MIXES[mix],
    )
    assert np.all(np.isfinite(found))
    assert np.max(np.hypot(*found.T)) <= 5.0 + 1e-9


def test_arrived_people_brake() -> None:
    view = replace(scene(8, 2, 0), velocity=np.array([[0.2, 0.1], [3.0, 0.0]]))
    view = replace(view, goal=view.position.copy(), present=np.ones(2, np.bool_))
    found = policy(view, MIXES["c1-r2"])
    assert np.allclose(found[0], -view.velocity[0] * 16.0)
    assert np.allclose(found[1], [-5.0, 0.0])


@pytest.mark.parametrize("robots", [0, 1])
@pytest.mark.parametrize("count", [0, 1])
def test_few_or_no_people(count: int, robots: int) -> None:
    view = replace(scene(9, count, robots), present=np.ones(count, np.bool_))
    view = replace(view, walls=np.zeros((0, 4)))
    assert policy(view, MIXES["c20-r5"]).shape == (count, 2)


def test_alone_everybody_walks_straight_to_the_goal() -> None:
    view = replace(scene(10, 1, 0), present=np.ones(1, np.bool_))
    to_goal = view.goal[0] - view.position[0]
    expected = to_goal / np.hypot(*to_goal) * view.agents.preferred_speed[0]
    for mix in ("ttca_dca alone", "rvo alone"):
        assert np.allclose(choose(view, MIXES[mix])[0], expected)


def test_the_fan() -> None:
    candidates = fan(4, 19, math.pi)
    assert candidates.shape == (1 + 3 * 19, 2)
    assert not np.any(candidates[0])
    speed, angle = np.hypot(*candidates[1:].T), np.arctan2(candidates[1:, 1], candidates[1:, 0])
    assert np.allclose(speed.reshape(3, 19), np.array([[1.0], [2.0], [3.0]]) / 3.0)
    assert np.allclose(angle.reshape(3, 19), np.linspace(-math.pi / 2, math.pi / 2, 19))
    around = fan(2, 8, 2.0 * math.pi)[1:]
    assert np.array_equal(fan(1, 8, 2.0 * math.pi, include_base=False), around)
    assert len(np.unique(np.round(around, 9), axis=0)) == 8  # no direction twice
