"""Compute the free time and gap of velocities; compiled."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from crowdbot.plugin import Array, SensorInfo, kernel
from crowdbot.plugin.for_learning import LearningContext, RobotInputs
from crowdbot.plugins.observations.free_velocities import FreeVelocitiesSpec
from crowdbot.plugins.observations.goal_build import SIZE, bounds, goal_and_motion, lidar_named
from crowdbot.plugins.observations.tracked_people_build import TrackedPeople

#: Numbers of a person: 1, x, y, vx, vy.
_PERSON = 5
#: A return this near to the surface of a person is of that person, m.
_OWN = 0.12
#: Most bodies around a robot, people and returns.
_BODIES = 512
#: Columns of bodies in the robot's frame: place, velocity, radius with that of the robot; m, m/s.
_X, _Y, _VX, _VY, _RADIUS = range(5)


class FreeVelocities:
    """Tests velocities against people and lidar returns; keeps no memory but scratch."""

    def __init__(self, spec: FreeVelocitiesSpec, context: LearningContext) -> None:
        self._spec, self._limits = spec, context.limits
        lidars = [lidar_named(context, name) for name in spec.needs]
        self._lidars = dict(lidars)
        self._rays = {name: _rays(info) for name, info in lidars}
        self._velocities = _fan(spec, context.limits.v_max)
        self._bodies = np.zeros((_BODIES, 5))
        self._nearest = np.zeros(spec.people)
        self._which = np.zeros(spec.people, np.int64)
        self._radius = context.body.half_width
        self._p = np.array([spec.horizon, spec.room, spec.range, spec.fastest, spec.person_radius])
        free = 2 * len(self._velocities)
        row = ((1, 0.0, 1.0), (4, -1.0, 1.0))
        self.low, self.high = bounds(
            (free, 0.0, 1.0), (spec.sectors, 0.0, 1.0), *row * spec.people, (1, 0.0, 1.0),
            (SIZE - 1, -1.0, 1.0),
        )  # fmt: skip

    def observe(self, seen: RobotInputs) -> NDArray[np.float32]:
        """Return (W, N): free time and gap of each velocity, gaps, people, goal, motion."""
        spec = self._spec
        found = np.zeros((len(seen.pose), len(self.low)), np.float32)
        points = np.concatenate(
            [_points(seen.readings[name], *rays) for name, rays in self._rays.items()], axis=1
        )
        _write(
            points, seen.people, seen.pose, self._velocities, self._p, self._radius, spec.sectors,
            self._bodies, self._nearest, self._which, found,
        )  # fmt: skip
        found[:, -SIZE:] = goal_and_motion(seen, self._limits, spec.goal_range)
        return found

    def tracker(self) -> TrackedPeople:
        """Return a tracker that has seen no one yet."""
        return TrackedPeople(self._lidars)


def _fan(spec: FreeVelocitiesSpec, fastest: float) -> Array:
    """Return velocities (V, 2) in the robot's frame, m/s; the last one is to stand."""
    angles = np.linspace(-spec.widest, spec.widest, spec.directions)
    speeds = fastest * np.arange(1, spec.speeds + 1) / spec.speeds
    along = np.multiply.outer(speeds, np.cos(angles)).ravel()
    across = np.multiply.outer(speeds, np.sin(angles)).ravel()
    return np.concatenate([np.column_stack([along, across]), np.zeros((1, 2))])


def _rays(info: SensorInfo) -> tuple[Array, Array]:
    """Return the place (2,) and the directions (B, 2) of a lidar's beams in the robot's frame."""
    x, y, _, yaw = info.mount
    angles = info.angles
    assert angles is not None  # of a lidar
    beams = angles if angles.ndim == 1 else angles[..., 0].ravel()
    level = 1.0 if angles.ndim == 1 else np.cos(angles[..., 1].ravel())
    return np.array([x, y]), np.column_stack(
        [np.cos(beams + yaw) * level, np.sin(beams + yaw) * level]
    )


def _points(ranges: Array, place: Array, rays: Array) -> Array:
    """Return the ends (W, B, 2) of beams in the robot's frame, m; inf where nothing returned."""
    flat = ranges.reshape(len(ranges), -1)
    far = np.where(np.isfinite(flat), flat, 1e9)
    return np.asarray(place + far[..., np.newaxis] * rays)


@kernel
def _write(
    points: Array, people: Array, pose: Array, velocities: Array, p: Array, radius: float,
    sectors: int, bodies: Array, nearest: Array, which: NDArray[np.int64],
    found: NDArray[np.float32],
) -> None:  # fmt: skip
    """Write all values but goal and motion to ``found``; the rest of it is unchanged.

    Args:
        points: (W, B, 2) ends of beams in the robot's frame, m.
        people, pose: as in `RobotInputs`.
        velocities: (V, 2) in the robot's frame, m/s.
        p: horizon, room, range, fastest, radius of people.
        radius: of the robot, m.
        sectors: how many.
        bodies, nearest, which: scratch.
        found: (W, N) output.
    """
    horizon, room, most = p[0], p[1], p[2]
    gaps = 2 * velocities.shape[0]
    for w in range(pose.shape[0]):
        seen = _place_people(people[w], pose[w], most, p[4] + radius, bodies)
        count = _place_points(points[w], most, radius, seen, bodies)
        for k in range(sectors):
            found[w, gaps + k] = 1.0
        for i in range(count):
            x, y = bodies[i, _X], bodies[i, _Y]
            gap = max(0.0, math.sqrt(x * x + y * y) - bodies[i, _RADIUS]) / most
            share = (math.atan2(y, x) + math.pi) / (2.0 * math.pi)
            at = gaps + min(int(share * sectors), sectors - 1)
            found[w, at] = min(found[w, at], gap)
        for k in range(velocities.shape[0]):
            time, gap = _free(bodies, count, velocities[k, 0], velocities[k, 1], horizon, room)
            found[w, 2 * k], found[w, 2 * k + 1] = time / horizon, gap / room
        _list(bodies, seen, most, p[3], nearest, which, found[w], gaps + sectors)


@kernel
def _place_people(people: Array, pose: Array, most: float, radius: float, bodies: Array) -> int:
    """Write people within range as bodies in the robot's frame; return how many."""
    c, s, count = math.cos(pose[2]), math.sin(pose[2]), 0
    for j in range(people.shape[0]):
        dx, dy = people[j, 0] - pose[0], people[j, 1] - pose[1]
        if not dx * dx + dy * dy <= most * most or count == bodies.shape[0]:
            continue  # NaN: absent
        bodies[count, _X], bodies[count, _Y] = c * dx + s * dy, c * dy - s * dx
        vx, vy = people[j, 2], people[j, 3]
        bodies[count, _VX], bodies[count, _VY] = c * vx + s * vy, c * vy - s * vx
        bodies[count, _RADIUS] = radius
        count += 1
    return count


@kernel
def _place_points(points: Array, most: float, radius: float, seen: int, bodies: Array) -> int:
    """Write returns that are not of people as bodies that stand; return how many bodies there are.

    Args:
        seen: how many people are in ``bodies``.
    """
    count = seen
    for i in range(points.shape[0]):
        x, y = points[i, 0], points[i, 1]
        if not x * x + y * y <= most * most or count == bodies.shape[0]:
            continue
        alone = True
        for j in range(seen):
            dx, dy = x - bodies[j, _X], y - bodies[j, _Y]
            reach = bodies[j, _RADIUS] - radius + _OWN
            if dx * dx + dy * dy < reach * reach:
                alone = False
                break
        if alone:
            bodies[count, _X], bodies[count, _Y] = x, y
            bodies[count, _VX], bodies[count, _VY] = 0.0, 0.0
            bodies[count, _RADIUS] = radius
            count += 1
    return count


@kernel
def _free(
    bodies: Array, count: int, vx: float, vy: float, horizon: float, room: float
) -> tuple[float, float]:
    """Return the time to the first contact, at most the horizon, and the least gap before it, m.

    A body that is touched now is hit at once by a velocity towards it; for any other velocity its
    gap is 0.
    """
    first, least = horizon, room
    for i in range(count):
        x, y, radius = bodies[i, _X], bodies[i, _Y], bodies[i, _RADIUS]
        ux, uy = bodies[i, _VX] - vx, bodies[i, _VY] - vy
        square, along = ux * ux + uy * uy, x * ux + y * uy
        nearest = 0.0
        if along < 0.0:
            nearest = min(horizon, -along / square)
        cx, cy = x + nearest * ux, y + nearest * uy
        apart = cx * cx + cy * cy
        if apart > (radius + least) * (radius + least):
            continue  # most cases
        least = min(least, max(0.0, math.sqrt(apart) - radius))
        if along < 0.0 and apart < radius * radius:
            now = x * x + y * y - radius * radius
            if now <= 0.0:
                first = 0.0
            else:
                root = math.sqrt(max(0.0, along * along - square * now))
                first = min(first, (-along - root) / square)
    return first, least


@kernel
def _list(
    bodies: Array, seen: int, most: float, fastest: float, nearest: Array,
    which: NDArray[np.int64], found: NDArray[np.float32], at: int,
) -> None:  # fmt: skip
    """Write the nearest people, nearest first.

    Args:
        seen: how many people are in ``bodies``.
        nearest, which: (K,) scratch.
        found: (N,) output, from ``at`` on.
    """
    count, places = 0, nearest.shape[0]
    for j in range(seen):
        away = bodies[j, _X] ** 2 + bodies[j, _Y] ** 2
        if places == 0 or (count == places and away >= nearest[places - 1]):
            continue
        count = min(count + 1, places)
        k = count - 1
        while k > 0 and nearest[k - 1] > away:
            nearest[k], which[k] = nearest[k - 1], which[k - 1]
            k -= 1
        nearest[k], which[k] = away, j
    for k in range(count):
        body, first = bodies[which[k]], at + _PERSON * k
        found[first] = 1.0
        found[first + 1], found[first + 2] = body[_X] / most, body[_Y] / most
        found[first + 3] = max(-1.0, min(1.0, body[_VX] / fastest))
        found[first + 4] = max(-1.0, min(1.0, body[_VY] / fastest))


build = FreeVelocities
