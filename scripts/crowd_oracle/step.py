"""One step of our crowd in the original engine's order, from any state.

Decisions are those of our policies; contact, clamping and motion are a tick of our engine itself.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from crowdbot.core.crowd import state as s
from crowdbot.core.crowd.agents import STOP
from crowdbot.core.crowd.build import build_cost
from crowdbot.core.crowd.engine import CrowdEngine
from crowdbot.core.crowd.policy import CrowdView
from crowdbot.core.crowd.world import CrowdWorld
from crowdbot.core.registry.registry import discover
from crowdbot.core.support.ticks import TICKS_PER_SECOND
from crowdbot.core.types.arrays import Array, Mask
from crowdbot.plugins.crowd.policies.velocity_space_build import VelocitySpace
from scripts.crowd_oracle.case import Case
from scripts.crowd_oracle.quirks import push_out_of_reach


class Stepper:
    """The policies of a case, ready to step; random numbers continue from step to step."""

    def __init__(self, case: Case) -> None:
        self.case = case
        registry = discover()
        self.policies = [
            VelocitySpace(
                spec, [build_cost(registry, c) for c in costs], case.agents,
                parity=True, weight=case.agents.mass,
            )
            for spec, costs in case.policies
        ]  # fmt: skip
        reach = [
            max((c.range.value for c in costs), default=0.0)  # type: ignore[attr-defined]
            for _, costs in case.policies
        ]
        agents = case.agents
        self._reach = np.array(reach)[agents.policy]
        stiffness = np.array([p.contact_stiffness for p in self.policies])[agents.policy]
        self._stiffness = stiffness / agents.mass
        self._engine, self._told = _engine(case, self._stiffness)

    def random(self) -> list[Array]:
        """Return a copy of the state of all random numbers."""
        return [p.costs.random.copy() for p in self.policies]

    def restore(self, random: list[Array]) -> None:
        """Restore a state of all random numbers."""
        for policy, state in zip(self.policies, random, strict=True):
            policy.costs.random[:] = state

    def view(self, state: Array, policy: int, who: Mask | None = None) -> CrowdView:
        """Return the view of agents at a state (N, 4), for those who follow a policy."""
        case = self.case
        present: Mask = np.all(np.isfinite(state), axis=1)
        mine: Mask = case.agents.policy == policy
        filled = np.where(present[:, np.newaxis], state, 0.0)
        return CrowdView(
            agents=case.agents, position=np.ascontiguousarray(filled[:, :2]),
            velocity=np.ascontiguousarray(filled[:, 2:]), goal=case.goal, present=present,
            robot=np.zeros((0, 5)), walls=case.walls, dt=case.dt,
            decides=mine if who is None else mine & who,
            periodic_boundary=case.periodic_boundary, diagonal=False,
        )  # fmt: skip

    def push(self, state: Array) -> Array:
        """Return the change of velocity (N, 2) by contact in one step, from standstill."""
        at_rest = np.column_stack([state[:, :2], np.zeros((len(state), 2))])
        return self.move(at_rest, np.zeros((len(state), 2)))[:, 2:]

    def step(self, state: Array, who: Mask | None = None) -> Array:
        """Return states (N, 4) after one step; meaningless for agents not in ``who``."""
        acceleration = np.zeros((len(state), 2))
        for k, policy in enumerate(self.policies):
            mine = self.case.agents.policy == k
            if np.any(mine if who is None else mine & who):
                acceleration[mine] = policy.accelerations(self.view(state, k, who))[mine]
        return self.move(state, acceleration)

    def move(self, state: Array, acceleration: Array) -> Array:
        """Return states (N, 4) after an engine step with given accelerations (N, 2)."""
        case, engine = self.case, self._engine
        present: Mask = np.all(np.isfinite(state), axis=1)
        flat = s.blank(len(state), robots=0)
        _, rows = s.view(flat)
        rows[:, s.X : s.VY + 1] = np.where(present[:, np.newaxis], state, 0.0)
        rows[:, s.GOAL_X : s.GOAL_Y + 1] = case.goal
        rows[:, s.WAITING] = np.where(present, s.PRESENT, s.GONE)
        self._told.accelerations_told = np.where(present[:, np.newaxis], acceleration, 0.0)
        engine.advance(flat, dt=case.dt)
        moved = rows[:, s.X : s.VY + 1].copy()
        excess = push_out_of_reach(case, state, self._reach) * self._stiffness[:, np.newaxis]
        moved[:, 2:] -= excess * case.dt
        moved[:, :2] -= excess * case.dt**2
        moved[~present] = np.nan
        return moved


@dataclass(slots=True)
class _Told:
    """The desired acceleration given to each agent.

    Attributes:
        accelerations_told: (N, 2), m/s^2.
    """

    accelerations_told: Array


@dataclass(frozen=True, slots=True)
class _Obedient:
    """A policy that returns given accelerations; contact stiffness is per agent (1/s^2)."""

    told: _Told
    contact_stiffness: float = field(default=0.0)

    def accelerations(self, view: CrowdView) -> Array:
        """Return the given accelerations."""
        del view
        return self.told.accelerations_told


def _engine(case: Case, stiffness: Array) -> tuple[CrowdEngine, _Told]:
    """Return our engine in a case's world, deciding at every tick, and its given accelerations."""
    values = _Told(np.zeros((len(stiffness), 2)))
    kinds, policy = np.unique(stiffness, return_inverse=True)
    agents = replace(case.agents, policy=policy.astype(np.int64),
                     at_goal=np.full(len(stiffness), STOP))  # fmt: skip
    world = CrowdWorld(
        walls=case.walls, periodic_boundary=case.periodic_boundary, parity=True,
        decision_rate=TICKS_PER_SECOND,
    )  # fmt: skip
    obedient: list[Any] = [_Obedient(values, float(k)) for k in kinds]
    return CrowdEngine(agents, world, obedient), values
