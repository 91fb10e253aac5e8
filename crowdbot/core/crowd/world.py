"""CrowdWorld: a crowd's place, and its response to robots."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Literal

import numpy as np

from crowdbot.core.crowd.agents import PORTAL, Agents
from crowdbot.core.crowd.periodic_boundary import Box, images
from crowdbot.core.crowd.response.parameters import Human
from crowdbot.core.crowd.routing.parameters import WayFinding
from crowdbot.core.crowd.steering.parameters import Steering
from crowdbot.core.types.arrays import Array
from crowdbot.dsl.scenario.group_forces import GroupForces

_COLUMNS = {"walls": 4, "pillars": 3, "entrance": 4, "out": 4}


@dataclass(frozen=True, slots=True, kw_only=True)
class CrowdWorld:
    """The floor of a crowd and its response to robots; by default an endless empty floor.

    A single row is treated as a table of one.

    Attributes:
        walls: (S, 4) segments that people avoid, m.
        pillars: (P, 3) x, y and radius of round obstacles, m.
        solids: convex, counter-clockwise outlines (K, 2), m, where no person comes in; their sides
            are walls, too.
        periodic_boundary: (x0, x1, y0, y1) of a floor whose opposite borders are joined, m;
            infinite where it has no border.
        entrance, out: (F, 4) boxes x0, x1, y0, y1 of each flow's portals, m.
        exit_point: where people leave the in-portal: at a random point, or with ``offset`` opposite
            to where they entered the out-portal.
        goal_point: where people go in the out-portal: to a random point, or straight ``ahead``,
            opposite to the start of the trip.
        response: response to robots.
        cohesion: group forces, or None.
        steering: steering parts besides the policy.
        robot_visible: True if people see the robot's velocity.
        firm: True if no body overlaps anything solid by more than 2 cm; else people are only pushed
            out, and just their centres never come in.
        stiffness, dissipation: contact with the robot, N/m and s/m.
        body_dissipation: of contact among people and with walls, s/m; 0: they bounce off.
        goal_key: key of the counter-based draws of goals and entries.
        decision_rate: Hz, a power of two up to 128.
        routing: path finding around walls and pillars; None: straight to their goals.
        parity: behave like the original engine at a periodic boundary: no images across corners,
            and goals that do not wrap. For comparisons only.
    """

    walls: Array = field(default_factory=lambda: np.zeros((0, 4)))
    pillars: Array = field(default_factory=lambda: np.zeros((0, 3)))
    solids: tuple[Array, ...] = ()
    periodic_boundary: Box | None = None
    entrance: Array = field(default_factory=lambda: np.zeros((0, 4)))
    out: Array = field(default_factory=lambda: np.zeros((0, 4)))
    exit_point: Literal["random", "offset"] = "random"
    goal_point: Literal["random", "ahead"] = "random"
    response: Human = field(default_factory=Human)
    cohesion: GroupForces | None = field(default_factory=GroupForces)
    steering: Steering = field(default_factory=Steering)
    robot_visible: bool = True
    firm: bool = False
    stiffness: float = 30000.0
    dissipation: float = 0.3
    body_dissipation: float = 0.0
    goal_key: int = 0
    decision_rate: float = 16.0
    routing: WayFinding | None = None
    parity: bool = False

    def __post_init__(self) -> None:
        for name, columns in _COLUMNS.items():
            table = np.ascontiguousarray(getattr(self, name), np.float64)
            if table.size % columns:
                raise ValueError(f"{name} must have {columns} columns, not shape {table.shape}")
            table = table.reshape(-1, columns)
            if not np.all(np.isfinite(table)):
                raise ValueError(f"{name} must be finite")
            object.__setattr__(self, name, table)
        if len(self.entrance) != len(self.out):
            raise ValueError(f"{len(self.entrance)} entrances for {len(self.out)} exits")
        if self.periodic_boundary is not None and not (
            self.periodic_boundary[0] < self.periodic_boundary[1]
            and self.periodic_boundary[2] < self.periodic_boundary[3]
        ):
            raise ValueError("periodic_boundary must be (x0, x1, y0, y1) with x0 < x1 and y0 < y1")
        if self.routing is not None and self.periodic_boundary is not None:
            raise ValueError("there is no routing across a periodic boundary")

    def check(self, agents: Agents) -> None:
        """Raise an error for agents that do not fit this world.

        Raises:
            ValueError: an agent walks through portals that do not exist.
        """
        flows = agents.flow[agents.at_goal == PORTAL]
        if np.any((flows < 0) | (flows >= len(self.entrance))):
            raise ValueError(
                f"agents use flow {flows.max()}, but the world has {len(self.entrance)} pairs of "
                "portals; give agents routes, or the world entrance and out"
            )

    def with_images(self, reach: float) -> CrowdWorld:
        """Return a world whose walls and pillars are followed by their images across the border.

        Thus people do not wrap into something solid on the other side. With ``parity`` there are no
        images, as in the original engine.

        Args:
            reach: only images closer than this to the floor, m.
        """
        box = self.periodic_boundary
        if box is None or self.parity:
            return self
        discs = np.insert(self.pillars, [2, 2], 0.0, axis=1)
        discs = images(discs, box, reach + float(np.max(self.pillars[:, 2], initial=0.0)))
        middle = 0.5 * (self.walls[:, :2] + self.walls[:, 2:])
        half = self.walls[:, 2:] - middle
        longest = float(np.max(np.hypot(*half.T), initial=0.0))
        lines = images(np.insert(np.hstack([middle, half]), 4, 0.0, axis=1), box, reach + longest)
        walls = np.hstack([lines[:, :2] - lines[:, 2:4], lines[:, :2] + lines[:, 2:4]])
        return replace(
            self,
            walls=np.concatenate([self.walls, walls]),
            pillars=np.concatenate([self.pillars, discs[:, [0, 1, 4]]]),
        )
