"""Desired accelerations of people: the output of a policy, checked."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from crowdbot.core.crowd.policy import CrowdPolicy, CrowdView
from crowdbot.core.registry.plugin_boundary import PluginCall
from crowdbot.core.support.plain_numbers import plain_numbers
from crowdbot.core.types.arrays import Array
from crowdbot.core.types.candidates import VelocityCandidates
from crowdbot.errors import PluginError


class CheckedPolicy:
    """A policy with its call boundary; otherwise it behaves like the policy.

    Args:
        policy: result of a build function.
        call: call boundary; default: one that names the policy's class.

    Raises:
        PluginError: it is not a policy.
    """

    def __init__(self, policy: Any, call: PluginCall | None = None) -> None:
        if not (hasattr(policy, "velocities") or hasattr(policy, "accelerations")):
            raise PluginError(
                f"build returned a {type(policy).__name__}, which has neither 'velocities' nor "
                "'accelerations'"
            )
        push = getattr(policy, "contact_stiffness", 0.0)
        if not (isinstance(push, int | float) and math.isfinite(push) and push >= 0.0):
            raise PluginError(f"contact_stiffness is {push!r}")
        self.call = call or PluginCall(f"crowd policy '{type(policy).__name__}'")
        self._policy = policy

    def __getattr__(self, name: str) -> Any:
        return getattr(self._policy, name)


def desired_acceleration(policy: CrowdPolicy, view: CrowdView) -> Array:
    """Return accelerations (N, 2) of agents that decide, m/s^2; other rows are not defined.

    Raises:
        PluginError: the policy raised, its result has a wrong shape, or is not finite for an agent
            that decides.
    """
    call, accelerates = _call(policy), True
    with call("decision", view.t):
        if hasattr(policy, "accelerations"):
            answer = plain_numbers(policy.accelerations(view))
        else:
            answer, accelerates = plain_numbers(policy.velocities(view, view.dt)), False
    _check(answer, view, call)
    if accelerates:
        return answer
    acceleration = (answer - view.velocity) / view.dt
    norm = np.hypot(acceleration[:, 0], acceleration[:, 1])
    limit = view.agents.max_acceleration
    scale = np.minimum(1.0, limit / np.maximum(norm, limit))
    return np.asarray(acceleration * scale[:, np.newaxis])


def candidates_of(policy: CrowdPolicy) -> VelocityCandidates | None:
    """Return the fixed velocities among which a policy chooses, if it lists them.

    Raises:
        PluginError: its ``velocity_candidates`` raised or are invalid.
    """
    call = _call(policy)
    with call("velocity_candidates"):
        candidates = getattr(policy, "velocity_candidates", None)
    if candidates is not None and not isinstance(candidates, VelocityCandidates):
        call.fail(f"velocity_candidates is a {type(candidates).__name__}, not VelocityCandidates")
    return candidates


def relaxation_time_of(policy: CrowdPolicy) -> float:
    """Return the time in which a policy reaches its chosen velocity, s; 0 if it declares none.

    Raises:
        PluginError: its ``relaxation_time`` raised, or is not a time.
    """
    call = _call(policy)
    with call("relaxation_time"):
        found = float(getattr(policy, "relaxation_time", 0.0))
    if not 0.0 <= found < math.inf:
        call.fail(f"relaxation_time is {found} s")
    return found


def _call(policy: CrowdPolicy) -> PluginCall:
    return policy.call if isinstance(policy, CheckedPolicy) else CheckedPolicy(policy).call


#: Larger components of a result would overflow, m/s or m/s^2.
_MOST = 1e9


def _check(answer: Array, view: CrowdView, call: PluginCall) -> None:
    if answer.shape != view.position.shape:
        call.fail(f"returned shape {answer.shape} instead of {view.position.shape}")
    if np.vdot(answer, answer) < _MOST**2:  # neither is NaN
        return
    finite = np.all(np.abs(answer) < _MOST, axis=1)
    decides = view.present if view.decides is None else view.decides
    if not np.all(finite[decides]):
        row = int(np.flatnonzero(decides & ~finite)[0])
        call.fail(
            f"returned {answer[row].tolist()} for agent {view.agents.id[row]} at t = {view.t:g} s"
        )
