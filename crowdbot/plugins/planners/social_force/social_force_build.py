"""Social force: sum of accelerations, integrated over one step."""

from __future__ import annotations

import math

import numpy as np

from crowdbot.plugin import Array, Observation, kernel
from crowdbot.plugins.planners.shared.driver_build import VelocityPlanner, velocity_of
from crowdbot.plugins.planners.shared.surroundings_build import PlannerScene
from crowdbot.plugins.planners.social_force.social_force import SocialForceSpec

#: Time over which accelerations act, s; of the largest sum, m/s^2.
_STEP, _MOST = 0.125, 20.0
#: In each of these sectors only the nearest point pushes.
_SECTORS = 8


class SocialForce(VelocityPlanner):
    """The social force planner, without memory."""

    def __init__(self, spec: SocialForceSpec) -> None:
        super().__init__(spec)
        self._spec = spec
        self._walls = np.zeros((_SECTORS, 3))

    def forget(self) -> None:
        """Compile kernels that are not compiled yet."""
        self._push(np.ones((1, 5)), np.ones((1, 2)), (0.0, 0.0), (1.0, 0.0))

    def velocity(self, obs: Observation, scene: PlannerScene, wish: Array) -> tuple[float, float]:
        """Return the velocity after one step of acceleration, m/s."""
        own = velocity_of(scene)
        long = max(float(np.hypot(*wish)), 1e-9)
        ahead = (wish[0] / long, wish[1] / long)
        ax, ay = self._push(scene.people, scene.points, (scene.pose.x, scene.pose.y), ahead)
        size = math.hypot(ax, ay)
        obs.log("social_force/push", size)
        if size > _MOST:
            ax, ay = ax * _MOST / size, ay * _MOST / size
        ax += (wish[0] - own[0]) / self._spec.relaxation_time
        ay += (wish[1] - own[1]) / self._spec.relaxation_time
        u, v = own[0] + ax * _STEP, own[1] + ay * _STEP
        top = long / max(math.hypot(u, v), long)
        return u * top, v * top

    def _push(
        self, people: Array, points: Array, here: tuple[float, float], ahead: tuple[float, float]
    ) -> tuple[float, float]:
        spec = self._spec
        return push(
            people, points, here, ahead, (self.radius, spec.strength, spec.range, spec.view),
            self._walls,
        )  # fmt: skip


@kernel
def push(
    people: Array,
    points: Array,
    here: tuple[float, float],
    ahead: tuple[float, float],
    p: tuple[float, float, float, float],
    walls: Array,
) -> tuple[float, float]:
    """Return the acceleration by people and walls, m/s^2.

    Args:
        people: (N, 5) x, y, vx, vy, radius, m.
        points: (P, 2) what stands, m.
        here: the robot's place, m.
        ahead: unit vector of where it wants to go.
        p: radius of the robot (m), strength (m/s^2), range (m), weight of what is behind.
        walls: (S, 3) scratch.
    """
    radius, strength, reach, view = p
    ax = ay = 0.0
    for i in range(people.shape[0]):
        dx, dy = here[0] - people[i, 0], here[1] - people[i, 1]
        away = max(math.sqrt(dx * dx + dy * dy), 1e-6)
        facing = -(dx * ahead[0] + dy * ahead[1]) / away
        weight = view + (1.0 - view) * 0.5 * (1.0 + facing)
        size = weight * strength * math.exp((radius + people[i, 4] - away) / reach)
        ax += size * dx / away
        ay += size * dy / away
    sectors = walls.shape[0]
    for k in range(sectors):
        walls[k, 2] = math.inf
    for i in range(points.shape[0]):
        dx, dy = here[0] - points[i, 0], here[1] - points[i, 1]
        away = max(math.sqrt(dx * dx + dy * dy), 1e-6)
        k = math.floor((math.atan2(dy, dx) / (2.0 * math.pi) + 0.5) * sectors) % sectors
        if away < walls[k, 2]:
            walls[k, 0], walls[k, 1], walls[k, 2] = dx, dy, away
    for k in range(sectors):
        if walls[k, 2] < math.inf:
            size = strength * math.exp((radius - walls[k, 2]) / reach)
            ax += size * walls[k, 0] / walls[k, 2]
            ay += size * walls[k, 1] / walls[k, 2]
    return ax, ay


build = SocialForce
