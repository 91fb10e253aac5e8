"""Ultrasound: the nearest hit in a zone of revolution about the sensor's axis.

With L the range and R the largest radius, the surface of the zone is, for t from 0 to pi,
z = (L / 2) (1 - cos t) along the axis and r = 4 R / (3 sqrt 3) (1 - cos t) sin t across it: a drop
with its tip at the sensor. A ray at the angle a to the axis leaves it where
sin t = tan(a) 3 sqrt(3) L / (8 R), t >= pi / 2.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from crowdbot.plugin import (
    Array,
    Indices,
    NoiseGenerator,
    Pose,
    RangeModel,
    Scene,
    SensorInfo,
    kernel,
)
from crowdbot.plugin.for_sensors import (
    BOTTOM,
    FAR,
    HIGH,
    LOW,
    NEAR,
    NO_RAYS,
    RADIUS,
    TOP,
    GridArrays,
    Obstacles,
    RayGrid,
    X,
    Y,
    fill_columns,
    grid_rays,
    heights_of,
    meet,
)
from crowdbot.plugins.sensors.described_build import DescribedSensor
from crowdbot.plugins.sensors.ultrasound import UltrasoundSpec

_HALVINGS = 40
_ROUNDING = 1e-12  # so that the tangent of the zone's own edge is within it


def zone_length(angle: Array, length: float, radius: float) -> Array:
    """Return the length of the zone at angles to its axis, m; 0 outside."""
    sine = np.tan(angle) * 3.0 * math.sqrt(3.0) * length / (8.0 * radius)
    t = math.pi - np.arcsin(np.minimum(sine, 1.0))
    reach: Array = 0.5 * length * (1.0 - np.cos(t)) / np.cos(angle)
    return np.where(sine <= 1.0 + _ROUNDING, reach, 0.0)


class Ultrasound(DescribedSensor):
    """Rays on a regular grid of azimuth and elevation, centred on the axis.

    The outermost rays are the zone's tangents at the sensor, and ``angles`` are their azimuths.
    """

    def __init__(self, spec: UltrasoundSpec, noise: Sequence[NoiseGenerator] = ()) -> None:
        self._spec, self._range_model = spec, RangeModel(spec, noise)
        half = spec.half_angle
        steps = math.ceil(half / spec.resolution - 1e-9)
        angles = half * np.arange(-steps, steps + 1) / steps
        self._grid = RayGrid(angles, np.tan(angles))
        to_axis = np.arccos(np.cos(angles)[:, np.newaxis] * np.cos(angles))
        self._narrow = 1.0 / math.tan(half)
        self._reach = zone_length(to_axis, spec.range_max, spec.radius)
        self._info = SensorInfo(
            category="ultrasound",
            frame="ultrasound",
            mount=self._range_model.mount,
            rate=spec.rate,
            shape=(1,),
            ros_type="sensor_msgs/msg/Range",
            angles=np.array([-half, half]),
            range_min=spec.range_min,
            range_max=spec.range_max,
            random=self._range_model.random,
            tilt=self._range_model.tilt,
        )
        self._rays = grid_rays(self._grid) if self._range_model.tilted else NO_RAYS

    def read(self, scene: Scene, pose: Pose, t: float, rng: np.random.Generator) -> Array:
        """Return the distance (1,) to the nearest object in the zone, m; inf if there is none."""
        del t
        own, grid, longest = self._range_model, self._grid, self._spec.range_max
        at, yaw = own.pose_in_world(scene, pose)
        x, y, z = at
        nearest = np.empty(1)
        if own.tilted:
            distance = own.cast_tilted(scene, pose, self._rays).reshape(self._reach.shape)
            nearest[0] = _nearest(distance, self._reach)
        elif own.drops_slanted:  # a slanted surface may hide objects behind it
            distance, incidence, _ = scene.cast_grid(grid, at, yaw, longest)
            own.drop_slanted(distance, incidence)
            nearest[0] = _nearest(distance, self._reach)
        else:
            nearest[0] = _nearest_at_all(
                x, y, z, yaw, self._reach, longest, self._narrow, *grid.arrays,
                *scene.obstacles_near(x, y, longest),
            )  # fmt: skip
        return own.measure(nearest, rng)


@kernel
def _nearest(distance: Array, reach: Array) -> float:
    """Return the least distance within its ray's reach; inf if none."""
    best = math.inf
    for r in range(distance.shape[0]):
        for c in range(distance.shape[1]):
            if distance[r, c] <= reach[r, c] and distance[r, c] < best:
                best = distance[r, c]
    return best


@kernel
def _nearest_by_rays(
    z: float, slope: Array, reach: Array, length: float, work: Array, filled: Indices
) -> float:
    """Like `_nearest`, for rays from height ``z`` and the columns of `fill_columns`."""
    best = math.inf
    for c in range(reach.shape[1]):
        if filled[c] == 0 or work[c, 0, NEAR] >= best:
            continue
        for r in range(reach.shape[0]):
            stretch, hit = math.sqrt(1.0 + slope[r] * slope[r]), math.inf
            for k in range(filled[c]):
                here = work[c, k]
                if here[NEAR] >= min(hit, best):
                    break
                t = meet(slope[r], z, here[NEAR], here[FAR], here[LOW], here[HIGH])
                hit = min(hit, t)
            away = hit * stretch
            if away <= length and away <= reach[r, c]:
                best = min(best, away)
    return best


@kernel
def _depth(x: float, y: float, length: float, narrow: float) -> float:
    """Return the depth of a point in the zone's level section, which is convex: 1 on its edge.

    Args:
        x, y: m, from the sensor, x along the axis; not outside of the cone at its tip.
        narrow: 1 / tan of half the angle of the cone at the tip.
    """
    sine = min(1.0, narrow * abs(y) / x) if x > 0.0 else 0.0
    return x / (0.5 * length * (1.0 + math.sqrt(1.0 - sine * sine)))


@kernel
def _to_wall(
    ax: float, ay: float, bx: float, by: float, length: float, narrow: float, most: float
) -> float:
    """Return the distance to the part of a segment inside the level section, m, up to ``most``."""
    ex, ey = bx - ax, by - ay
    low, high = 0.0, 1.0
    for side in (-1.0, 1.0):  # cut to the cone, |y| narrow <= x
        at_a, slope = ax + side * narrow * ay, ex + side * narrow * ey
        if slope == 0.0:
            if at_a < 0.0:
                return math.inf
        elif slope > 0.0:
            low = max(low, -at_a / slope)
        else:
            high = min(high, -at_a / slope)
    if low > high:
        return math.inf
    square = ex * ex + ey * ey
    foot = -(ax * ex + ay * ey) / square if square > 0.0 else 0.0
    foot = min(high, max(low, foot))
    if math.hypot(ax + foot * ex, ay + foot * ey) >= most:
        return math.inf
    if _depth(ax + foot * ex, ay + foot * ey, length, narrow) > 1.0:
        inside, left, right = foot, low, high
        for _ in range(_HALVINGS):  # to the deepest point inside: depth is convex
            first, second = left + (right - left) / 3.0, right - (right - left) / 3.0
            if _depth(ax + first * ex, ay + first * ey, length, narrow) < _depth(
                ax + second * ex, ay + second * ey, length, narrow
            ):
                right = second
            else:
                left = first
            inside = 0.5 * (left + right)
        if _depth(ax + inside * ex, ay + inside * ey, length, narrow) > 1.0:
            return math.inf
        for _ in range(_HALVINGS):  # back to the edge
            middle = 0.5 * (foot + inside)
            if _depth(ax + middle * ex, ay + middle * ey, length, narrow) > 1.0:
                foot = middle
            else:
                inside = middle
        foot = inside
    return math.hypot(ax + foot * ex, ay + foot * ey)


@kernel
def _nearest_at_all(
    x: float, y: float, z: float, yaw: float, reach: Array, length: float, narrow: float,
    azimuth: Array, cos: Array, sin: Array, slope: Array, slope_scale: Array, work: Array,
    filled: Indices, directions: Array, runs: Indices,
    walls: Array, wall_heights: Array, discs: Array, owner: Indices,
) -> float:  # fmt: skip
    """Return the nearest hit of any ray, or the exact nearer distance at the sensor's height, m.

    Walls count wherever the zone cuts them, cylinders where they face the sensor; objects in
    between are in the zone themselves, and nearer.

    Args:
        x, y, z, yaw: origin and direction in the world frame, m and rad.
        reach: (R, C) extent of the zone along each ray, m.
        length, narrow: the zone's size, see `_depth`.
        azimuth to runs: fields of `GridArrays`.
        walls to owner: fields of `Obstacles`.
    """
    grid = GridArrays(azimuth, cos, sin, slope, slope_scale, work, filled, directions, runs)
    lowest, highest = heights_of(z, grid, length)
    obstacles = Obstacles(walls, wall_heights, discs, owner)
    fill_columns(x, y, yaw, lowest, highest, length, grid, obstacles)
    nearest = _nearest_by_rays(z, slope, reach, length, work, filled)
    c, s = math.cos(yaw), math.sin(yaw)
    for i in range(walls.shape[0]):
        if wall_heights[i, 0] <= z <= wall_heights[i, 1]:
            ax, ay, bx, by = walls[i, 0] - x, walls[i, 1] - y, walls[i, 2] - x, walls[i, 3] - y
            found = _to_wall(
                c * ax + s * ay, c * ay - s * ax, c * bx + s * by, c * by - s * bx,
                length, narrow, min(nearest, length),
            )  # fmt: skip
            nearest = min(nearest, found)
    for i in range(discs.shape[0]):
        px, py, r = discs[i, X] - x, discs[i, Y] - y, discs[i, RADIUS]
        most = min(nearest, length)
        if not (abs(px) - r < most and abs(py) - r < most):
            continue
        away = math.hypot(px, py)
        forward, left = c * px + s * py, c * py - s * px
        level = discs[i, BOTTOM] <= z <= discs[i, TOP]
        if level and r < away < most + r and narrow * abs(left) <= forward:
            share = 1.0 - r / away
            if _depth(share * forward, share * left, length, narrow) <= 1.0:
                nearest = away - r
    return nearest


build = Ultrasound.from_spec
