"""What people want: a policy's answer, checked and as accelerations."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.crowd.policy import CrowdPolicy, CrowdView
from crowdbot.core.fault import described
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
    except (Exception, SystemExit) as error:
        text = f"crowd policy {name} at t = {view.t:g} s: {described(error)}"
        raise PluginError(text) from error
    if answer.shape != view.position.shape:
        raise PluginError(
            f"crowd policy {name} returned shape {answer.shape} instead of {view.position.shape}"
        )
    finite = np.isfinite(answer)
    if finite.all():
        return answer
    finite = np.all(finite, axis=1)
    decides = view.present if view.decides is None else view.decides
    if not np.all(finite[decides]):
        row = int(np.flatnonzero(decides & ~finite)[0])
        raise PluginError(
            f"crowd policy {name} returned {answer[row].tolist()} for agent "
            f"{view.agents.id[row]} at t = {view.t:g} s"
        )
    return answer
