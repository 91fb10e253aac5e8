"""Methods of minimising, ways of sampling, vectorised cost functions."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from crowdbot.core.crowd.policy import CrowdView
from crowdbot.core.crowd.velocity_search.candidates import EVERYWHERE, Sampling, turn
from crowdbot.core.crowd.velocity_search.cost import AgentView, Neighbours, NumpyCost
from crowdbot.core.crowd.velocity_search.evaluate import Evaluator
from crowdbot.core.crowd.velocity_search.gradient import STEP, Descent
from crowdbot.core.crowd.velocity_search.minstd import between, following
from crowdbot.core.crowd.velocity_search.sampling import Sampler
from crowdbot.core.crowd.velocity_search.weighted_costs import WeightedCosts
from crowdbot.plugin import CostFunctionSpec, Range
from crowdbot.plugins.crowd.cost_functions.random_function import RandomFunctionSpec
from crowdbot.plugins.crowd.cost_functions.rvo import RvoSpec
from crowdbot.plugins.crowd.cost_functions.ttca_dca.ttca_dca import TtcaDcaSpec
from crowdbot.plugins.crowd.policies.velocity_space import VelocitySpaceSpec
from crowdbot.plugins.crowd.policies.velocity_space_build import VelocitySpace
from tests.core.crowd.crowd_reference import Array, agents_of, choice_costs
from tests.core.crowd.oracle_cases import compiled
from tests.core.crowd.velocity_search.test_sampling import MIXES, scene

RVO = RvoSpec(range=Range(value=4.0))


def mix_of(view: CrowdView, *specs: CostFunctionSpec) -> WeightedCosts:
    return WeightedCosts([compiled(c) for c in specs], view.agents)


@pytest.mark.parametrize("samples", ["regular", "random"])
@pytest.mark.parametrize("base", [0, 1])
@pytest.mark.parametrize("direction", [0, 1, 2])
@pytest.mark.parametrize("radius", [0, 1, 2])
def test_every_frame_gives_the_exhaustive_minimum(
    samples: str, base: int, direction: int, radius: int
) -> None:
    view = scene(3, 25)
    drawn = 60 if samples == "random" else 0
    sampling = Sampling(base=base, direction=direction, radius=radius, random=drawn)
    mix = mix_of(view, *MIXES["wide rvo"])
    sampler, random = Sampler(sampling, mix), mix.random.copy()
    chosen, following_state = sampler.choose(view), mix.random.copy()
    mix.random[:] = random
    candidates = sampler.candidates(view)
    assert np.array_equal(mix.random, following_state)
    total = Evaluator(mix).total(view, candidates)
    for i in np.flatnonzero(view.present):
        place = int(np.argmin(total[i]))
        if not math.isfinite(total[i, place]):
            assert not np.any(chosen[i])
            continue
        assert np.allclose(chosen[i], candidates[i, place], atol=1e-12)


def test_the_evaluator_agrees_with_plain_formulas() -> None:
    view = scene(4, 30)
    mix, specs = mix_of(view, *MIXES["wide rvo"]), MIXES["wide rvo"]
    fan = Sampling().fan()
    candidates = Sampler(Sampling(), mix).candidates(view)
    total = Evaluator(mix).total(view, candidates)
    for i in np.flatnonzero(view.present):
        _, expected = choice_costs(view, specs, fan, int(i))
        assert np.allclose(total[i], expected, rtol=1e-9, atol=1e-9)


def _distance_to_preferred(u: Array, agent: AgentView, others: Neighbours) -> Array:
    assert np.all(np.hypot(*others.offset.T) < 4.0)
    assert others.radius.shape == others.fixed.shape == (len(others.offset),)
    return np.asarray(np.hypot(*(u - agent.preferred_velocity).T))


@pytest.mark.parametrize("method", ["sampling", "gradient", "global"])
def test_a_vectorised_function_works_inside_any_mix(method: str) -> None:
    """RVO without obstacles is |u - preferred|: compiled and vectorised must agree."""
    view = scene(5, 20)
    spec = VelocitySpaceSpec.model_validate({"kind": "velocity_space", "method": method})
    pull = NumpyCost(evaluate=_distance_to_preferred, range=4.0, weight=2.0)
    push = compiled(TtcaDcaSpec(weight=3.0, range=Range(value=4.0)))
    compiled_pull = compiled(RvoSpec(weight=2.0, range=Range(value=1e-9)))
    found = [
        VelocitySpace(spec, [push, other], view.agents).accelerations(view)
        for other in (pull, compiled_pull)
    ]
    slow = np.hypot(*view.velocity.T) < view.agents.max_speed - STEP
    assert np.allclose(found[0][slow], found[1][slow], atol=1e-9)
    assert np.any(found[0])


def test_a_vectorised_function_that_returns_nonsense_is_named() -> None:
    view = scene(5, 3)
    bad = NumpyCost(evaluate=lambda u, _a, _o: np.full(len(u), np.nan), range=4.0, weight=1.0)
    with pytest.raises(ValueError, match="NaN"):
        VelocitySpace(VelocitySpaceSpec(), [bad], view.agents).accelerations(view)


def test_numerical_gradients_are_central_differences() -> None:
    view = scene(6, 20)
    mix = mix_of(view, RVO)
    found = Descent(mix).accelerations(view)
    around = view.velocity[:, None] + STEP * np.array([[-1.0, 0], [1, 0], [0, -1], [0, 1]])
    total = Evaluator(mix).total(view, around)
    slope = np.stack([total[:, 1] - total[:, 0], total[:, 3] - total[:, 2]], axis=1) / (2 * STEP)
    assert np.all(np.isfinite(total))
    assert np.allclose(found, -slope, atol=1e-9)


def test_nobody_descends_into_what_is_forbidden() -> None:
    """Beyond the largest speed RVO is forbidden; the original computes NaN there."""
    position = np.array([[0.0, 0.0], [0.0, 30.0], [0.0, 60.0]])
    velocity = np.array([[2.99, 0.0], [-2.99, 0.0], [2.99, 2.99]])
    view = CrowdView(
        agents=agents_of(position), position=position, velocity=velocity,
        goal=position + np.array([50.0, 0.0]), present=np.ones(3, np.bool_), robot=np.zeros((0, 5)),
        walls=np.zeros((0, 4)), dt=0.1,
    )  # fmt: skip
    spec = VelocitySpaceSpec(method="gradient")
    found = VelocitySpace(spec, [compiled(RVO)], view.agents).accelerations(view)
    assert np.allclose(found[0], [-5.0, 0.0])
    assert np.allclose(found[1], [5.0, 0.0])
    assert np.all(np.isfinite(found))


def test_global_searches_everywhere_where_there_is_no_closed_form() -> None:
    view = scene(7, 15)
    spec = VelocitySpaceSpec(method="global", relaxation_time=1.0)
    found = VelocitySpace(spec, [compiled(RVO)], view.agents).accelerations(view)
    expected = Sampler(EVERYWHERE, mix_of(view, RVO)).choose(view) - view.velocity
    norm = np.maximum(np.hypot(*expected.T), 1e-12)
    expected *= np.minimum(1.0, view.agents.max_acceleration / norm)[:, None]
    assert np.allclose(found[view.present], expected[view.present])


def test_a_random_function_draws_once_per_candidate_in_order() -> None:
    view = replace(scene(8, 2, 0), present=np.ones(2, np.bool_))
    mix = mix_of(view, RandomFunctionSpec())
    chosen = Sampler(Sampling(), mix).choose(view)
    fan = Sampling().fan()
    for i, state in enumerate((1, 1)):  # 0 counts as 1
        draws = []
        for _ in fan:
            state = following(state)
            draws.append(between(state, -1.0, 1.0))
        to_goal = view.goal[i] - view.position[i]
        x, y = to_goal / np.hypot(*to_goal) * view.agents.preferred_speed[i]
        u = fan[int(np.argmin(draws))]
        assert np.allclose(chosen[i], [u[0] * x - u[1] * y, u[0] * y + u[1] * x])
        assert mix.random[i] == state


def test_the_generator_is_the_minimal_standard() -> None:
    """Park and Miller: from 1, the 10 000th state is 1043618065."""
    state = 1
    for _ in range(10_000):
        state = following(state)
    assert state == 1043618065
    assert between(2147483646, 0.0, 1.0) < 1.0
    assert between(1, -2.0, 3.0) == -2.0


def test_turn() -> None:
    angles = np.linspace(-math.pi, math.pi, 2001)
    found = np.array([turn(a) for a in angles])
    assert np.allclose(found, np.column_stack([np.cos(angles), np.sin(angles)]), atol=3e-15)


def test_each_policy_decides_for_its_own() -> None:
    view = scene(9, 12)
    policy = VelocitySpace(VelocitySpaceSpec(), [compiled(c) for c in MIXES["c20-r5"]], view.agents)
    everybody = policy.accelerations(view)
    mine = np.arange(12) % 2 == 0
    assert np.array_equal(policy.accelerations(replace(view, decides=mine))[mine], everybody[mine])


def test_walls_as_neighbours() -> None:
    """With ``walls`` the nearest point of a wall is treated as a stationary point pedestrian."""
    view = replace(scene(10, 1, 0), present=np.ones(1, np.bool_))
    view = replace(view, position=np.array([[8.0, 4.2]]), velocity=np.array([[1.0, 0.5]]))
    wall = np.array([[-1.0, 5.0, 51.0, 5.0]])
    spec = TtcaDcaSpec(range=Range(value=3.0))
    points = np.stack([np.stack([np.linspace(0, 1.2, 7), np.linspace(-0.5, 0.5, 7)], axis=1)])
    seen = replace(view, walls=wall)
    blind = Evaluator(mix_of(view, spec)).total(seen, points)
    with_wall = Evaluator(mix_of(view, spec.model_copy(update={"walls": True}))).total(seen, points)
    stands = replace(view, walls=wall[:0], robot=np.array([[8.0, 5.0, 0.0, 0.0, 0.0]]))
    expected = Evaluator(mix_of(view, spec)).total(stands, points)
    assert np.allclose(with_wall, expected)
    assert np.any(np.abs(with_wall - blind) > 0.01)
