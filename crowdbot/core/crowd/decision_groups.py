"""Groups of agents who decide together."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.crowd.agents import Agents
from crowdbot.core.crowd.policy import CrowdPolicy
from crowdbot.core.crowd.world import CrowdWorld


@dataclass(frozen=True, slots=True)
class DecisionGroup:
    """Agents with the same policy, who decide together.

    Attributes:
        foreign: True for a third-party policy; crowdbot's own never write to their inputs.
    """

    policy: CrowdPolicy
    members: NDArray[np.bool_]
    sees_robot: bool
    foreign: bool


def who_plans(agents: Agents, world: CrowdWorld) -> NDArray[np.bool_]:
    """Return (N,) True for agents whose policy sees robots: not those who notice robots late."""
    return ~(agents.ignores_robot | agents.late) & world.response.shown_to_policies


def groups_by_policy(
    policies: Sequence[CrowdPolicy], agents: Agents, sees_robot: NDArray[np.bool_]
) -> list[DecisionGroup]:
    """Return groups of agents by policy, and by whether the policy sees robots."""
    groups = []
    for number, policy in enumerate(policies):
        for sees in (True, False):
            members = (agents.policy == number) & (sees_robot == sees)
            if np.any(members):
                groups.append(DecisionGroup(policy, members, sees, _is_foreign(policy)))
    return groups


def _is_foreign(policy: CrowdPolicy) -> bool:
    without_checks = getattr(policy, "_policy", policy)
    return not type(without_checks).__module__.startswith("crowdbot.")
