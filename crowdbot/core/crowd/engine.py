"""The crowd engine: state, decisions and ticks of one crowd. Works without Drake."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.crowd import state as s
from crowdbot.core.crowd.contact import push_apart
from crowdbot.core.crowd.policy import Agents, CrowdPolicy, CrowdView
from crowdbot.core.crowd.portals import draw_goal
from crowdbot.core.crowd.step import tick
from crowdbot.core.ticks import TICK, ticks

Array = NDArray[np.float64]
NOBODY = np.zeros((0, 6))
_SEEN = np.array([0, 1, 2, 3, 5])  # columns of a robot that people know: all but its true radius


@dataclass(frozen=True, slots=True, kw_only=True)
class CrowdWorld:
    """Where a crowd walks and how it takes robots.

    Attributes:
        walls: (S, 4) segments that people avoid, m.
        entrance, out: (4,) boxes x0, x1, y0, y1 of the portals, m.
        response: (3,) see `crowdbot.core.crowd.contact.keep_off`.
        robot_visible: whether people see the robot's velocity.
        stiffness, dissipation: contact with the robot, N/m and s/m.
        goal_key: key of the counter-based draws of goals and entries.
        decision_rate: Hz.
    """

    walls: Array
    entrance: Array
    out: Array
    response: Array
    robot_visible: bool
    stiffness: float
    dissipation: float
    goal_key: int
    decision_rate: float


class CrowdEngine:
    """Advances a flat state vector in place; keeps no state of its own."""

    def __init__(
        self, agents: Agents, world: CrowdWorld, make_policy: Callable[[Agents], CrowdPolicy]
    ) -> None:
        self.agents, self.world = agents, world
        self._policy = make_policy(agents)
        self._ticks_per_decision = ticks(world.decision_rate)
        self._key = np.uint64(world.goal_key)
        self._reaction = np.zeros((len(agents), 2))

    def initial_state(self) -> Array:
        """Everybody at the start, walking towards the first goal at preferred speed."""
        flat = np.zeros(s.size(len(self.agents)))
        _, rows = s.view(flat)
        a = self.agents
        rows[:, s.X], rows[:, s.Y] = a.x, a.y
        for i in range(len(a)):
            draw_goal(rows, i, a.id, a.radius, self.world.out, self._key)
        to_goal = rows[:, s.GOAL_X : s.GOAL_Y + 1] - rows[:, s.X : s.Y + 1]
        distance = np.maximum(np.hypot(to_goal[:, 0], to_goal[:, 1]), 1e-9)
        rows[:, s.VX : s.VY + 1] = to_goal * (a.preferred_speed / distance)[:, np.newaxis]
        rows[:, s.DIR_X : s.DIR_Y + 1] = to_goal / distance[:, np.newaxis]
        return flat

    def advance(self, flat: Array, robots: Array = NOBODY) -> None:
        """One tick of 1/128 s, in place; decides first when a decision is due.

        Args:
            flat: state vector.
            robots: (R, 6) x, y, vx, vy, physical and perceived radius.
        """
        if int(flat[s.TICK]) % self._ticks_per_decision == 0:
            self._decide(flat, robots)
        a, w = self.agents, self.world
        tick(
            flat, s.AGENT_COLUMNS, robots, a.id, a.radius, a.mass, a.preferred_speed,
            a.max_speed, w.entrance, w.out, w.response, w.stiffness, w.dissipation,
            self._key, TICK, self._reaction,
        )  # fmt: skip

    def _decide(self, flat: Array, robots: Array) -> None:
        _, rows = s.view(flat)
        seen = robots[:, _SEEN]
        if not self.world.robot_visible:
            seen[:, 2:4] = 0.0
        view = CrowdView(
            agents=self.agents,
            position=np.ascontiguousarray(rows[:, s.X : s.Y + 1]),
            velocity=np.ascontiguousarray(rows[:, s.VX : s.VY + 1]),
            goal=np.ascontiguousarray(rows[:, s.GOAL_X : s.GOAL_Y + 1]),
            present=rows[:, s.WAITING] == 0.0,
            robot=seen,
            walls=self.world.walls,
            dt=self._ticks_per_decision * TICK,
        )
        rows[:, s.AX : s.AY + 1] = self._policy.accelerations(view)
        order = np.argsort(rows[:, s.X], kind="stable")
        push_apart(
            rows, self.agents.radius, order, self.world.walls, self._policy.contact_stiffness
        )


__all__: Sequence[str] = ("CrowdEngine", "CrowdWorld")
