"""What people want: a policy's answer, checked and as accelerations."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.crowd.policy import CrowdPolicy, CrowdView
from crowdbot.errors import CrowdbotError, PluginError

Array = NDArray[np.float64]


def willed(policy: CrowdPolicy, view: CrowdView) -> Array:
    """Accelerations (N, 2) of those who decide, m/s^2; others' rows mean nothing.

    Raises:
        PluginError: the policy raised, its answer has a wrong shape, or is not finite for one who
            decides.
    """
    if hasattr(policy, "accelerations"):
        return _answer(policy, lambda: policy.accelerations(view), view)
    wanted = _answer(policy, lambda: policy.velocities(view, view.dt), view)
    acceleration = (wanted - view.velocity) / view.dt
    norm = np.hypot(acceleration[:, 0], acceleration[:, 1])
    limit = view.agents.max_acceleration
    scale = np.minimum(1.0, limit / np.maximum(norm, limit))
    return np.asarray(acceleration * scale[:, np.newaxis])


def _answer(policy: CrowdPolicy, ask: Callable[[], object], view: CrowdView) -> Array:
    name = getattr(policy, "kind", type(policy).__name__)
    try:
        answer = np.asarray(ask(), np.float64)
    except CrowdbotError:
        raise
    except Exception as error:
        raise PluginError(f"crowd policy {name}: {type(error).__name__}: {error}") from error
    if answer.shape != view.position.shape:
        raise PluginError(
            f"crowd policy {name} returned shape {answer.shape} instead of {view.position.shape}"
        )
    decides = view.present if view.decides is None else view.decides
    finite = np.all(np.isfinite(answer), axis=1)
    if not np.all(finite[decides]):
        row = int(np.flatnonzero(decides & ~finite)[0])
        raise PluginError(
            f"crowd policy {name} returned {answer[row].tolist()} for agent "
            f"{view.agents.id[row]} at t = {view.t:g} s"
        )
    return answer
