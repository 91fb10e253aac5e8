"""Clip: one robot or vehicle among people, at 16 Hz."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d

from crowdbot.core.geometry.footprint import Footprint
from crowdbot.core.realism.tracks import NothingToCompareError
from crowdbot.core.trajectories.footprint_of_run import footprint_of
from crowdbot.core.trajectories.resample import interpolated
from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.core.types.arrays import Array

#: Samples per second, and standard deviation of the smoothing of positions, s.
RATE, SMOOTHING = 16.0, 0.3
#: Longest gap between samples of a person that is interpolated, s.
_GAP = 0.6


@dataclass(frozen=True, slots=True, kw_only=True)
class Clip:
    """One robot among people; SI units.

    Attributes:
        name: name of the recording.
        site: recording site or group, which cross-validation keeps together.
        t: (T,) equidistant times.
        pose: (T, 3) x, y and heading of the robot, smoothed.
        people: (T, N, 2) positions, smoothed; NaN where not seen.
        footprint: outline of the robot in its own frame.
    """

    name: str
    site: str
    t: Array
    pose: Array
    people: Array
    footprint: Footprint

    @property
    def dt(self) -> float:
        """Return the time between samples, s."""
        return float(self.t[1] - self.t[0])

    def gap(self, rows: NDArray[np.int64], x: Array, y: Array) -> Array:
        """Return the distance of points from the robot's surface at the samples ``rows``, m."""
        return gap_at(self.pose[rows], self.footprint, x, y)


def gap_at(pose: Array, footprint: Footprint, x: Array, y: Array) -> Array:
    """Return the distance of points from a robot's surface, m; negative inside.

    Args:
        pose: (..., 3) x, y, heading; broadcast against ``x`` and ``y``.
    """
    dx, dy = x - pose[..., 0], y - pose[..., 1]
    if not len(footprint.corners):
        return np.asarray(np.hypot(dx, dy) - footprint.radius)
    c, s = np.cos(pose[..., 2]), np.sin(pose[..., 2])
    return footprint.gap(c * dx + s * dy, c * dy - s * dx)


def clip_of(run: Trajectories, name: str, site: str | None = None) -> Clip:
    """Convert a run with a robot and people to a clip.

    Raises:
        NothingToCompareError: robot or people are missing, or the run is shorter than 3 s.
    """
    if run.robot is None or run.agents is None or not run.agents.x.size:
        missing = "robot" if run.robot is None else "people"
        raise NothingToCompareError(f"{name}: there is no {missing} in it")
    if run.t[-1] - run.t[0] < 3.0:
        raise NothingToCompareError(
            f"{name}: {run.t[-1] - run.t[0]:.1f} s are too short, 3 s are needed"
        )
    footprint = footprint_of(run) or Footprint(np.zeros((0, 2)), run.robot.radius)
    robot, agents = run.robot, run.agents
    t = np.arange(run.t[0], run.t[-1], 1.0 / RATE)
    pose = [interpolated(run.t, v, t) for v in (robot.x, robot.y, np.unwrap(robot.theta))]
    people = np.full((len(t), len(agents.id), 2), np.nan)
    for k in range(len(agents.id)):
        for axis, values in enumerate((agents.x[:, k], agents.y[:, k])):
            known = np.isfinite(values)
            if np.count_nonzero(known) > 1:
                people[:, k, axis] = interpolated(run.t[known], values[known], t, _GAP)
    return clip_from_arrays(name, site or name, t, np.column_stack(pose), people, footprint)


def clip_from_arrays(
    name: str, site: str, t: Array, pose: Array, people: Array, footprint: Footprint
) -> Clip:
    """Build a clip from equidistant samples, which are smoothed here; shapes as in `Clip`."""
    dt = float(t[1] - t[0])
    return Clip(
        name=name,
        site=site,
        t=np.asarray(t, np.float64),
        pose=smoothed(np.column_stack([pose[:, :2], np.unwrap(pose[:, 2])]), dt),
        people=np.stack([smoothed(people[:, k], dt) for k in range(people.shape[1])], axis=1),
        footprint=footprint,
    )


def smoothed(values: Array, dt: float) -> Array:
    """Return values (T, C) smoothed over time; stretches between NaN are smoothed separately."""
    out = np.full(values.shape, np.nan)
    known = np.isfinite(values).all(axis=1)
    edges = np.flatnonzero(np.diff(np.concatenate([[0], known.astype(np.int8), [0]])))
    for begin, end in edges.reshape(-1, 2):
        out[begin:end] = _smoothed(values[begin:end], SMOOTHING / dt)
    return out


def _smoothed(values: Array, sigma: float) -> Array:
    """Smooth values that go on beyond both ends as point reflections: steady motion stays."""
    pad = min(len(values) - 1, round(4.0 * sigma))
    before = 2.0 * values[0] - values[pad:0:-1]
    after = 2.0 * values[-1] - values[-2 : -2 - pad : -1]
    longer = np.concatenate([before, values, after])
    smooth = gaussian_filter1d(longer, sigma, axis=0, mode="nearest")
    return np.asarray(smooth[pad : pad + len(values)])
