"""What people want: a policy's answer, checked and as accelerations."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.crowd.policy import CrowdPolicy, CrowdView
from crowdbot.core.fault import described
from crowdbot.errors import CrowdbotError, PluginError

Array = NDArray[np.float64]


def willed(policy: CrowdPolicy, view: CrowdView) -> Array:
    """Accelerations (N, 2) of those who decide, m/s^2; others' rows mean nothing.

    Raises:
        PluginError: the policy raised, its answer has a wrong shape, or it is not finite for one
            who decides.
    """
    wanted = _checked(policy, _asked(policy, view), view)
    if hasattr(policy, "accelerations"):
        return wanted
    acceleration = (wanted - view.velocity) / view.dt
    norm = np.hypot(acceleration[:, 0], acceleration[:, 1])
    limit = view.agents.max_acceleration
    scale = np.minimum(1.0, limit / np.maximum(norm, limit))
    return np.asarray(acceleration * scale[:, np.newaxis])


def _asked(policy: CrowdPolicy, view: CrowdView) -> Array:
    try:
        if hasattr(policy, "accelerations"):
            return policy.accelerations(view)
        return policy.velocities(view, view.dt)
    except CrowdbotError:
        raise
    except (Exception, SystemExit) as error:
        name = type(policy).__name__
        text = f"crowd policy {name} at t = {view.t:g} s: {described(error)}"
        raise PluginError(text) from error


def _checked(policy: CrowdPolicy, answer: Array, view: CrowdView) -> Array:
    name = type(policy).__name__
    if np.shape(answer) != view.position.shape:
        raise PluginError(
            f"crowd policy {name} returned shape {np.shape(answer)} instead of "
            f"{view.position.shape}"
        )
    decides = view.present if view.decides is None else view.decides
    finite = np.all(np.isfinite(answer), axis=1)
    if not np.all(finite[decides]):
        row = int(np.flatnonzero(decides & ~finite)[0])
        raise PluginError(
            f"crowd policy {name} returned {np.asarray(answer)[row].tolist()} for agent "
            f"{view.agents.id[row]} at t = {view.t:g} s"
        )
    return answer
