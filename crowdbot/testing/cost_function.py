"""Checks for every cost function, compiled or not."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
from numba.core.errors import NumbaError

import crowdbot.testing.crowd_views as crowd_views
from crowdbot.core.crowd import CrowdView
from crowdbot.core.crowd.velocity_search.cost import SIGNATURES, CompiledCost, NumpyCost
from crowdbot.core.crowd.velocity_search.cost_calls import address_of
from crowdbot.core.crowd.velocity_search.evaluate import Evaluator
from crowdbot.core.crowd.velocity_search.gradient import Descent
from crowdbot.core.crowd.velocity_search.weighted_costs import WeightedCosts
from crowdbot.core.registry.registry import Registry
from crowdbot.core.types.arrays import Array
from crowdbot.dsl.spec.component import Component
from crowdbot.testing.around import each_built
from crowdbot.testing.cost_parts import above_lower_bound, bases_of, forgets_work, stops_at_budget

Cost = CompiledCost | NumpyCost

_TURN = 0.7  # rad


def check_signatures(component: Component[Any], registry: Registry | None = None) -> None:
    """Compiled functions have the required signatures; weight and range fit.

    If this fails, write ``@njit(EXCESS, cache=True, error_model="numpy")`` before the named
    function, and begin ``params`` with the range and 0.0 or 1.0.
    """
    for cost in _costs(component, registry):
        assert isinstance(cost, CompiledCost | NumpyCost), f"build returned a {type(cost).__name__}"
        assert math.isfinite(cost.weight), f"the weight is {cost.weight}"
        assert cost.weight >= 0.0, f"the weight is {cost.weight}"
        if isinstance(cost, NumpyCost):
            assert cost.range >= 0.0, f"the range is {cost.range}"
            continue
        for name, signature in SIGNATURES.items():
            _assert_compiled(name, getattr(cost, name), signature)
        assert cost.params.dtype == np.float64, f"params are {cost.params.dtype}"
        assert cost.params.ndim == 1, f"params have {cost.params.ndim} dimensions"
        assert len(cost.params) >= 2, "params do not begin with the range and how it is measured"
        assert cost.params[0] >= 0.0, f"the range is {cost.params[0]}"
        assert cost.params[1] in (0.0, 1.0), f"params[1] is {cost.params[1]}, not 0.0 or 1.0"


def check_costs_are_numbers(component: Component[Any], registry: Registry | None = None) -> None:
    """A cost is finite, or inf if forbidden: never NaN, never -inf.

    If this fails, look at the named crowd: people who stand, overlap or touch a wall, and
    candidates with zero speed, often cause a division by zero.
    """
    views = crowd_views.odd_views() | {
        f"crowd {seed}": crowd_views.random_view(seed) for seed in crowd_views.SEEDS
    }
    for cost in _costs(component, registry):
        for name, view in views.items():
            _assert_numbers(name, _total(cost, view, _candidates(view)))


def check_excess_is_not_negative(
    component: Component[Any], registry: Registry | None = None
) -> None:
    """Neighbours and walls add at least zero, so that the base is a lower bound.

    If this fails, move terms that lower the cost to ``base``, or add a constant: candidates whose
    base alone exceeds the best cost are skipped. A vectorised function has no base; its costs are
    at least zero.
    """
    for cost, view, velocities in _in_crowds(component, registry):
        total = _total(cost, view, velocities)
        least = bases_of(cost, view, velocities) if isinstance(cost, CompiledCost) else 0.0
        with np.errstate(invalid="ignore"):
            below = total < least - 1e-9 * (1.0 + np.abs(least))
        assert not np.any(below), f"{np.count_nonzero(below)} costs are below their base"


def check_candidates_are_independent(
    component: Component[Any], registry: Registry | None = None
) -> None:
    """A candidate's cost does not depend on other candidates, earlier or at the same time.

    If this fails, ``excess`` writes into ``work``, or ``evaluate`` compares candidates with each
    other. A function that draws random numbers must declare ``CompiledCost(ordered=True)``.
    """
    for cost, view, velocities in _in_crowds(component, registry):
        if isinstance(cost, CompiledCost) and cost.ordered:
            continue
        total = _total(cost, view, velocities)
        again = _total(cost, view, np.ascontiguousarray(velocities[:, ::-1]))[:, ::-1]
        few = _total(cost, view, np.ascontiguousarray(velocities[:, :3]))
        assert _near(total, again), "in another order candidates cost something else"
        assert _near(total[:, :3], few), "without the others candidates cost something else"


def check_excess_stops_above_budget(
    component: Component[Any], registry: Registry | None = None
) -> None:
    """With a budget, ``excess`` is the same as without, or both are above the budget.

    If this fails, it stops too early: return only once the sum is above ``budget``.
    """
    for cost, view, velocities in _in_crowds(component, registry):
        if isinstance(cost, CompiledCost) and not cost.ordered:
            wrong = stops_at_budget(cost, view, velocities)
            assert not wrong, wrong


def check_lower_bound_is_below_excess(
    component: Component[Any], registry: Registry | None = None
) -> None:
    """A ``lower_bound``, if any, lies between zero and the excess.

    If this fails, the search skips candidates that might win: include only certain terms in the
    lower bound.
    """
    for cost, view, velocities in _in_crowds(component, registry):
        if isinstance(cost, CompiledCost) and cost.lower_bound is not None:
            wrong = above_lower_bound(cost, view, velocities)
            assert not wrong, wrong


def check_work_is_written(component: Component[Any], registry: Registry | None = None) -> None:
    """No cost depends on the contents of ``work`` before ``prepare``.

    If this fails, let ``prepare`` write row 0, and all of other rows that ``excess`` reads: its old
    contents belong to another agent.
    """
    for cost, view, velocities in _in_crowds(component, registry):
        if isinstance(cost, CompiledCost) and not cost.ordered:
            same = forgets_work(cost, view, velocities)
            assert same, "costs depend on what was in work before prepare"


def check_gradient(component: Component[Any], registry: Registry | None = None) -> None:
    """A ``gradient``, if any, is that of base plus excess, except at kinks.

    If this fails, compare with differences of the cost over 0.0001 m/s at the named velocity. A
    function whose source defines another slope declares ``exceptions={"check_gradient": "why"}``.
    """
    for cost in _costs(component, registry):
        if isinstance(cost, CompiledCost) and cost.gradient is not None:
            _assert_gradient(cost)


def check_input_is_not_changed(component: Component[Any], registry: Registry | None = None) -> None:
    """The function does not write to the crowd's arrays or the parameters.

    If this fails, write into ``work`` only, or copy.
    """
    for cost in _costs(component, registry):
        view = crowd_views.random_view(0)
        velocities = _candidates(view)
        params = cost.params.copy() if isinstance(cost, CompiledCost) else np.zeros(0)
        before, candidates = crowd_views.arrays_of(view), velocities.copy()
        _total(cost, view, velocities)
        assert crowd_views.arrays_of(view) == before, "changed the crowd"
        assert np.array_equal(velocities, candidates), "changed the candidates"
        if isinstance(cost, CompiledCost):
            assert np.array_equal(cost.params, params), "changed its parameters"


def check_translation_invariant(
    component: Component[Any], registry: Registry | None = None
) -> None:
    """Costs do not change if the crowd is moved elsewhere.

    If this fails, an absolute coordinate is used: all data about others is relative. A function
    that depends on places declares it in ``Component(exceptions=...)``.
    """
    for cost, view, velocities in _in_crowds(component, registry):
        there = crowd_views.moved(view, np.array([16.0, -8.0]))
        same = _near(_total(cost, view, velocities), _total(cost, there, velocities))
        assert same, "16 m along x, -8 m along y velocities cost something else"


def check_rotation_invariant(component: Component[Any], registry: Registry | None = None) -> None:
    """Costs do not change if the crowd and the velocities are rotated.

    If this fails, the axes are treated differently; the base gets candidates in the frame of the
    preferred velocity. A function that depends on directions declares it in its ``exceptions``.
    """
    for cost, view, velocities in _in_crowds(component, registry):
        again = _total(cost, crowd_views.turned(view, _TURN), crowd_views.turn(velocities, _TURN))
        same = _near(_total(cost, view, velocities), again)
        assert same, f"turned by {_TURN} rad velocities cost something else"


def _costs(component: Component[Any], registry: Registry | None) -> Iterator[Cost]:
    return each_built(component, registry)


def _in_crowds(
    component: Component[Any], registry: Registry | None
) -> Iterator[tuple[Cost, CrowdView, Array]]:
    """Yield each function with random crowds and their candidates."""
    for cost in _costs(component, registry):
        for seed in crowd_views.SEEDS:
            view = crowd_views.random_view(seed)
            yield cost, view, _candidates(view)


def _candidates(view: CrowdView) -> Array:
    """Return velocities (N, S, 2), m/s: zero, 27 up to 1.9 m/s, and the agent's present one."""
    angles = np.linspace(0.1, 2.0 * math.pi, 9, endpoint=False)
    fan = [s * np.column_stack([np.cos(angles), np.sin(angles)]) for s in (0.4, 1.1, 1.9)]
    common = np.concatenate([np.zeros((1, 2)), *fan])
    everybody = np.broadcast_to(common, (len(view.agents), *common.shape))
    return np.ascontiguousarray(np.concatenate([everybody, view.velocity[:, None]], axis=1))


def _total(cost: Cost, view: CrowdView, velocities: Array) -> Array:
    """Return the costs (N, S) of one function with weight 1."""
    costs = WeightedCosts([replace(cost, weight=1.0)], view.agents, relaxation_time=0.5)
    return Evaluator(costs).total(view, velocities)


def _assert_compiled(name: str, function: Any, signature: Any) -> None:
    if function is None and name in ("gradient", "optimum", "lower_bound"):
        return
    assert hasattr(function, "nopython_signatures"), f"{name} is not a compiled function"
    try:
        address_of(function, signature)
    except (KeyError, TypeError, NumbaError, AttributeError) as error:
        found = "; ".join(str(s) for s in function.nopython_signatures) or "none"
        raise AssertionError(f"{name} is compiled for {found}, not for {signature}") from error


def _assert_numbers(name: str, total: Array) -> None:
    assert not np.any(np.isnan(total)), f"{name}: {np.count_nonzero(np.isnan(total))} costs are NaN"
    assert not np.any(total == -np.inf), f"{name}: a cost is -inf"


def _assert_gradient(cost: CompiledCost) -> None:
    """Check that the gradient equals finite differences in nine of ten cases; kinks may differ."""
    step, right, count, worst = 1e-5, 0, 0, ""
    around_it = step * np.array([[-1.0, 0.0], [1.0, 0.0], [0.0, -1.0], [0.0, 1.0]])
    alone = replace(cost, weight=1.0)
    for seed in range(3 * len(crowd_views.SEEDS)):
        view = crowd_views.random_view(seed)
        found = -Descent(WeightedCosts([alone], view.agents, relaxation_time=0.5)).accelerations(
            view
        )
        total = _total(cost, view, view.velocity[:, None] + around_it)
        with np.errstate(invalid="ignore"):
            slope = (total[:, 1::2] - total[:, ::2]) / (2.0 * step)
        usable = np.all(np.isfinite(total), axis=1)
        close = np.isclose(found, slope, rtol=1e-3, atol=1e-3).all(axis=1)
        right, count = right + int(np.sum(close & usable)), count + int(np.sum(usable))
        for i in np.flatnonzero(usable & ~close)[:1]:
            worst = f"at {view.velocity[i]} it is {found[i]}, differences give {slope[i]}"
    assert right >= 0.9 * count, f"{count - right} of {count} gradients are wrong; {worst}"


def _near(one: Array, two: Array) -> bool:
    return bool(np.allclose(one, two, rtol=1e-6, atol=1e-6, equal_nan=True))
