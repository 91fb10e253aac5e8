"""Policies that follow a record: exactly, or through another policy that avoids others."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from crowdbot.plugin import (
    Agents,
    Array,
    CrowdPolicy,
    CrowdView,
    InputError,
    RecordedCrowd,
    desired_acceleration,
    read_record,
)
from crowdbot.plugins.crowd.policies.replay import ReplaySpec
from crowdbot.plugins.crowd.policies.velocity_space import VelocitySpaceSpec
from crowdbot.plugins.crowd.policies.velocity_space_build import build as velocity_space


class Replay:
    """Agents walk with the recorded velocity, and return to the record after a push."""

    walks_through_walls = True

    def __init__(self, record: RecordedCrowd, contact_stiffness: float = 0.0) -> None:
        self._record = record
        self.contact_stiffness = contact_stiffness

    def velocities(self, view: CrowdView, dt: float) -> Array:
        """Return the recorded step plus a correction of the position error, limited by braking."""
        now = places(self._record, view, view.t)
        error = now - view.position
        away = np.hypot(error[:, 0], error[:, 1])
        braking = np.sqrt(view.agents.max_acceleration * away)
        back = np.minimum(away / dt, braking) / np.maximum(away, 1e-12)
        step = (places(self._record, view, view.t + dt) - now) / dt
        return np.asarray(step + error * back[:, np.newaxis])


class ReactiveReplay:
    """Agents walk by another policy towards the recorded position some seconds ahead."""

    def __init__(self, record: RecordedCrowd, inner: CrowdPolicy, ahead: float) -> None:
        self._record, self._inner, self._ahead = record, inner, ahead
        stiffness = getattr(inner, "contact_stiffness", None)
        if stiffness is not None:
            self.contact_stiffness: float = stiffness
        self.relaxation_time: float = getattr(inner, "relaxation_time", 0.0)

    def accelerations(self, view: CrowdView) -> Array:
        """Return the other policy's accelerations towards the recorded positions, m/s^2."""
        return desired_acceleration(
            self._inner, replace(view, goal=places(self._record, view, view.t + self._ahead))
        )


def places(record: RecordedCrowd, view: CrowdView, t: float) -> Array:
    """Return people's recorded positions (N, 2) at time t (s), m; absent agents keep theirs."""
    found = view.position.copy()
    for i in np.flatnonzero(view.present):
        found[i] = record.at(int(view.agents.id[i]), t)
    return found


def build(spec: ReplaySpec, costs: Sequence[object], agents: Agents) -> CrowdPolicy:
    """Build the policy for a set of agents.

    Raises:
        InputError: the file is not a record, or does not contain an agent.
    """
    record = read_record(spec.file.file)
    missing = sorted(set(agents.id.tolist()) - set(record.time))
    if missing:
        raise InputError(f"{spec.file.path}: no person with id {missing[0]} is recorded")
    if not costs:
        return Replay(record, spec.contact_stiffness)
    walking = VelocitySpaceSpec(contact_stiffness=spec.contact_stiffness)
    return ReactiveReplay(record, velocity_space(walking, costs, agents), spec.ahead)  # type: ignore[arg-type]
