"""Agents: what each person keeps for the whole run."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from crowdbot.core.types.arrays import Array

#: What happens at the end of a route: through the flow's portals and on; standing still; out of
#: the world for good; from the first point again.
PORTAL, STOP, REMOVE, LOOP = range(4)


@dataclass(frozen=True, slots=True, kw_only=True)
class Agents:
    """What an agent keeps for the whole run; SI units.

    Attributes:
        id, x, y, preferred_speed, radius, max_speed, max_acceleration, mass: (N,).
        start_time: (N,) when the agent enters the world, s.
        at_goal: (N,) ``PORTAL``, ``STOP``, ``REMOVE`` or ``LOOP``.
        flow: (N,) row of the world's portals, for ``PORTAL``.
        policy: (N,) number of the policy that the agent follows.
        route: (W, 2) points of all routes in the agents' order, m; for all but ``PORTAL``.
        first: (N + 1,) rows of ``route`` that belong to agent i: first[i] to first[i + 1].
        ignores_robot: (N,) whether the agent takes no notice of robots until they touch.
        late: (N,) whether the agent notices robots late, where people notice them at all.
        avoided_radius: (N,) of the disc that policies and steering parts keep clear of, m; by
            default ``radius``, which is what touches.
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
    avoided_radius: Array = field(default_factory=lambda: np.zeros(0))

    def __post_init__(self) -> None:
        for name in ("ignores_robot", "late"):
            if len(getattr(self, name)) != len(self.id):
                object.__setattr__(self, name, np.zeros(len(self.id), np.bool_))
        if len(self.avoided_radius) != len(self.id):
            object.__setattr__(self, "avoided_radius", self.radius)

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
        avoided_radius: ArrayLike | None = None,
    ) -> Agents:
        """Agents from rows or single numbers; with routes they stop at the end, else portals.

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
            avoided_radius=row(radius if avoided_radius is None else avoided_radius),
        )
        made.check()
        return made

    def check(self) -> None:
        """Refuse what would make a simulation meaningless.

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
        if np.any((self.at_goal < PORTAL) | (self.at_goal > LOOP)):
            raise ValueError("at_goal of agents must be PORTAL, STOP, REMOVE or LOOP")
