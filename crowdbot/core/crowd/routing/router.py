"""Router: caches shortest paths to a crowd's goals, and computes people's next waypoints."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

import crowdbot.core.crowd.state as s
from crowdbot.core.crowd.agents import Agents
from crowdbot.core.crowd.routing.packed_mesh import PackedMesh
from crowdbot.core.crowd.routing.parameters import WayFinding
from crowdbot.core.crowd.routing.route_map import RouteMap
from crowdbot.core.crowd.routing.waypoints import find_waypoints
from crowdbot.core.types.arrays import Array

#: Radii are rounded up to a multiple of this, so that few maps are needed, m.
_RADIUS_STEP = 0.05
_SLACK = 1e-9
#: Trees of goals that no person has any more are kept as long as there are not more.
_SPARE_TREES = 64


class Router:
    """Finds the waypoints of all people.

    Its cache follows from the goals alone, so it has no state.

    Args:
        agents: all, present or to come.
        walls, pillars: (S, 4), (P, 3) obstacles, m.
        routing: parameters of their choice of paths.
    """

    def __init__(self, agents: Agents, walls: Array, pillars: Array, routing: WayFinding) -> None:
        points = np.concatenate([np.stack([agents.x, agents.y], axis=1), agents.route])
        self._agents = agents
        self._habits = routing._replace(key=np.uint64(routing.key))
        self._classes = [
            _BodyClass(
                np.flatnonzero(rounded(agents.radius) == size),
                RouteMap.of(walls, pillars, float(size), points),
                len(agents),
            )
            for size in np.unique(rounded(agents.radius))
        ]

    def find(self, people: s.People, dt: float, decision: int = -1) -> None:
        """Set the waypoints of all people.

        Args:
            people: of the crowd's state.
            dt: since the last decision, s.
            decision: its number; below 0: all people look for paths, otherwise they take turns.
        """
        for one in self._classes:
            one.find(people, self._agents, self._habits, dt, decision)

    def way(self, row: int, start: tuple[float, float], goal: tuple[float, float]) -> Array:
        """Return the shortest path (K, 2) for agent ``row`` between two points, including both."""
        found = next(one for one in self._classes if row in one.members)
        return found.routes.way(start, goal)


def rounded(radius: Array) -> Array:
    """Return the radii (N,) for maps: rounded up to few different values, m."""
    steps = np.ceil(radius / _RADIUS_STEP - _SLACK)
    one = len(radius) > 0 and np.all(radius == radius[0])
    return radius.copy() if one else np.round(steps * _RADIUS_STEP, 9)


class _BodyClass:
    """People of similar radius, who share a map."""

    def __init__(self, members: NDArray[np.int64], routes: RouteMap, people: int) -> None:
        self.members, self.routes = members, routes
        self._map = PackedMesh.of(routes.corners.table, (routes.sight, routes.wider))
        self._goal = np.full((len(members), 2), np.nan)
        self._tree_of = np.zeros(people, np.int64)
        self._rows: dict[tuple[float, float], int] = {}
        self._free: list[int] = []
        self._left = np.zeros((0, routes.count))
        self._after = np.zeros((0, routes.count), np.int64)

    def find(
        self, people: s.People, agents: Agents, habits: WayFinding, dt: float, decision: int
    ) -> None:
        for _ in range(len(self.members)):  # usually none has a new goal, now and then one
            changed = self._waypoints(people, agents, habits, dt, decision)
            if not changed:
                return
            self._plan(people, changed - 1)
        self._waypoints(people, agents, habits, dt, decision)

    def _waypoints(
        self, people: s.People, agents: Agents, habits: WayFinding, dt: float, decision: int
    ) -> int:
        """Return 1 + the first member with a new goal; 0 after all waypoints are found."""
        fixed: tuple[Any, ...] = (*self._map, *habits)
        return find_waypoints(
            people, decision, dt, self.members, agents.id, agents.preferred_speed, self._goal,
            self._tree_of, self._left, self._after, *fixed,
        )  # fmt: skip

    def _plan(self, people: s.People, k: int) -> None:
        """Find the paths to a member's new goal."""
        row = self.members[k]
        x, y = float(people["goal_x"][row]), float(people["goal_y"][row])
        self._goal[k, 0], self._goal[k, 1] = x, y
        self._tree_of[row] = self._tree(x, y)
        people["corner"][row], people["waypoint_x"][row] = 0.0, np.nan

    def _tree(self, x: float, y: float) -> int:
        """Return the row of the paths to a goal, found or planned."""
        known = self._rows.get((x, y))
        if known is not None:
            return known
        if not self._free:
            self._drop()
        if not self._free:
            count, more = len(self._left), max(8, len(self._left))
            self._left = np.concatenate([self._left, np.zeros((more, self.routes.count))])
            self._after = np.concatenate(
                [self._after, np.zeros((more, self.routes.count), np.int64)]
            )
            self._free = list(range(count + more - 1, count - 1, -1))
        row = self._rows[x, y] = self._free.pop()
        self.routes.plan(x, y, self._left[row], self._after[row])
        return row

    def _drop(self) -> None:
        """Discard path trees to goals that no one has any more, if there are many."""
        used = {(x, y) for x, y in self._goal.tolist()}
        if len(self._rows) > len(used) + _SPARE_TREES:
            self._free = [row for goal, row in self._rows.items() if goal not in used]
            self._rows = {goal: row for goal, row in self._rows.items() if goal in used}
