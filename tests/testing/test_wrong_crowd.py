"""Crowd policies and cost functions that are wrong, each found by the check that is for it."""
# ruff: noqa: ARG001, ARG005 - the signatures are fixed

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from numba import njit, types

from crowdbot.core.crowd import CrowdView
from crowdbot.core.crowd.velocity_search.cost import (
    BASE,
    EXCESS,
    GRADIENT,
    LOWER_BOUND,
    PREPARE,
    AgentView,
    CompiledCost,
    Neighbours,
    NumpyCost,
)
from crowdbot.core.types.arrays import Array
from crowdbot.plugins.crowd.cost_functions.rvo import RvoSpec
from crowdbot.plugins.crowd.cost_functions.rvo_build import build as rvo
from crowdbot.testing import checks_for, cost_function, crowd_policy
from crowdbot.testing.checks import checks_in
from tests.testing.wrong import BUILT_IN, WrongCost, WrongPolicy, assert_fails, made


def preferred(view: CrowdView) -> Array:
    way = view.goal - view.position
    left = np.maximum(np.hypot(way[:, 0], way[:, 1]), 1e-9)[:, None]
    return np.asarray(view.agents.preferred_speed[:, None] * way / left)


def policy(answer: Callable[[CrowdView, float], Any]) -> Any:
    class Policy:
        def velocities(self, view: CrowdView, dt: float) -> Any:
            return answer(view, dt)

    return made(WrongPolicy, lambda spec, costs, agents: Policy())


def _divides(view: CrowdView, dt: float) -> Array:
    way = view.goal - view.position
    with np.errstate(invalid="ignore"):
        return np.asarray(way / np.hypot(way[:, 0], way[:, 1])[:, None])


def _writes(view: CrowdView, dt: float) -> Array:
    view.position[:] = 0.0
    return preferred(view)


def _one_after_the_other(view: CrowdView, dt: float) -> Array:
    found = preferred(view)
    for i in range(1, len(found)):
        found[i] += 0.1 * found[i - 1]
    return found


def _flips(view: CrowdView, dt: float) -> Array:
    return preferred(view) + np.random.default_rng().normal(0.0, 0.1, view.position.shape)


@pytest.mark.parametrize(
    ("check", "answer", "because"),
    [
        (crowd_policy.check_answer_is_numbers, lambda v, dt: preferred(v)[:, 0], r"\(8,\)"),
        (crowd_policy.check_answer_is_numbers, lambda v, dt: preferred(v).tolist(), "list"),
        (crowd_policy.check_answer_is_numbers, lambda v, dt: preferred(v) * np.nan, "nan"),
        (crowd_policy.check_nobody_and_one, _divides, "at the goal: "),
        (crowd_policy.check_input_is_not_changed, _writes, "changed position"),
        (crowd_policy.check_same_view_twice, _flips, "answered differently"),
        (crowd_policy.check_permutation_equivariant, _one_after_the_other, "another order"),
        (crowd_policy.check_translation_invariant, lambda v, dt: -v.position, "along x"),
        (crowd_policy.check_rotation_equivariant, lambda v, dt: preferred(v) + 0.3, "turned"),
        (crowd_policy.check_time_step_is_no_unit, lambda v, dt: 16.0 * preferred(v) * dt, "twice"),
    ],
)  # fmt: skip
def test_policies(check: Any, answer: Any, because: str) -> None:
    assert_fails(check, policy(answer), because)


def test_a_sound_policy_passes() -> None:
    for check in checks_in(crowd_policy):
        check(policy(lambda view, dt: preferred(view)), BUILT_IN)


# -------------------------------------------------------------------- vectorised costs
Evaluate = Callable[[Array, AgentView, Neighbours], Any]


def numpy_cost(evaluate: Evaluate) -> Any:
    return made(WrongCost, lambda spec: NumpyCost(evaluate=evaluate, range=3.0, weight=1.0))


def _speed(u: Array) -> Array:
    return np.asarray(np.hypot(u[:, 0], u[:, 1]))


def _writes_back(u: Array, agent: AgentView, near: Neighbours) -> Array:
    u[:] = 0.0
    return _speed(u)


@pytest.mark.parametrize(
    ("check", "evaluate", "because"),
    [
        (cost_function.check_costs_are_numbers, lambda u, a, n: _speed(u) - math.inf, "-inf"),
        (cost_function.check_excess_is_not_negative, lambda u, a, n: -_speed(u), "below"),
        (
            cost_function.check_candidates_are_independent,
            lambda u, a, n: _speed(u) / _speed(u).sum(),
            "without the others",
        ),
        (
            cost_function.check_translation_invariant,
            lambda u, a, n: _speed(u) + abs(a.position[0]),
            "along x",
        ),
        (cost_function.check_rotation_invariant, lambda u, a, n: np.abs(u[:, 0]), "turned"),
    ],
)
def test_vectorised_costs(check: Any, evaluate: Any, because: str) -> None:
    assert_fails(check, numpy_cost(evaluate), because)


def test_what_a_cost_is_given_cannot_be_written() -> None:
    with pytest.raises(ValueError, match="read-only"):
        cost_function.check_input_is_not_changed(numpy_cost(_writes_back))


def test_a_nan_of_a_vectorised_cost() -> None:
    component = numpy_cost(lambda u, a, n: np.log(_speed(u) * 0.0 - 1.0 + 0.0 * _speed(u)))
    with np.errstate(invalid="ignore"), pytest.raises(ValueError, match="NaN"):
        cost_function.check_costs_are_numbers(component, BUILT_IN)


# ---------------------------------------------------------------------- compiled costs
@njit(types.float64(types.float64, types.float64), cache=True)
def _too_few(ux: float, uy: float) -> float:
    return ux + uy


@njit(BASE, cache=True, error_model="numpy")
def _nan_base(ux: float, uy: float, preferred: float, max_speed: float, params: Any) -> float:
    return math.sqrt(ux)


@njit(BASE, cache=True, error_model="numpy")
def _no_base(ux: float, uy: float, preferred: float, max_speed: float, params: Any) -> float:
    return 0.0


@njit(PREPARE, cache=True, error_model="numpy")
def _count(
    agent: Any, near: Any, near_count: int, walls: Any, wall_count: int, params: Any, work: Any
) -> int:
    work[0] = 0.0
    return 1


@njit(EXCESS, cache=True, error_model="numpy")
def _negative(ux: float, uy: float, budget: float, agent: Any, work: Any, params: Any) -> float:
    return -1.0 - ux * ux


@njit(EXCESS, cache=True, error_model="numpy")
def _impatient(ux: float, uy: float, budget: float, agent: Any, work: Any, params: Any) -> float:
    cost = 1.0 + math.hypot(ux, uy)
    return cost if cost < 2.0 * budget else 0.5 * budget


@njit(EXCESS, cache=True, error_model="numpy")
def _counting(ux: float, uy: float, budget: float, agent: Any, work: Any, params: Any) -> float:
    work[0] += 1.0
    return float(work[0])


@njit(PREPARE, cache=True, error_model="numpy")
def _writes_nothing(
    agent: Any, near: Any, near_count: int, walls: Any, wall_count: int, params: Any, work: Any
) -> int:
    return 1


@njit(EXCESS, cache=True, error_model="numpy")
def _what_is_there(
    ux: float, uy: float, budget: float, agent: Any, work: Any, params: Any
) -> float:
    return float(work[0])


@njit(EXCESS, cache=True, error_model="numpy")
def _square(ux: float, uy: float, budget: float, agent: Any, work: Any, params: Any) -> float:
    return ux * ux + uy * uy


@njit(GRADIENT, cache=True, error_model="numpy")
def _half(ux: float, uy: float, agent: Any, work: Any, params: Any, out: Any) -> int:
    out[0], out[1] = ux, uy  # the gradient of _square is twice as steep
    return 1


@njit(LOWER_BOUND, cache=True, error_model="numpy")
def _lofty(count: int, ux: Any, uy: Any, agent: Any, work: Any, params: Any, out: Any) -> int:
    for c in range(count):
        out[c] = 1.1 * (ux[c] ** 2 + uy[c] ** 2)  # of _square
    return 1


def compiled(**changes: Any) -> Any:
    given: dict[str, Any] = {
        "base": _no_base, "prepare": _count, "excess": _square, "weight": 1.0,
        "params": np.array([3.0, 0.0]), **changes,
    }  # fmt: skip
    return made(WrongCost, lambda spec: CompiledCost(**given))


@pytest.mark.parametrize(
    ("check", "changes", "because"),
    [
        (cost_function.check_signatures, {"base": _too_few}, "base is compiled for"),
        (cost_function.check_signatures, {"excess": abs}, "excess is not a compiled"),
        (cost_function.check_signatures, {"params": np.array([3.0])}, "params do not begin"),
        (cost_function.check_signatures, {"weight": -1.0}, "weight"),
        (cost_function.check_costs_are_numbers, {"base": _nan_base}, "NaN"),
        (cost_function.check_excess_is_not_negative, {"excess": _negative}, "below their base"),
        (cost_function.check_candidates_are_independent, {"excess": _counting}, "another order"),
        (cost_function.check_excess_stops_above_budget, {"excess": _impatient}, "with a budget"),
        (
            cost_function.check_lower_bound_is_below_excess,
            {"lower_bound": _lofty},
            "its lower bound",
        ),
        (
            cost_function.check_work_is_written,
            {"prepare": _writes_nothing, "excess": _what_is_there},
            "in work before",
        ),
        (cost_function.check_gradient, {"gradient": _half}, "gradients are wrong"),
    ],
)
def test_compiled_costs(check: Any, changes: dict[str, Any], because: str) -> None:
    assert_fails(check, compiled(**changes), because)


def test_a_sound_cost_passes() -> None:
    sound = compiled()
    for check in checks_in(cost_function):
        check(sound, BUILT_IN)
    cost = replace(rvo(RvoSpec()), weight=2.0)
    component = made(WrongCost, lambda spec: cost)
    for check in checks_in(cost_function):
        check(component, BUILT_IN)


# ------------------------------------------------------------------ declared exceptions
def test_an_exception_that_a_component_declares() -> None:
    name = "check_translation_invariant"
    wrong = replace(policy(lambda v, dt: -v.position), exceptions={name: "knows places"})
    dict(checks_for(wrong, BUILT_IN))[name]()
    sound = replace(policy(lambda v, dt: preferred(v)), exceptions={name: "knows places"})
    with pytest.raises(AssertionError, match="knows places"):
        dict(checks_for(sound, BUILT_IN))[name]()
