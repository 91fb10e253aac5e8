"""Agents: constant data of each person."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from crowdbot.core.types.appearance import Appearance
from crowdbot.core.types.arrays import Array

#: Behaviour at the end of a route: through the flow's portals and on; stand still; leave the world
#: for good; start from the first point again; back to the entrance; on in the direction from the
#: first point to the second, forever.
PORTAL, STOP, REMOVE, LOOP, RETURN, ONWARD = range(6)

#: Spacing of group members side by side, between centres, m.
_ABREAST = 0.75


@dataclass(frozen=True, slots=True, kw_only=True)
class Agents:
    """Constant data of all agents of a run; SI units.

    Attributes:
        id, x, y, preferred_speed, radius, max_speed, max_acceleration, mass: (N,).
        start_time: (N,) when the agent enters the world, s.
        at_goal: (N,) ``PORTAL``, ``STOP``, ``REMOVE``, ``LOOP``, ``RETURN`` or ``ONWARD``.
        flow: (N,) row of the world's portals, for ``PORTAL``.
        policy: (N,) index of the agent's policy.
        route: (W, 2) points of all routes in the agents' order, m; for all but ``PORTAL``.
        first: (N + 1,) rows of ``route`` that belong to agent i: first[i] to first[i + 1].
        ignores_robot: (N,) True if the agent ignores robots until they touch.
        late: (N,) True if the agent notices robots late, if people notice them at all.
        attention: (N,) from 0 to 1, of the people who do not ignore robots: the more, the larger
            their clearance.
        goal_area: (W, 3) size along own x and y (m) and rotation (rad) of the area around each
            point of ``route``; zeros: the point itself is the goal.
        pause: (W,) time at each point, s.
        ahead: (N,) row of the previous agent in a queue; -1: not in a queue, or first.
        origin: (N, 5) centre, size and rotation of the area in which the agent enters, m and rad;
            zeros: a point.
        group: (N,) number of the agent's group; -1: alone.
        heading: (N,) facing direction of agents that start at their goal, rad.
        looks: appearance for sensors; None: all default.
        avoided_radius: (N,) radius that policies and steering parts keep clear, m; default:
            ``radius``, which is used for contact.
    """

    id: NDArray[np.int64]
    x: Array
    y: Array
    preferred_speed: Array
    radius: Array
    max_speed: Array
    max_acceleration: Array
    mass: Array
    start_time: Array
    at_goal: NDArray[np.int64]
    flow: NDArray[np.int64]
    policy: NDArray[np.int64]
    route: Array
    first: NDArray[np.int64]
    ignores_robot: NDArray[np.bool_] = field(default_factory=lambda: np.zeros(0, np.bool_))
    late: NDArray[np.bool_] = field(default_factory=lambda: np.zeros(0, np.bool_))
    attention: Array = field(default_factory=lambda: np.zeros(0))
    goal_area: Array = field(default_factory=lambda: np.zeros((0, 3)))
    pause: Array = field(default_factory=lambda: np.zeros(0))
    ahead: NDArray[np.int64] = field(default_factory=lambda: np.zeros(0, np.int64))
    origin: Array = field(default_factory=lambda: np.zeros((0, 5)))
    group: NDArray[np.int64] = field(default_factory=lambda: np.zeros(0, np.int64))
    heading: Array = field(default_factory=lambda: np.zeros(0))
    looks: Appearance | None = None
    avoided_radius: Array = field(default_factory=lambda: np.zeros(0))

    def __post_init__(self) -> None:
        count, points = len(self.id), len(self.route)
        for name, usual in (
            ("ignores_robot", np.zeros(count, np.bool_)),
            ("late", np.zeros(count, np.bool_)),
            ("attention", np.full(count, 0.5)),
            ("goal_area", np.zeros((points, 3))),
            ("pause", np.zeros(points)),
            ("ahead", np.full(count, -1, np.int64)),
            ("origin", np.zeros((count, 5))),
            ("group", np.full(count, -1, np.int64)),
            ("heading", np.zeros(count)),
            ("avoided_radius", self.radius),
        ):
            if len(getattr(self, name)) != len(usual):
                object.__setattr__(self, name, usual)

    def __len__(self) -> int:
        return len(self.id)

    @classmethod
    def of(
        cls,
        *,
        x: ArrayLike,
        y: ArrayLike,
        preferred_speed: ArrayLike = 1.4,
        id: ArrayLike | None = None,
        radius: ArrayLike = 0.33,
        max_speed: ArrayLike = 3.0,
        max_acceleration: ArrayLike = 5.0,
        mass: ArrayLike = 75.0,
        start_time: ArrayLike = 0.0,
        at_goal: ArrayLike | None = None,
        flow: ArrayLike = 0,
        policy: ArrayLike = 0,
        routes: Sequence[Sequence[tuple[float, float]]] | None = None,
        ignores_robot: ArrayLike = False,
        late: ArrayLike = False,
        attention: ArrayLike = 0.5,
        goal_areas: Sequence[Sequence[tuple[float, ...]]] | None = None,
        pauses: Sequence[Sequence[float]] | None = None,
        ahead: ArrayLike = -1,
        origins: Sequence[Sequence[float]] | None = None,
        group: ArrayLike = -1,
        heading: ArrayLike = 0.0,
        looks: Appearance | None = None,
        avoided_radius: ArrayLike | None = None,
    ) -> Agents:
        """Build agents from arrays (N,) or single numbers.

        With routes people stop at the last point, else they re-enter through portals.
        ``goal_areas`` and ``pauses`` are, per agent, empty or have an entry per point of its route;
        ``origins`` are empty or five numbers.

        Raises:
            ValueError: rows differ in length, ids repeat, or a number is not finite.
        """
        count = len(np.atleast_1d(np.asarray(x)))
        end = (PORTAL if routes is None else STOP) if at_goal is None else at_goal
        lengths = [0] * count if routes is None else [len(route) for route in routes]
        if len(lengths) != count:
            raise ValueError(f"{len(lengths)} routes for {count} agents")
        points = [point for route in routes or () for point in route]

        def row(values: ArrayLike, dtype: type = np.float64) -> NDArray[Any]:
            return np.array(np.broadcast_to(np.asarray(values, dtype=dtype), (count,)))

        made = cls(
            id=row(np.arange(count) if id is None else id, np.int64),
            x=row(x),
            y=row(y),
            preferred_speed=row(preferred_speed),
            radius=row(radius),
            max_speed=row(max_speed),
            max_acceleration=row(max_acceleration),
            mass=row(mass),
            start_time=row(start_time),
            at_goal=row(end, np.int64),
            flow=row(flow, np.int64),
            policy=row(policy, np.int64),
            route=np.array(points, dtype=np.float64).reshape(-1, 2),
            first=np.concatenate([[0], np.cumsum(lengths, dtype=np.int64)]),
            ignores_robot=row(ignores_robot, np.bool_),
            late=row(late, np.bool_),
            attention=row(attention),
            goal_area=_along(routes, goal_areas, (0.0, 0.0, 0.0)).reshape(-1, 3),
            pause=_along(routes, pauses, 0.0),
            ahead=row(ahead, np.int64),
            origin=np.array([o or (0.0,) * 5 for o in origins or [()] * count]).reshape(-1, 5),
            group=row(group, np.int64),
            heading=row(heading),
            looks=looks,
            avoided_radius=row(radius if avoided_radius is None else avoided_radius),
        )
        made.check()
        return made

    def check(self) -> None:
        """Raise an error for values that make no valid simulation.

        Raises:
            ValueError: ids repeat, a number is not finite or a size is not positive.
        """
        if len(np.unique(self.id)) != len(self):
            raise ValueError("each agent needs an id of its own")
        for name in ("x", "y", "preferred_speed", "start_time", "route"):
            if not np.all(np.isfinite(getattr(self, name))):
                raise ValueError(f"{name} of agents must be finite")
        for name in ("radius", "avoided_radius", "max_speed", "max_acceleration", "mass"):
            values = getattr(self, name)
            if not np.all(np.isfinite(values) & (values > 0.0)):
                raise ValueError(f"{name} of agents must be finite and above 0")
        if np.any(self.preferred_speed < 0.0):
            raise ValueError("preferred_speed of agents must not be negative")
        if not np.all((self.attention >= 0.0) & (self.attention <= 1.0)):
            raise ValueError("attention of agents must be from 0 to 1")
        if np.any((self.at_goal < PORTAL) | (self.at_goal > ONWARD)):
            raise ValueError(
                "at_goal of agents must be PORTAL, STOP, REMOVE, LOOP, RETURN or ONWARD"
            )
        self._check_ways()

    def _check_ways(self) -> None:
        for name in ("goal_area", "pause", "origin", "heading"):
            if not np.all(np.isfinite(getattr(self, name))):
                raise ValueError(f"{name} of agents must be finite")
        if np.any(self.pause < 0.0) or np.any(self.goal_area[:, :2] < 0.0):
            raise ValueError("pauses and areas of agents must not be negative")
        if np.any(self.ahead >= np.arange(len(self))):
            raise ValueError("agents queue behind one of an earlier row")
        points = np.diff(self.first)
        if np.any(points[self.at_goal == ONWARD] != 2):
            raise ValueError("ONWARD needs two points")
        returns = self.at_goal == RETURN
        if np.any(points[returns] == 0) or np.any(self.origin[returns, 2:4] <= 0.0):
            raise ValueError("RETURN needs a route and an origin")

    @property
    def guide(self) -> NDArray[np.int64]:
        """Return (N,) the id of the first member of each agent's group, or its own id if alone.

        All members of a group use the random draws of this agent.
        """
        guide = self.id.copy()
        for number in np.unique(self.group[self.group >= 0]):
            members = self.group == number
            guide[members] = self.id[members].min()
        return guide

    @property
    def abreast(self) -> Array:
        """Return (N,) how far each agent's goal is to the left of its group's goal, m."""
        beside = np.zeros(len(self))
        for number in np.unique(self.group[self.group >= 0]):
            members = np.flatnonzero(self.group == number)
            members = members[np.argsort(self.id[members])]
            beside[members] = _ABREAST * (np.arange(len(members)) - 0.5 * (len(members) - 1))
        return beside


def _along(routes: Sequence[Sequence[Any]] | None, given: Any, usual: Any) -> Array:
    """Return one entry per point of all routes; the default for agents without entries.

    Raises:
        ValueError: an agent has a different number of entries than points.
    """
    routes = routes or ()
    given = given or [()] * len(routes)
    found: list[Any] = []
    for route, own in zip(routes, given, strict=True):
        if len(own) not in (0, len(route)):
            raise ValueError(f"{len(own)} entries for a route of {len(route)} points")
        found += own or [usual] * len(route)
    return np.array(found, dtype=np.float64)
