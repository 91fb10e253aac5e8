"""VFH+: choose a direction from a histogram of obstacles around the robot.

Ulrich, Borenstein, "VFH+: reliable obstacle avoidance for fast mobile robots", ICRA 1998. Lidar
points replace the cells of a certainty grid, each certain; people count as the near side of their
discs. Sectors that the robot could reach only by an arc that touches something are masked, by the
obstacles beside its turning circles.
"""

from __future__ import annotations

import math

import numpy as np

from crowdbot.plugin import Array, Mask, Observation, kernel
from crowdbot.plugins.planners.shared.driver_build import VelocityPlanner
from crowdbot.plugins.planners.shared.surroundings_build import PlannerScene
from crowdbot.plugins.planners.vfh_plus.vfh_plus import VfhPlusSpec

#: Turning circles of a robot that turns on the spot at low speed have this radius at full speed, m.
_TURNING = 0.25


class VfhPlus(VelocityPlanner):
    """The VFH+ planner; remembers the open sectors and its last direction."""

    def __init__(self, spec: VfhPlusSpec) -> None:
        super().__init__(spec)
        self._spec = spec
        self._density = np.zeros(spec.sectors)
        self._open = np.ones(spec.sectors, np.bool_)
        self._last: float | None = None

    def forget(self) -> None:
        """Reset all sectors; compile kernels."""
        self._open[:] = True
        self._last = None
        histogram(np.ones((1, 3)), (0.0, 0.0), 0.3, 2.5, self._density)
        masked(np.ones((1, 3)), (0.0, 0.0, 0.0), 0.3, 0.25, self._open)
        self._open[:] = True

    def velocity(self, obs: Observation, scene: PlannerScene, wish: Array) -> tuple[float, float]:
        """Return the velocity in the cheapest open direction, m/s; zero if all are closed."""
        spec, pose = self._spec, scene.pose
        discs = scene.discs
        wide = self.radius + spec.safety
        histogram(discs, (pose.x, pose.y), wide, spec.window, self._density)
        self._open = np.where(self._open, self._density < spec.high, self._density < spec.low)
        free = self._open.copy()
        if self.limits.vy_max == 0.0:
            turning = _TURNING * abs(scene.twist[0]) / max(self.limits.v_max, 1e-9)
            masked(discs, (pose.x, pose.y, pose.yaw), wide, turning, free)
        goal = math.atan2(wish[1], wish[0])
        chosen = self._direction(free, goal, pose.yaw)
        if chosen is None:
            self._last = None
            return 0.0, 0.0
        self._last = chosen
        k = _sector(chosen, spec.sectors)
        speed = float(np.hypot(*wish)) * max(0.0, 1.0 - float(self._density[k]))
        obs.log("vfh_plus/aside", math.remainder(chosen - goal, 2.0 * math.pi))
        return speed * math.cos(chosen), speed * math.sin(chosen)

    def _direction(self, free: Mask, goal: float, yaw: float) -> float | None:
        """Return the cheapest direction, rad, or None."""
        spec = self._spec
        last = yaw if self._last is None else self._last
        best, chosen = math.inf, None
        for angle in openings(free, goal, spec.wide):
            cost = (
                spec.goal_weight * _between(angle, goal)
                + spec.heading_weight * _between(angle, yaw)
                + spec.change_weight * _between(angle, last)
            )
            if cost < best:
                best, chosen = cost, angle
        return chosen


def _between(a: float, b: float) -> float:
    return abs(math.remainder(a - b, 2.0 * math.pi))


def _sector(angle: float, sectors: int) -> int:
    return math.floor(angle / (2.0 * math.pi) * sectors) % sectors


def openings(free: Mask, goal: float, wide: int) -> list[float]:
    """Return the candidate directions: the middle or the edges of each opening, rad.

    Args:
        free: (S,) open sectors; the first begins at angle 0.
        goal: direction of the goal, rad.
        wide: an opening of more sectors is passed beside its edges, or straight to the goal.
    """
    count, size = len(free), 2.0 * math.pi / len(free)
    if free.all():
        return [goal]
    found: list[float] = []
    closed = int(np.flatnonzero(~free)[0])
    order = np.roll(free, -closed)  # begins with a closed sector
    edges = np.flatnonzero(np.diff(np.concatenate([order, [False]]).astype(np.int8)))
    for first, last in zip(edges[::2] + 1, edges[1::2], strict=True):
        right, left = (closed + int(first)) * size, (closed + int(last) + 1) * size
        if last - first + 1 <= wide:
            found.append(0.5 * (left + right))
            continue
        beside = 0.5 * wide * size
        found += [right + beside, left - beside]
        if free[_sector(goal, count)] and _within(goal, right, left):
            found.append(goal)
    return found


def _within(angle: float, right: float, left: float) -> bool:
    return (angle - right) % (2.0 * math.pi) <= left - right


@kernel
def histogram(
    discs: Array, here: tuple[float, float], wide: float, window: float, out: Array
) -> None:
    """Write the density of obstacles in each direction: 1 at contact, 0 at the window's edge.

    Args:
        discs: (N, 3) x, y, radius, m.
        here: the robot's place, m.
        wide: radius that must stay clear around it, m.
        window: m.
        out: (S,).
    """
    sectors = out.shape[0]
    out[:] = 0.0
    for i in range(discs.shape[0]):
        dx, dy = discs[i, 0] - here[0], discs[i, 1] - here[1]
        away, clear = math.sqrt(dx * dx + dy * dy), wide + discs[i, 2]
        gap = max(0.0, away - clear)
        if gap >= window:
            continue
        density = (1.0 - gap / window) ** 2
        half = 0.5 * math.pi if away <= clear else math.asin(clear / away)
        middle = math.atan2(dy, dx)
        low = math.floor((middle - half) / (2.0 * math.pi) * sectors)
        high = math.floor((middle + half) / (2.0 * math.pi) * sectors)
        for k in range(low, high + 1):
            out[k % sectors] = max(out[k % sectors], density)


@kernel
def masked(
    discs: Array, pose: tuple[float, float, float], wide: float, turning: float, free: Mask
) -> None:
    """Close the sectors that the robot cannot turn to without touching something.

    Args:
        discs: (N, 3) x, y, radius, m.
        pose: the robot's, m, rad.
        wide: radius that must stay clear around it, m.
        turning: radius of its turning circles, m.
        free: (S,) changed.
    """
    right, left = -math.pi, math.pi  # limits relative to the heading
    co, si = math.cos(pose[2]), math.sin(pose[2])
    for i in range(discs.shape[0]):
        dx, dy = discs[i, 0] - pose[0], discs[i, 1] - pose[1]
        x, y = co * dx + si * dy, co * dy - si * dx
        clear, angle = wide + discs[i, 2], math.atan2(y, x)
        if x * x + y * y <= clear * clear:
            continue  # nothing is gained by a turn where it touches already
        if 0.0 > angle > right and x * x + (y + turning) ** 2 < (turning + clear) ** 2:
            right = angle
        if 0.0 < angle < left and x * x + (y - turning) ** 2 < (turning + clear) ** 2:
            left = angle
    sectors = free.shape[0]
    for k in range(sectors):
        off = (k + 0.5) / sectors * 2.0 * math.pi - pose[2]
        off -= 2.0 * math.pi * round(off / (2.0 * math.pi))
        if off < right or off > left:
            free[k] = False


build = VfhPlus
