"""Drift, for all people at once."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from crowdbot.errors import InputError
from crowdbot.plugin import Agents, CrowdView
from numpy.typing import NDArray

from crowdbot_acme.drift import DriftSpec

Array = NDArray[np.float64]


class Drift:
    """Keeps nothing: the answer depends on the view alone."""

    def __init__(self, spec: DriftSpec) -> None:
        self._spec = spec

    def velocities(self, view: CrowdView, dt: float) -> Array:
        """Wanted velocities (N, 2), m/s."""
        del dt
        people = np.column_stack([view.position, view.velocity, view.agents.radius])
        discs = np.concatenate([people[view.present], view.others()])
        offset = view.position[:, None] - discs[None, :, :2]
        distance = np.hypot(offset[..., 0], offset[..., 1])
        gap = distance - view.agents.radius[:, None] - discs[None, :, 4]
        push = self._spec.push * np.exp(-np.maximum(gap, 0.0) / self._spec.fade)
        push[distance < 1e-9] = 0.0  # the person itself, or another one in exactly the same place
        away = offset / np.maximum(distance, 1e-9)[..., None]
        return np.asarray(_preferred(view) + np.einsum("nd,ndk->nk", push, away))


def _preferred(view: CrowdView) -> Array:
    """To the goal at preferred speed; zero for who is there."""
    way = view.goal - view.position
    left = np.hypot(way[:, 0], way[:, 1])[:, None]
    return np.asarray(view.agents.preferred_speed[:, None] * way / np.maximum(left, 1e-9))


def build(spec: DriftSpec, costs: Sequence[object], agents: Agents) -> Drift:
    """The policy for one set of agents.

    Raises:
        InputError: it was given cost functions.
    """
    del agents
    if costs:
        raise InputError("acme.drift takes no cost functions")
    return Drift(spec)
