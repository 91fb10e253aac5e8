"""Who is touched by something, so that he does not move by his own legs alone.

N samples, M people; world frame, SI units. Steps, not samples, are asked about.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from crowdbot.core.trajectories.encounters import encounter, people
from crowdbot.core.trajectories.preprocess import inf_to_nan
from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.core.types.arrays import Array, Indices, Mask

#: Surfaces this near may have touched between two samples, m.
SLACK = 0.02
#: Pairs of a step and a person that are looked at together: bounds the memory.
_CHUNK = 4096


def touched(run: Trajectories, asked: Mask, jump_speed: float) -> Mask:
    """On which of the steps asked about (N-1, M) a person touches somebody, a wall or the robot.

    People move along straight lines within a step, and are looked at all along it; walls and the
    robot at both ends of it, and in the table of contacts.

    Args:
        run: has a robot.
        asked: (N-1, M) steps; the others are False in the answer.
        jump_speed: tells teleports where none were recorded, m/s.
    """
    found = np.zeros(asked.shape, dtype=bool)
    step, who = np.nonzero(asked)
    found[step, who] = _by_people(run, step, who)
    gap = encounter(run, jump_speed).gap
    found |= (np.fmin(gap[:-1], gap[1:]) < SLACK) | _in_table(run)
    if run.walls is not None and len(run.walls):
        found[step, who] |= _by_walls(run, run.walls, step, who)
    return found & asked


def _by_people(run: Trajectories, step: Indices, who: Indices) -> Mask:
    """Whether anybody else comes within the slack on the step; (K,)."""
    every = people(run)
    x, y = inf_to_nan(every.x), inf_to_nan(every.y)
    boxes = [_boxes(p, every.radius) for p in (x, y)]
    found = np.zeros(len(step), dtype=bool)
    for begin in range(0, len(step), _CHUNK):
        some = slice(begin, begin + _CHUNK)
        row, other = _near(boxes, step[some], who[some])
        at, one = step[some][row], who[some][row]
        px, py = (p[at, other] - p[at, one] for p in (x, y))
        dx, dy = (q[at + 1, other] - q[at + 1, one] - p for q, p in ((x, px), (y, py)))
        square = dx**2 + dy**2
        nearest = np.divide(-(px * dx + py * dy), square, out=np.zeros(px.shape), where=square > 0)
        nearest = np.clip(nearest, 0.0, 1.0)
        gap = np.hypot(px + nearest * dx, py + nearest * dy)
        gap -= every.radius[one] + every.radius[other]
        found[begin + row[gap < SLACK]] = True
    return found


def _boxes(p: Array, radius: Array) -> tuple[Array, Array]:
    """Ends of what each body covers on each step, along one axis; (N-1, M), m.

    With the slack at both, so twice: rounding must leave nobody out.
    """
    least, most = np.minimum(p[:-1], p[1:]), np.maximum(p[:-1], p[1:])
    return least - (radius + SLACK), most + (radius + SLACK)


def _near(
    boxes: Sequence[tuple[Array, Array]], step: Indices, who: Indices
) -> tuple[Indices, Indices]:
    """Who may come near on the steps, because the boxes overlap: indices of steps and people."""
    near = np.ones((len(step), boxes[0][0].shape[1]), dtype=bool)
    near[np.arange(len(who)), who] = False
    for low, high in boxes:
        near &= low[step] <= high[step, who][:, None]
        near &= high[step] >= low[step, who][:, None]
    found = np.nonzero(near)
    return found[0], found[1]


def _by_walls(run: Trajectories, walls: Array, step: Indices, who: Indices) -> Mask:
    """Whether a wall is within the slack at either end of the step; (K,)."""
    every = people(run)
    found = np.zeros(len(step), dtype=bool)
    ax, ay, bx, by = walls.T
    ex, ey = bx - ax, by - ay
    length = np.maximum(ex**2 + ey**2, 1e-12)
    for at in (step, step + 1):
        x, y = every.x[at, who][:, None], every.y[at, who][:, None]
        along = np.clip(((x - ax) * ex + (y - ay) * ey) / length, 0.0, 1.0)
        away = np.hypot(x - ax - along * ex, y - ay - along * ey).min(axis=1)
        found |= away < every.radius[who] + SLACK
    return found


def _in_table(run: Trajectories) -> Mask:
    """Steps (N-1, M) on which the table of contacts has one of the robot with a person."""
    every = people(run)
    found = np.zeros((len(run.t) - 1, len(every.id)), dtype=bool)
    if run.contacts is None:
        return found
    for t0, t1, agent in zip(run.contacts.t0, run.contacts.t1, run.contacts.agent, strict=True):
        column = np.flatnonzero(every.id == agent)
        found[np.ix_((run.t[1:] >= t0) & (run.t[:-1] <= t1), column)] = True
    return found
