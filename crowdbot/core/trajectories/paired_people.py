"""The same people with and without the robot: how far each is displaced, how long delayed.

People are matched by id, their trips by number. A trip with the robot is laid over the same trip
without it: what lies beside that way is displacement, what lies behind on it is delay. So a person
who walks the same way later is delayed and not displaced. SI units.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.support.compile import kernel
from crowdbot.core.trajectories.encounters import people
from crowdbot.core.trajectories.preprocess import inf_to_nan, valid_agent_steps
from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.core.trajectories.trips import trip_samples
from crowdbot.core.types.arrays import Array, Mask

#: A person is looked for this many samples before and after the place where he was found last.
WINDOW = 48
#: Places this near are one, m²: who waits is where he was.
_SAME = 1e-18


@dataclass(frozen=True, slots=True, kw_only=True)
class PairedPeople:
    """People who make the same trips in both runs; each (P,), by id.

    Attributes:
        id: of the person.
        displacement: largest distance from the way without the robot, m.
        delay: time lost on all trips together, s; negative: gained.
        speed: mean walking speed without the robot, m/s.
        unpaired: trips that both runs have, but that begin at different places.
    """

    id: NDArray[np.int64]
    displacement: Array
    delay: Array
    speed: Array
    unpaired: int


@dataclass(frozen=True, slots=True)
class _Way:
    """One trip: positions (K,), times since its beginning (K,), how long it took, whether done."""

    x: Array
    y: Array
    t: Array
    seconds: float
    reached: bool


def paired_people(
    run: Trajectories, alone: Trajectories, same_start: float, jump_speed: float
) -> PairedPeople:
    """Lay the trips of a run over those of the same people without a robot.

    Args:
        run: up to its end.
        alone: the same people without robot.
        same_start: trips that begin farther apart are not compared, m.
        jump_speed: tells teleports where none were recorded, m/s.
    """
    done: dict[tuple[int, float, float], tuple[Trajectories, PairedPeople]] = run.cached(
        "paired_people", dict
    )
    key = id(alone), same_start, jump_speed
    if key not in done:  # the run that is kept beside the result keeps its id
        done[key] = alone, _paired(run, alone, same_start, jump_speed)
    return done[key][1]


def _paired(
    run: Trajectories, alone: Trajectories, same_start: float, jump_speed: float
) -> PairedPeople:
    ways, others = _ways(run, jump_speed), _ways(alone, jump_speed)
    rows: dict[int, list[tuple[float, float, float, float]]] = {}
    unpaired = 0
    for key in sorted(ways.keys() & others.keys()):
        one, two = ways[key], others[key]
        if math.hypot(one.x[0] - two.x[0], one.y[0] - two.y[0]) > same_start:
            unpaired += 1
        else:
            rows.setdefault(key[0], []).append((*_compare(one, two), *_walked(two)))
    whole = [np.array(trips) for trips in rows.values()]
    return PairedPeople(
        id=np.array(list(rows), dtype=np.int64),
        displacement=np.array([trips[:, 0].max() for trips in whole]),
        delay=np.array([trips[:, 1].sum() for trips in whole]),
        speed=np.array([trips[:, 2].sum() / trips[:, 3].sum() for trips in whole]),
        unpaired=unpaired,
    )


def _ways(run: Trajectories, jump_speed: float) -> dict[tuple[int, int], _Way]:
    """Person and number of the trip -> where it went; trips of fewer than two samples are left out."""
    agents, trips = people(run), run.trips
    if trips is None or not agents.x.size:
        return {}
    x, y = inf_to_nan(agents.x), inf_to_nan(agents.y)
    valid = valid_agent_steps(run.t, agents, jump_speed)
    first, last, column = trip_samples(run)
    found: dict[tuple[int, int], _Way] = {}
    count: dict[int, int] = {}
    for k in np.lexsort((trips.t0, trips.agent)).tolist():
        who, c = int(trips.agent[k]), int(column[k])
        count[who] = count.get(who, 0) + 1
        rows = _continuous(valid[:, c], int(first[k]), int(last[k]))
        if c >= 0 and len(rows) >= 2:
            found[who, count[who]] = _Way(
                x=x[rows, c],
                y=y[rows, c],
                t=run.t[rows] - trips.t0[k],
                seconds=float(trips.t1[k] - trips.t0[k]),
                reached=bool(trips.reached[k]),
            )
    return found


def _continuous(valid: Mask, first: int, last: int) -> NDArray[np.intp]:
    """Samples of the longest part of a trip without a teleport or absence."""
    if last <= first:
        return np.arange(0)
    breaks = np.flatnonzero(~valid[first:last])
    edges = np.concatenate([[-1], breaks, [last - first]])
    longest = int(np.argmax(np.diff(edges)))
    return first + np.arange(edges[longest] + 1, edges[longest + 1] + 1)


def _compare(one: _Way, two: _Way) -> tuple[float, float]:
    """Displacement (m) and delay (s) of a trip against the one without the robot."""
    beside, late = follow(one.x, one.y, one.t, two.x, two.y, two.t, WINDOW)
    if one.reached and two.reached:
        return beside, one.seconds - two.seconds
    if one.reached:  # only the other one was cut
        return beside, -follow(two.x, two.y, two.t, one.x, one.y, one.t, WINDOW)[1]
    return beside, late


def _walked(way: _Way) -> tuple[float, float]:
    """Length (m) and duration (s) of what was seen of a trip."""
    length = np.hypot(np.diff(way.x), np.diff(way.y)).sum()
    return float(length), float(way.t[-1] - way.t[0])


@kernel
def follow(
    x: Array, y: Array, t: Array, wx: Array, wy: Array, wt: Array, window: int
) -> tuple[float, float]:
    """Lay one way over another, from beginning to end.

    Args:
        x, y, t: (K,) of the one, m and s.
        wx, wy, wt: (L,) of the other, L >= 2.
        window: how many samples away from the last place the next one is looked for.

    Returns:
        the largest distance from the other way, m; and how much later than there the last place is
        reached, s. The other way is prolonged by a step at both ends: samples do not fall on them.
    """
    at, late, most = 0, 0.0, 0.0
    for k in range(x.shape[0]):
        best, near = math.inf, at
        for s in range(max(0, at - window), min(wx.shape[0] - 1, at + window + 1)):
            ex, ey = wx[s + 1] - wx[s], wy[s + 1] - wy[s]
            px, py = x[k] - wx[s], y[k] - wy[s]
            square = ex * ex + ey * ey
            u = (px * ex + py * ey) / square if square > 0.0 else 0.0
            u = max(u, -1.0 if s == 0 else 0.0)
            u = min(u, 2.0 if s == wx.shape[0] - 2 else 1.0)
            apart = (px - u * ex) ** 2 + (py - u * ey) ** 2
            behind = t[k] - wt[s] - u * (wt[s + 1] - wt[s])
            if apart < best - _SAME or (apart <= best + _SAME and abs(behind) < abs(late)):
                best, near, late = min(apart, best), s, behind
        at = near
        most = max(most, best)
    return math.sqrt(most), late
