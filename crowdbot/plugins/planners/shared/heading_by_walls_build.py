"""Estimate the robot's heading from walls in lidar scans.

When a person bumps into a robot, it turns with slipping wheels, which wheel odometry misses. The
histogram of directions of straight runs of lidar points turns with the robot; the shift that best
fits earlier histograms is the turn (Weiss, Wetzler, von Puttkamer, "Keeping track of position and
orientation of moving indoor systems by correlation of range-finder scans", IROS 1994). Without
walls in view, the heading is that of odometry.
"""

from __future__ import annotations

import math

import numpy as np

from crowdbot.plugin import Array, Indices, Pose, kernel

#: Bins of a histogram of directions of lines, over half a turn.
BINS = 360
#: Number of points of a straight run, its largest bend and its smallest length, m.
_RUN, _BEND, _SHORT, _LONG = 6, 0.01, 0.12, 1.2
#: Number of neighbouring bins on either side in which a line counts, with falling weight.
_BLUR = 4
#: Number of straight runs needed for an estimate, and largest unnoticed turn, rad.
_FEW, _WINDOW = 12.0, 0.75
#: A larger turn in one step, rad, needs this many: a table or a pillar fits a memory of others in
#: any direction. Walls of a corridor give 200 and more, also where a person has turned the robot.
_JUMP, _MANY = 0.35, 60.0
#: Differences up to this are left to odometry, rad, so that an untouched robot drives straight.
_NOISE = 0.02
#: Weight of one step's histogram in the memory.
_LEARN = 0.02


@kernel
def directions(points: Array, out: Array) -> float:
    """Write a histogram of the directions of straight runs; return their number.

    Args:
        points: (P, 2) base frame, m, those of one lidar in the order of its beams.
        out: (BINS,) output; bin k holds lines at an angle of k / BINS * pi.
    """
    out[:] = 0.0
    count = 0.0
    for i in range(points.shape[0] - _RUN + 1):
        x, y = points[i, 0], points[i, 1]
        dx, dy = points[i + _RUN - 1, 0] - x, points[i + _RUN - 1, 1] - y
        long = math.sqrt(dx * dx + dy * dy)
        if long < _SHORT or long > _LONG:
            continue
        bent = 0.0
        for k in range(i + 1, i + _RUN - 1):
            bent = max(bent, abs(dx * (points[k, 1] - y) - dy * (points[k, 0] - x)))
        if bent / long > _BEND:
            continue
        at = math.atan2(dy, dx) / math.pi * BINS
        below = math.floor(at)
        share = at - below
        out[int(below) % BINS] += 1.0 - share
        out[int(below + 1) % BINS] += share
        count += 1.0
    return count


@kernel
def turned(memory: Array, seen: Array, guess: float, filled: Indices) -> float:
    """Return the rotation that best fits the histogram to the remembered one, near a guess; rad.

    Args:
        memory, seen: (BINS,) histograms.
        guess: rad; returned if nothing fits.
        filled: (BINS,) scratch.
    """
    middle, wide = round(guess / math.pi * BINS), int(_WINDOW / math.pi * BINS)
    best, shift = 0.0, float("nan")
    before, after, last = 0.0, 0.0, 0.0
    count = 0  # few bins have lines: skip the others once, not for each turn
    for k in range(BINS):
        if seen[k] > 0.0:
            filled[count] = k
            count += 1
    for s in range(middle - wide, middle + wide + 1):
        turn = s % BINS
        fit = 0.0
        for n in range(count):
            k = filled[n]
            at = k + turn
            fit += seen[k] * memory[at - BINS if at >= BINS else at]
        if fit > best:
            best, shift, before, after = fit, float(s), last, -1.0
        elif after < 0.0:
            after = fit
        last = fit
    if best <= 0.0:
        return guess
    bend = before - 2.0 * best + after
    if after >= 0.0 and bend < 0.0:
        shift += 0.5 * (before - after) / bend
    return shift * math.pi / BINS


@kernel
def learn(memory: Array, seen: Array, yaw: float, share: float) -> None:
    """Mix the histogram, rotated by the yaw (rad) and blurred, into the old one, in place."""
    shift = round(yaw / math.pi * BINS)
    for k in range(BINS):
        memory[k] *= 1.0 - share
    for k in range(BINS):
        if seen[k] > 0.0:
            for b in range(-_BLUR, _BLUR + 1):
                weight = 1.0 - abs(b) / (_BLUR + 1.0)
                memory[(k + shift + b) % BINS] += share * weight * seen[k]


@kernel
def heading(
    points: Array, guess: float, knows: bool, memory: Array, seen: Array, filled: Indices
) -> float:
    """Return the yaw that fits the walls to the remembered ones, rad, and remember them.

    NaN without walls, or with too few for so large a rotation.

    Args:
        points: as for `directions`.
        guess: rad.
        knows: True if the memory is not empty.
        memory: (BINS,) changed in place.
        seen, filled: (BINS,) scratch.
    """
    count = directions(points, seen)
    if count < _FEW:
        return math.nan
    fitting = turned(memory, seen, guess, filled) if knows else guess
    if abs(fitting - guess) > _JUMP and count < _MANY:
        return math.nan
    learn(memory, seen, fitting, _LEARN if knows else 1.0)
    return fitting


class HeadingByWalls:
    """Follows odometry, but takes the heading from the walls."""

    def __init__(self) -> None:
        self._memory, self._seen = np.zeros(BINS), np.zeros(BINS)
        self._filled = np.zeros(BINS, np.int64)
        self._knows = False
        self._odometry: Pose | None = None
        self._pose = Pose(0.0, 0.0, 0.0)

    def pose(self, odometry: Pose, points: Array) -> Pose:
        """Return the robot's pose, estimated from wheels and walls.

        Args:
            odometry: pose by odometry; the result is in its frame.
            points: (P, 2) current lidar points, base frame, m.
        """
        moved = odometry if self._odometry is None else self._after(self._odometry, odometry)
        yaw = moved.yaw
        fitting = heading(points, yaw, self._knows, self._memory, self._seen, self._filled)
        if not math.isnan(fitting):
            self._knows = True
            yaw = fitting if abs(fitting - yaw) > _NOISE else yaw
        self._odometry, self._pose = odometry, Pose(moved.x, moved.y, yaw)
        return self._pose

    def _after(self, before: Pose, now: Pose) -> Pose:
        """Return the last pose moved by the change in odometry, as seen from the robot."""
        off = self._pose.yaw - before.yaw
        c, s = math.cos(off), math.sin(off)
        dx, dy = now.x - before.x, now.y - before.y
        return Pose(
            self._pose.x + c * dx - s * dy, self._pose.y + s * dx + c * dy,
            self._pose.yaw + math.remainder(now.yaw - before.yaw, 2.0 * math.pi),
        )  # fmt: skip


def compile_heading() -> None:
    """Compile the kernels, with a made-up wall seen twice."""
    wall = np.column_stack([np.linspace(0.0, 2.0, 40), np.ones(40)])
    heading = HeadingByWalls()
    for _ in range(2):
        heading.pose(Pose(0.0, 0.0, 0.0), wall)
