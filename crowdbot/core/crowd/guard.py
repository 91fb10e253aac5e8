"""Policies and cost functions as plugins return them: named, and checked before they are used."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from crowdbot.core.crowd.cost import (
    BASE,
    EXCESS,
    FLOOR,
    GRADIENT,
    OPTIMUM,
    PREPARE,
    AgentView,
    Array,
    CompiledCost,
    Neighbours,
    NumpyCost,
)
from crowdbot.core.fault import described
from crowdbot.errors import CrowdbotError, PluginError

_SIGNATURES = {
    "base": BASE, "prepare": PREPARE, "excess": EXCESS, "gradient": GRADIENT, "optimum": OPTIMUM,
    "floor": FLOOR,
}  # fmt: skip
_OPTIONAL = ("gradient", "optimum", "floor")


class KnownPolicy:
    """A policy that knows its kind, for messages; else the policy itself."""

    def __init__(self, kind: str, policy: Any) -> None:
        """Take a policy.

        Raises:
            PluginError: it is none.
        """
        if not (hasattr(policy, "velocities") or hasattr(policy, "accelerations")):
            raise PluginError(
                f"crowd policy {kind}: build returned a {type(policy).__name__}, which has neither "
                "'velocities' nor 'accelerations'"
            )
        push = getattr(policy, "contact_stiffness", 0.0)
        if not (isinstance(push, int | float) and math.isfinite(push) and push >= 0.0):
            raise PluginError(f"crowd policy {kind}: contact_stiffness is {push!r}")
        self.kind, self._policy = kind, policy

    def __getattr__(self, name: str) -> Any:
        return getattr(self._policy, name)


def checked_cost(kind: str, cost: object) -> CompiledCost | NumpyCost:
    """A cost function that fits its contract, as far as that can be seen before it is called.

    Raises:
        PluginError: it does not.
    """
    if not isinstance(cost, CompiledCost | NumpyCost):
        raise PluginError(
            f"cost function {kind}: build returned a {type(cost).__name__}, not a CompiledCost or "
            "a NumpyCost"
        )
    if not (math.isfinite(cost.weight) and cost.weight >= 0.0):
        raise PluginError(f"cost function {kind}: weight is {cost.weight}")
    if isinstance(cost, NumpyCost):
        if not cost.range > 0.0:
            raise PluginError(f"cost function {kind}: range is {cost.range}")
        return replace(cost, evaluate=_watched(kind, cost.evaluate))
    params = cost.params
    if not (isinstance(params, np.ndarray) and params.dtype == np.float64 and params.ndim == 1):
        raise PluginError(f"cost function {kind}: params must be a float64 array (P,)")
    if len(params) < 2 or np.any(np.isnan(params)) or not params[0] > 0.0:
        raise PluginError(
            f"cost function {kind}: params begins with the range (m) and 1.0 or 0.0 for whether "
            f"it is measured between surfaces, and is {params.tolist()}"
        )
    for name, signature in _SIGNATURES.items():
        _check_compiled(kind, name, signature, getattr(cost, name))
    return cost


def _check_compiled(kind: str, name: str, signature: Any, function: Any) -> None:
    if function is None and name in _OPTIONAL:
        return
    found = getattr(function, "nopython_signatures", ())
    if signature not in found:
        what = f"is compiled for {found[0]}" if found else "is not compiled"
        raise PluginError(
            f"cost function {kind}: {name} {what}; decorate it with "
            f'@njit({name.upper()}, cache=True, error_model="numpy"), which is {signature}'
        )


def _watched(
    kind: str, evaluate: Callable[[Array, AgentView, Neighbours], Array]
) -> Callable[[Array, AgentView, Neighbours], Array]:
    def watched(candidates: Array, agent: AgentView, neighbours: Neighbours) -> Array:
        try:
            found = np.asarray(evaluate(candidates, agent, neighbours), np.float64)
        except CrowdbotError:
            raise
        except (Exception, SystemExit) as error:
            text = f"cost function {kind}: {described(error)}"
            raise PluginError(text) from error
        if found.shape != (len(candidates),):
            raise PluginError(
                f"cost function {kind} returned shape {found.shape} for {len(candidates)} "
                "candidates"
            )
        if np.any(np.isnan(found)):
            raise PluginError(
                f"cost function {kind} returned NaN for {candidates[np.isnan(found)][0].tolist()}"
            )
        return found

    return watched
