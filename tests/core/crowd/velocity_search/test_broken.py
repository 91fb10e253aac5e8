"""A compiled cost function that returns NaN is found while it runs, with its name."""
# The signatures of cost functions are fixed; not every one needs every argument.
# ruff: noqa: ARG001

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from numba import njit

from crowdbot.core.crowd.agents import Agents
from crowdbot.core.crowd.engine import CrowdEngine
from crowdbot.core.crowd.policy import CrowdView
from crowdbot.core.crowd.velocity_search.candidates import Sampling
from crowdbot.core.crowd.velocity_search.cost import BASE, EXCESS, PREPARE, CompiledCost, NumpyCost
from crowdbot.core.crowd.velocity_search.evaluate import Evaluator
from crowdbot.core.crowd.velocity_search.gradient import Descent
from crowdbot.core.crowd.velocity_search.sampling import Sampler
from crowdbot.core.crowd.velocity_search.weighted_costs import WeightedCosts
from crowdbot.core.crowd.world import CrowdWorld
from crowdbot.core.registry.plugin_boundary import PluginCall
from crowdbot.errors import PluginError
from crowdbot.testing.crowd_views import random_view

pytestmark = pytest.mark.slow  # it compiles


@njit(BASE, cache=True, error_model="numpy")
def _fine(ux: float, uy: float, preferred: float, max_speed: float, params: Any) -> float:
    return (ux - preferred) ** 2 + uy * uy


@njit(BASE, cache=True, error_model="numpy")
def _root(ux: float, uy: float, preferred: float, max_speed: float, params: Any) -> float:
    return math.sqrt(params[2] - uy)


@njit(PREPARE, cache=True, error_model="numpy")
def _one(
    agent: Any, near: Any, near_count: int, walls: Any, wall_count: int, params: Any, work: Any
) -> int:
    return 1


@njit(EXCESS, cache=True, error_model="numpy")
def _zero(ux: float, uy: float, budget: float, agent: Any, work: Any, params: Any) -> float:
    return 0.0


@njit(EXCESS, cache=True, error_model="numpy")
def _log(ux: float, uy: float, budget: float, agent: Any, work: Any, params: Any) -> float:
    return math.sqrt(params[2] - ux)


def cost(name: str, base: Any, excess: Any, most: float = -0.5) -> CompiledCost:
    return CompiledCost(
        base=base, prepare=_one, excess=excess, params=np.array([5.0, 0.0, most]), weight=1.0,
        call=PluginCall(f"cost function '{name}'"),
    )  # fmt: skip


def sampler(base: int) -> Callable[[WeightedCosts], Any]:
    sampling = Sampling(
        speeds=4, angles=11, opening=2.0 * math.pi, include_base=True, base=base, direction=2,
        radius=1, random=0,
    )  # fmt: skip
    return lambda costs: Sampler(sampling, costs).choose


METHODS: tuple[Callable[[WeightedCosts], Any], ...] = (
    sampler(0),
    sampler(1),
    lambda costs: Descent(costs).accelerations,
)


@pytest.mark.parametrize("method", METHODS, ids=["tabulated", "bounds", "gradient"])
@pytest.mark.parametrize(("base", "excess"), [(_root, _zero), (_fine, _log)])
def test_nan_is_found_with_its_name(method: Any, base: Any, excess: Any) -> None:
    view = random_view(0)
    good = cost("good", _fine, _zero)
    method(WeightedCosts([good], view.agents))(view)
    bad = cost("bad", base, excess)
    for costs in ([bad], [good, bad], [bad, good]):
        with pytest.raises(PluginError, match=r"^cost function 'bad'.*returned NaN"):
            method(WeightedCosts(costs, view.agents))(view)


def test_a_nan_far_from_everything_does_no_harm() -> None:
    view = random_view(0)
    far = cost("far", _root, _zero, most=1e6)
    assert np.isfinite(METHODS[1](WeightedCosts([far], view.agents))(view)).all()


def arrays_of(value: Any) -> list[Any]:
    return [a for a in vars(value).values() if isinstance(a, np.ndarray)] if hasattr(
        value, "__dict__") else [
        getattr(value, n) for n in value.__slots__ if isinstance(getattr(value, n), np.ndarray)
    ]  # fmt: skip


def test_cost_functions_get_nothing_to_write_to() -> None:
    seen: list[Any] = []

    def evaluate(candidates: Any, agent: Any, neighbours: Any) -> Any:
        seen.extend([candidates, *arrays_of(agent), *arrays_of(neighbours)])
        return np.zeros(len(candidates))

    view = random_view(0)
    costs = WeightedCosts([NumpyCost(evaluate=evaluate, range=5.0, weight=1.0)], view.agents)
    Evaluator(costs).total(view, np.zeros((len(view.position), 3, 2)))
    assert len(seen) > 40
    for array in seen:
        with pytest.raises(ValueError, match="WRITEABLE"):
            array.setflags(write=True)


def test_policies_get_nothing_to_write_to() -> None:
    seen: list[CrowdView] = []

    class Policy:
        def accelerations(self, view: CrowdView) -> Any:
            seen.append(view)
            return np.zeros_like(view.position)

    for count in (1, 3):
        agents = Agents.of(
            x=np.arange(count) * 2.0, y=np.zeros(count), routes=[[(9.0, 0.0)]] * count
        )
        world = replace(CrowdWorld(), walls=np.array([[0.0, -5.0, 9.0, -5.0]]))
        engine = CrowdEngine(agents, world, Policy())
        engine.advance(engine.initial_state())
    for view in seen:
        for array in [*arrays_of(view), *arrays_of(view.agents)]:
            with pytest.raises(ValueError, match="WRITEABLE"):
                array.setflags(write=True)
