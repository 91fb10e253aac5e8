"""Build policies and cost functions from plugins, and check them before use."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from crowdbot.core.crowd.agents import Agents
from crowdbot.core.crowd.desired_acceleration import CheckedPolicy
from crowdbot.core.crowd.velocity_search.cost import (
    BASE,
    EXCESS,
    GRADIENT,
    LOWER_BOUND,
    OPTIMUM,
    PREPARE,
    AgentView,
    CompiledCost,
    Neighbours,
    NumpyCost,
)
from crowdbot.core.registry.plugin_boundary import PluginCall
from crowdbot.core.registry.registry import Registry
from crowdbot.core.support.immutable import immutable_fields
from crowdbot.core.support.plain_numbers import plain_numbers
from crowdbot.core.types.arrays import Array
from crowdbot.dsl.spec.component_specs import CostFunctionSpec, CrowdPolicySpec
from crowdbot.errors import PluginError

_SIGNATURES = {
    "base": BASE, "prepare": PREPARE, "excess": EXCESS, "gradient": GRADIENT, "optimum": OPTIMUM,
    "lower_bound": LOWER_BOUND,
}  # fmt: skip
_OPTIONAL = ("gradient", "optimum", "lower_bound")


def build_policy(
    registry: Registry,
    spec: CrowdPolicySpec,
    costs: Sequence[CompiledCost | NumpyCost],
    agents: Agents,
) -> CheckedPolicy:
    """Build the policy of a spec for some agents; all its later results are checked.

    Args:
        costs: what it minimises, built.
        agents: all of the crowd.

    Raises:
        PluginError: it cannot be built, or is not a policy.
    """
    call = registry.plugin_call(spec)
    return registry.build(
        spec, lambda policy: CheckedPolicy(policy, call), costs, immutable_fields(agents), call=call
    )


def build_cost(registry: Registry, spec: CostFunctionSpec) -> CompiledCost | NumpyCost:
    """Build the cost function of a spec.

    Raises:
        PluginError: it cannot be built, or does not satisfy its interface.
    """
    call = registry.plugin_call(spec)
    return registry.build(
        spec, lambda cost: replace(checked_cost(cost, call), call=call), call=call
    )


def checked_cost(cost: object, call: PluginCall) -> CompiledCost | NumpyCost:
    """Return a cost function, checked as far as possible before calls.

    Args:
        cost: result of a build function.
        call: call boundary to its plugin.

    Raises:
        PluginError: it does not satisfy its interface.
    """
    if not isinstance(cost, CompiledCost | NumpyCost):
        raise PluginError(
            f"build returned a {type(cost).__name__}, not a CompiledCost or a NumpyCost"
        )
    if not (math.isfinite(cost.weight) and cost.weight >= 0.0):
        raise PluginError(f"weight must be a number that is not negative, not {cost.weight}")
    if isinstance(cost, NumpyCost):
        if not cost.range > 0.0:
            raise PluginError(f"range must be above 0, not {cost.range}")
        return replace(cost, evaluate=_checked_costs(cost.evaluate, call))
    params = cost.params
    if not (isinstance(params, np.ndarray) and params.dtype == np.float64 and params.ndim == 1):
        raise PluginError("params must be a float64 array (P,)")
    if len(params) < 2 or np.any(np.isnan(params)) or not params[0] > 0.0:
        raise PluginError(
            f"params begins with the range (m) and 1.0 or 0.0 for whether "
            f"it is measured between surfaces, and is {params.tolist()}"
        )
    for name, signature in _SIGNATURES.items():
        _check_compiled(name, signature, getattr(cost, name))
    return cost


def _check_compiled(name: str, signature: Any, function: Any) -> None:
    if function is None and name in _OPTIONAL:
        return
    found = getattr(function, "nopython_signatures", ())
    if signature not in found:
        problem = f"is compiled for {found[0]}" if found else "is not compiled"
        raise PluginError(
            f"{name} {problem}; decorate it with "
            f'@njit({name.upper()}, cache=True, error_model="numpy"), which is {signature}'
        )


def _checked_costs(
    evaluate: Callable[[Array, AgentView, Neighbours], Array], call: PluginCall
) -> Callable[[Array, AgentView, Neighbours], Array]:
    def checked(candidates: Array, agent: AgentView, neighbours: Neighbours) -> Array:
        with call("evaluate"):
            costs = plain_numbers(evaluate(candidates, agent, neighbours))
        if costs.shape != (len(candidates),):
            call.fail(f"evaluate returned shape {costs.shape} for {len(candidates)} candidates")
        if np.isnan(costs).any():
            wrong = candidates[np.isnan(costs)][0].tolist()
            call.fail(f"evaluate returned NaN for {wrong}")
        return costs

    return checked
