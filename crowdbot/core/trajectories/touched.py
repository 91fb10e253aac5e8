"""Find steps on which a person is touched and so does not move by its own decision.

N samples, M people; world frame, SI units. Results are per step, not per sample.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from crowdbot.core.trajectories.encounters import encounter, people
from crowdbot.core.trajectories.preprocess import inf_to_nan
from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.core.types.arrays import Array, Indices, Mask

#: Surfaces closer than this may have touched between two samples, m.
SLACK = 0.02
#: Number of (step, person) pairs processed at once, to limit memory.
_CHUNK = 4096


def touched(run: Trajectories, selected: Mask, jump_speed: float) -> Mask:
    """Return steps (N-1, M) among those requested on which anything touches the person.

    People move straight within a step and are checked along all of it; walls and the robot are
    checked at its ends, and in the table of contacts.

    Args:
        run: a run with a robot.
        selected: (N-1, M) steps; the others are False in the result.
        jump_speed: speed that detects teleports if none were recorded, m/s.
    """
    gap = encounter(run, jump_speed).gap
    by_robot = (np.fmin(gap[:-1], gap[1:]) < SLACK) | _in_table(run)
    return (touched_by_others(run, selected) | by_robot) & selected


def touched_by_others(run: Trajectories, selected: Mask) -> Mask:
    """Like `touched`, by people and walls alone, not by the robot."""
    found = np.zeros(selected.shape, dtype=bool)
    step, agent = np.nonzero(selected)
    found[step, agent] = _by_people(run, step, agent)
    if run.walls is not None and len(run.walls):
        found[step, agent] |= _by_walls(run, run.walls, step, agent)
    return found


def _by_people(run: Trajectories, step: Indices, agent: Indices) -> Mask:
    """Return True for steps (K,) on which another person comes within the tolerance."""
    every = people(run)
    x, y = inf_to_nan(every.x), inf_to_nan(every.y)
    boxes = [_boxes(p, every.radius) for p in (x, y)]
    found = np.zeros(len(step), dtype=bool)
    for begin in range(0, len(step), _CHUNK):
        some = slice(begin, begin + _CHUNK)
        row, other = _near(boxes, step[some], agent[some])
        at, one = step[some][row], agent[some][row]
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
    """Return the range that each body covers on each step along one axis; (N-1, M), m.

    The tolerance is added on both sides, so that rounding excludes no pair.
    """
    least, most = np.minimum(p[:-1], p[1:]), np.maximum(p[:-1], p[1:])
    return least - (radius + SLACK), most + (radius + SLACK)


def _near(
    boxes: Sequence[tuple[Array, Array]], step: Indices, agent: Indices
) -> tuple[Indices, Indices]:
    """Return indices of steps and people whose boxes overlap, so that they may be near."""
    near = np.ones((len(step), boxes[0][0].shape[1]), dtype=bool)
    near[np.arange(len(agent)), agent] = False
    for low, high in boxes:
        near &= low[step] <= high[step, agent][:, None]
        near &= high[step] >= low[step, agent][:, None]
    found = np.nonzero(near)
    return found[0], found[1]


def _by_walls(run: Trajectories, walls: Array, step: Indices, agent: Indices) -> Mask:
    """Return True for steps (K,) with a wall within the tolerance at either end."""
    every = people(run)
    found = np.zeros(len(step), dtype=bool)
    ax, ay, bx, by = walls.T
    ex, ey = bx - ax, by - ay
    length = np.maximum(ex**2 + ey**2, 1e-12)
    for at in (step, step + 1):
        x, y = every.x[at, agent][:, None], every.y[at, agent][:, None]
        along = np.clip(((x - ax) * ex + (y - ay) * ey) / length, 0.0, 1.0)
        away = np.hypot(x - ax - along * ex, y - ay - along * ey).min(axis=1)
        found |= away < every.radius[agent] + SLACK
    return found


def _in_table(run: Trajectories) -> Mask:
    """Return steps (N-1, M) on which the contact table has a contact of robot and person."""
    every = people(run)
    found = np.zeros((len(run.t) - 1, len(every.id)), dtype=bool)
    if run.contacts is None:
        return found
    for t0, t1, agent in zip(run.contacts.t0, run.contacts.t1, run.contacts.agent, strict=True):
        column = np.flatnonzero(every.id == agent)
        found[np.ix_((run.t[1:] >= t0) & (run.t[:-1] <= t1), column)] = True
    return found
