"""Interface of crowd policies: input and output."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.crowd.agents import Agents
from crowdbot.core.crowd.periodic_boundary import Box, images
from crowdbot.core.types.arrays import Array

#: Default push between overlapping people, walls and pillars, 1/s^2.
CONTACT_STIFFNESS = 62.5


@dataclass(frozen=True, slots=True, kw_only=True)
class CrowdView:
    """The crowd at one decision. Read-only; world frame, SI units.

    Attributes:
        agents: constant data of the agents.
        position, velocity, goal: (N, 2), m, m/s, m.
        present: (N,) False for agents that are outside the world.
        robot: (K, 5) x, y, vx, vy and perceived radius of each robot that these agents see; empty
            by default, since the response to robots is added to the policy's result.
        walls: (S, 4) segments, m.
        dt: time between decisions, s.
        t: time of the decision, s.
        decides: (N,) agents whose result is used: those present with this policy and view; None:
            all present. Results for others are ignored.
        pillars: (P, 3) x, y and radius of round obstacles, m.
        periodic_boundary: (x0, x1, y0, y1) of a floor with periodic boundaries, m.
        diagonal: True if people also see across the corners of the floor; in the original engine
            they see along one axis at a time.
    """

    agents: Agents
    position: Array
    velocity: Array
    goal: Array
    present: NDArray[np.bool_]
    robot: Array
    walls: Array
    dt: float
    t: float = 0.0
    decides: NDArray[np.bool_] | None = None
    pillars: Array = field(default_factory=lambda: np.zeros((0, 3)))
    periodic_boundary: Box | None = None
    diagonal: bool = True

    def others(self, reach: float = math.inf) -> Array:
        """Return discs (K, 5) besides the people: x, y, vx, vy, radius; m, m/s.

        Robots, then pillars, then images of people across the border, with the radius that others
        avoid.

        Args:
            reach: distance beyond which no centre is seen, m.
        """
        if not len(self.pillars) and self.periodic_boundary is None:
            return self.robot
        found = [self.robot, _standing(self.pillars)]
        if self.periodic_boundary is not None:
            radius = self.agents.avoided_radius
            people = np.column_stack([self.position, self.velocity, radius])[self.present]
            found.append(images(people, self.periodic_boundary, reach, diagonal=self.diagonal))
        return np.concatenate(found)


def _standing(pillars: Array) -> Array:
    discs = np.zeros((len(pillars), 5))
    discs[:, :2], discs[:, 4] = pillars[:, :2], pillars[:, 2]
    return discs


class AcceleratingPolicy(Protocol):
    """A policy that returns accelerations; the result must not depend on the agents' order.

    A policy of either kind may have an attribute ``contact_stiffness``: the push between
    overlapping people, walls and pillars, 1/s^2; without it, `CONTACT_STIFFNESS`. A policy that
    approaches chosen velocities gives the time for it in an attribute ``relaxation_time`` (s), for
    the steering parts that limit speeds; default: the time between decisions. A policy that chooses
    among fixed velocities may list them in an attribute ``velocity_candidates``
    (`crowdbot.core.types.candidates`), which makes recordings smaller and changes nothing else.
    A policy whose whole decision is to `approach` what a `Sampler` chose may name that sampler in
    an attribute ``compiled_search``: then many worlds decide in one compiled call.
    With a true attribute ``walks_through_walls`` walls do not hold its people back, as in records
    whose plan does not fit. With a true attribute ``commanded`` nothing else changes what its
    people want: neither robots, nor steering parts, nor groups.
    """

    def accelerations(self, view: CrowdView) -> Array:
        """Return the agents' desired accelerations (N, 2), held until the next decision, m/s^2."""
        ...


class VelocityPolicy(Protocol):
    """A policy that returns velocities; the result must not depend on the agents' order."""

    def velocities(self, view: CrowdView, dt: float) -> Array:
        """Return velocities (N, 2) to be reached within ``dt`` (s) at the latest decision, m/s.

        Agents reach them within their largest acceleration and speed.
        """
        ...


CrowdPolicy = AcceleratingPolicy | VelocityPolicy
