"""What a crowd policy sees and returns."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True)
class Agents:
    """What an agent keeps for the whole run; each (N,), SI units."""

    id: NDArray[np.int64]
    x: Array
    y: Array
    preferred_speed: Array
    radius: Array
    max_speed: Array
    max_acceleration: Array
    mass: Array

    def __len__(self) -> int:
        return len(self.id)


@dataclass(frozen=True, slots=True, kw_only=True)
class CrowdView:
    """The crowd at one decision. Read-only; world frame.

    Attributes:
        position, velocity, goal: (N, 2), m, m/s, m.
        present: (N,) False for agents that wait outside the world.
        robot: (K, 5) x, y, vx, vy and perceived radius of each robot.
        walls: (S, 4) segments.
        dt: time between decisions, s.
    """

    agents: Agents
    position: Array
    velocity: Array
    goal: Array
    present: NDArray[np.bool_]
    robot: Array
    walls: Array
    dt: float


class CrowdPolicy(Protocol):
    """Compute all, then apply all: the result does not depend on the agents' order."""

    @property
    def contact_stiffness(self) -> float:
        """Push between overlapping people and walls, 1/s^2."""
        ...

    def accelerations(self, view: CrowdView) -> Array:
        """Accelerations (N, 2) by the agents' own will, held until the next decision, m/s^2."""
        ...
