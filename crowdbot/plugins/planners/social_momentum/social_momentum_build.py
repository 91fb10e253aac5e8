"""Social Momentum: of collision-free velocities, the one that shows the passing side best.

Mavrogiannis, Thomason, Knepper, "Social Momentum: a framework for legible navigation in dynamic
multi-agent environments", HRI 2018. The sign of the angular momentum of robot and person about the
point between them tells on which side they pass. A velocity is rated by its progress, plus the
momenta with all people ahead if it changes no sign.
"""

from __future__ import annotations

import math

import numpy as np

from crowdbot.plugin import Array, Observation, kernel
from crowdbot.plugins.planners.shared.driver_build import VelocityPlanner, velocity_of
from crowdbot.plugins.planners.shared.surroundings_build import PlannerScene
from crowdbot.plugins.planners.social_momentum.social_momentum import SocialMomentumSpec

#: Fractions of the wanted speed to choose from. No one counts as nearer than this, m.
_SPEEDS, _LEAST = (1.0, 0.5), 1e-6


class SocialMomentum(VelocityPlanner):
    """The Social Momentum planner, without memory."""

    def __init__(self, spec: SocialMomentumSpec) -> None:
        super().__init__(spec)
        self._spec = spec
        ahead = np.linspace(-0.5 * math.pi, 0.5 * math.pi, spec.directions)
        # Straight on first: of equal velocities the first is chosen.
        self._turns = ahead[np.argsort(np.abs(ahead), kind="stable")]

    def forget(self) -> None:
        """Compile kernels that are not compiled yet."""
        choose(np.ones((1, 2)), np.ones((1, 5)), np.ones((1, 2)), (0.0, 0.0, 0.3), (1.0, 0.0),
               (1.0, 0.0), self._weights)  # fmt: skip

    def velocity(self, obs: Observation, scene: PlannerScene, wish: Array) -> tuple[float, float]:
        """Return the best velocity that touches nothing within the horizon, m/s; else zero."""
        choices = self._choices(wish)
        place = scene.pose.x, scene.pose.y, self.radius + self._spec.safety
        top = max(float(np.hypot(*wish)), 1e-9)
        ahead = float(wish[0]) / top, float(wish[1]) / top
        best, momentum = choose(
            choices, scene.people, scene.points, place, velocity_of(scene), ahead, self._weights
        )
        obs.log("social_momentum/momentum", momentum)
        if best < 0:
            return 0.0, 0.0
        return float(choices[best, 0]), float(choices[best, 1])

    def _choices(self, wish: Array) -> Array:
        """Return velocities (A, 2) around the wish, m/s."""
        angles = math.atan2(wish[1], wish[0]) + self._turns
        unit = np.column_stack([np.cos(angles), np.sin(angles)])
        top = float(np.hypot(*wish))
        return np.concatenate([top * share * unit for share in _SPEEDS])

    @property
    def _weights(self) -> tuple[float, float, float]:
        return self._spec.momentum, self._spec.horizon, self._spec.reach


@kernel
def choose(
    choices: Array,
    people: Array,
    points: Array,
    place: tuple[float, float, float],
    own: tuple[float, float],
    ahead: tuple[float, float],
    weights: tuple[float, float, float],
) -> tuple[int, float]:
    """Return the index of the best velocity, or -1, and its momentum, m^2/s.

    Args:
        choices: (A, 2) velocities, m/s.
        people: (N, 5) x, y, vx, vy, radius, m, m/s.
        points: (P, 2) what stands, m.
        place: the robot's place and radius, m.
        own: its velocity, m/s.
        ahead: unit vector of where it wants to go.
        weights: of the momentum (1/m), horizon (s), reach (m).
    """
    weight, horizon, reach = weights
    best, most, momentum = -1, -math.inf, 0.0
    for k in range(choices.shape[0]):
        u, v = choices[k, 0], choices[k, 1]
        if not is_free(u, v, people, points, place, horizon):
            continue
        settled = momentum_of(u, v, people, place, own, ahead, reach)
        worth = u * ahead[0] + v * ahead[1] + weight * settled
        if worth > most + 1e-9:
            best, most, momentum = k, worth, settled
    return best, momentum


@kernel
def momentum_of(
    u: float,
    v: float,
    people: Array,
    place: tuple[float, float, float],
    own: tuple[float, float],
    ahead: tuple[float, float],
    reach: float,
) -> float:
    """Return the mean momentum with people ahead, by nearness, m^2/s; 0 if a side changes.

    With equal masses, the momentum about the middle is half the cross product of distance and
    relative velocity; it stays as it is while both go on.
    """
    total = weights = 0.0
    for i in range(people.shape[0]):
        dx, dy = place[0] - people[i, 0], place[1] - people[i, 1]
        away = max(math.sqrt(dx * dx + dy * dy), _LEAST)
        if away > reach or dx * ahead[0] + dy * ahead[1] > 0.0:
            continue
        ou, ov = people[i, 2], people[i, 3]
        now = 0.5 * (dx * (own[1] - ov) - dy * (own[0] - ou))
        then = 0.5 * (dx * (v - ov) - dy * (u - ou))
        if now * then < 0.0:
            return 0.0
        total += abs(then) / away
        weights += 1.0 / away
    return total / weights if weights > 0.0 else 0.0


@kernel
def is_free(
    u: float,
    v: float,
    people: Array,
    points: Array,
    place: tuple[float, float, float],
    horizon: float,
) -> bool:
    """Return True if a velocity touches nothing within the horizon; people keep theirs."""
    x, y, radius = place
    for i in range(people.shape[0]):
        dx, dy = people[i, 0] - x, people[i, 1] - y
        if touches(dx, dy, u - people[i, 2], v - people[i, 3], radius + people[i, 4], horizon):
            return False
    for i in range(points.shape[0]):
        if touches(points[i, 0] - x, points[i, 1] - y, u, v, radius, horizon):
            return False
    return True


@kernel
def touches(dx: float, dy: float, u: float, v: float, radius: float, horizon: float) -> bool:
    """Return True if a disc with velocity (u, v) touches a point within the horizon.

    If it touches already, only a velocity towards the point counts.
    """
    closing = dx * u + dy * v
    if closing <= 0.0:
        return False
    speed = u * u + v * v
    time = min(closing / speed, horizon)
    gx, gy = dx - u * time, dy - v * time
    return gx * gx + gy * gy < radius * radius


build = SocialMomentum
