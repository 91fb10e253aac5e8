"""ORCA: half-planes of people and walls, and velocities that the drive can follow.

A robot that cannot go sideways follows a velocity by turning while it drives, and is meanwhile off
its line (Alonso-Mora, Breitenmoser, Rufli, Beardsley, Siegwart, "Optimal reciprocal collision
avoidance for multiple non-holonomic robots", DARS 2013): the radius grows by the largest error, and
velocities that would need a larger one are not chosen.
"""

from __future__ import annotations

import math

import numpy as np

from crowdbot.plugin import Array, Observation, kernel
from crowdbot.plugins.planners.orca.orca import OrcaPlannerSpec
from crowdbot.plugins.planners.shared.driver_build import VelocityPlanner, velocity_of
from crowdbot.plugins.planners.shared.half_planes_build import avoid, best_velocity
from crowdbot.plugins.planners.shared.surroundings_build import PlannerScene

#: Time in which touching discs part, and in which the robot takes on a heading, s.
_STEP, _TURN_TIME = 0.25, 0.5
#: Points of what stands nearer than this count, m, and their size, m.
_NEAR, _POINT = 3.0, 0.03
_MOST = 400


class Orca(VelocityPlanner):
    """The ORCA planner, without memory."""

    def __init__(self, spec: OrcaPlannerSpec) -> None:
        super().__init__(spec)
        self._spec = spec
        self._lines, self._scratch = np.zeros((_MOST, 4)), np.zeros((_MOST, 4))

    def forget(self) -> None:
        """Compile the kernels, if needed."""
        one = np.ones((1, 2))
        half_planes(
            one, np.ones((1, 5)), (0.0, 0.0), (0.0, 0.0), _times(self._spec), 0.3, self._lines
        )
        best_velocity(self._lines, 1, 0, 1.0, (1.0, 0.0), self._scratch)

    def velocity(self, obs: Observation, scene: PlannerScene, wish: Array) -> tuple[float, float]:
        """Return the allowed velocity nearest to the desired one, m/s."""
        sideways = self.limits.vy_max > 0.0
        error = 0.0 if sideways else self._spec.tracking_error
        people = _nearest(scene, self._spec.neighbours)
        here, own = (scene.pose.x, scene.pose.y), velocity_of(scene)
        radius = self.radius + error
        hard, count = half_planes(
            scene.points, people, here, own, _times(self._spec), radius, self._lines
        )
        top = float(np.hypot(*wish))
        u, v = best_velocity(self._lines, count, hard, top, (wish[0], wish[1]), self._scratch)
        if not sideways:
            u, v = followable(u, v, scene.pose.yaw, self._spec.tracking_error)
        obs.log("orca/change", math.hypot(u - wish[0], v - wish[1]))
        return u, v


def _times(spec: OrcaPlannerSpec) -> tuple[float, float, float]:
    return spec.time_horizon, spec.obstacle_horizon, spec.share


def _nearest(scene: PlannerScene, most: int) -> Array:
    people = scene.people
    away = np.hypot(people[:, 0] - scene.pose.x, people[:, 1] - scene.pose.y)
    return np.ascontiguousarray(people[np.argsort(away, kind="stable")[:most]])


def followable(u: float, v: float, yaw: float, error: float) -> tuple[float, float]:
    """Return a velocity in the same direction that the robot follows within an error, m/s.

    Turning by the angle θ to the new direction in the time T takes the robot off a line that is
    driven at the speed s by s T sqrt(1 - sin²θ / (2 (1 - cos θ))) (Alonso-Mora et al. 2013).

    Args:
        u, v: velocity, m/s.
        yaw: the robot's, rad.
        error: m.
    """
    speed = math.hypot(u, v)
    turn = abs(math.remainder(math.atan2(v, u) - yaw, 2.0 * math.pi))
    if speed == 0.0 or turn < 1e-3:
        return u, v
    if turn >= 0.5 * math.pi:
        most = error / _TURN_TIME
    else:
        off = 1.0 - math.sin(turn) ** 2 / (2.0 * (1.0 - math.cos(turn)))
        most = error / _TURN_TIME / math.sqrt(max(off, 1e-12))
    share = min(1.0, most / speed)
    return u * share, v * share


@kernel
def half_planes(
    points: Array,
    people: Array,
    here: tuple[float, float],
    own: tuple[float, float],
    times: tuple[float, float, float],
    radius: float,
    out: Array,
) -> tuple[int, int]:
    """Write the half-planes of walls, which must be kept, and then of people.

    Args:
        points: (P, 2) what stands, m.
        people: (N, 5) x, y, vx, vy, radius, m, m/s.
        here, own: the robot's place (m) and velocity (m/s).
        times: horizon for people and for walls, s; the robot's share of an evasion.
        radius: the robot's, m.
        out: (L, 4); no more than L are written.

    Returns:
        number of half-planes of walls; of all.
    """
    count = 0
    for i in range(points.shape[0]):
        dx, dy = points[i, 0] - here[0], points[i, 1] - here[1]
        if dx * dx + dy * dy < _NEAR * _NEAR and count < out.shape[0]:
            avoid((dx, dy), own, (0.0, 0.0), radius + _POINT, times[1], _STEP, 1.0, out[count])
            count += 1
    walls = count
    for i in range(people.shape[0]):
        if count >= out.shape[0]:
            break
        place = people[i, 0] - here[0], people[i, 1] - here[1]
        other = people[i, 2], people[i, 3]
        both = radius + people[i, 4]
        avoid(place, own, other, both, times[0], _STEP, times[2], out[count])
        count += 1
    return walls, count


build = Orca
