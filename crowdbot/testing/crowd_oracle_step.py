"""One step of our crowd as the original engine makes it, from any state."""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from crowdbot.core.crowd.build import build_cost
from crowdbot.core.crowd.contact.geometry import nearest_on_segment
from crowdbot.core.crowd.policy import CrowdView
from crowdbot.core.crowd.velocity_search.neighbour_discs import most_discs, write_discs
from crowdbot.core.crowd.velocity_search.neighbours import DISC_COLUMNS
from crowdbot.core.registry.registry import discover
from crowdbot.core.types.arrays import Array, Mask
from crowdbot.plugins.crowd.policies.velocity_space_build import VelocitySpace
from crowdbot.testing.crowd_oracle_case import Case


class Stepper:
    """The policies of a case, ready to step; random numbers go on from step to step."""

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
        agents = case.agents
        largest = float(np.max(agents.radius, initial=0.0))
        reach = [
            max((c.range.value for c in costs), default=0.0)  # type: ignore[attr-defined]
            for _, costs in case.policies
        ]
        self._reach = np.array(reach)[agents.policy]
        self._stiffness = np.array([p.contact_stiffness for p in self.policies])[agents.policy]
        self._images = 2.0 * largest

    def random(self) -> list[Array]:
        """State of all random numbers, a copy."""
        return [p.costs.random.copy() for p in self.policies]

    def restore(self, random: list[Array]) -> None:
        """Go back to a state of all random numbers."""
        for policy, state in zip(self.policies, random, strict=True):
            policy.costs.random[:] = state

    def view(self, state: Array, policy: int, who: Mask | None = None) -> CrowdView:
        """What agents see at a state (N, 4), for those who follow a policy."""
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
        """Change of velocity (N, 2) by contact forces in one step."""
        view, agents = self.view(state, 0), self.case.agents
        bodies = np.zeros(
            (most_discs(len(agents), 0, view.periodic_boundary is not None), DISC_COLUMNS)
        )
        box = np.array(
            view.periodic_boundary if view.periodic_boundary is not None else (0.0, 0.0, 0.0, 0.0)
        )
        count = write_discs(
            view.position, view.velocity, view.goal, agents.radius, agents.preferred_speed,
            view.present, view.robot, view.pillars, box, False, self._images, bodies,
        )  # fmt: skip
        force = np.zeros((len(agents), 2))
        _contact(
            view.position, view.present, agents.radius, bodies[:count], view.walls, self._reach,
            self._stiffness, force,
        )  # fmt: skip
        return force * (self.case.dt / agents.mass)[:, np.newaxis]

    def step(self, state: Array, who: Mask | None = None) -> Array:
        """Velocities (N, 2) after one step; meaningless for agents that are not asked for."""
        acceleration = np.zeros((len(state), 2))
        for k, policy in enumerate(self.policies):
            mine = self.case.agents.policy == k
            if np.any(mine if who is None else mine & who):
                acceleration[mine] = policy.accelerations(self.view(state, k, who))[mine]
        return self.move(state, acceleration)

    def move(self, state: Array, acceleration: Array) -> Array:
        """Velocities (N, 2) after a step with given accelerations."""
        moved = state[:, 2:] + acceleration * self.case.dt
        speed = np.hypot(moved[:, 0], moved[:, 1])
        limit = self.case.agents.max_speed
        with np.errstate(invalid="ignore", divide="ignore"):
            scale = np.where(speed > limit, limit / speed, 1.0)
        return np.asarray(moved * scale[:, np.newaxis] + self.push(state))


@njit(cache=True, error_model="numpy")
def _contact(
    position: Array,
    present: Mask,
    radius: Array,
    bodies: Array,
    walls: Array,
    reach: Array,
    stiffness: Array,
    force: Array,
) -> None:
    """Pushes between everybody within the policy's range, which the original asks for."""
    for i in range(position.shape[0]):
        if not present[i]:
            continue
        x, y = position[i, 0], position[i, 1]
        for b in range(bodies.shape[0]):
            dx, dy = x - bodies[b, 0], y - bodies[b, 1]
            distance = math.sqrt(dx * dx + dy * dy)
            depth = radius[i] + bodies[b, 4] - distance
            if depth > 0.0 and 0.0 < distance < reach[i]:
                force[i, 0] += stiffness[i] * depth * dx / distance
                force[i, 1] += stiffness[i] * depth * dy / distance
        for s in range(walls.shape[0]):
            nx, ny = nearest_on_segment(x, y, walls[s, 0], walls[s, 1], walls[s, 2], walls[s, 3])
            dx, dy = x - nx, y - ny
            distance = math.sqrt(dx * dx + dy * dy)
            if 0.0 < distance < radius[i] and distance <= reach[i]:
                force[i, 0] += stiffness[i] * (radius[i] - distance) * dx / distance
                force[i, 1] += stiffness[i] * (radius[i] - distance) * dy / distance
