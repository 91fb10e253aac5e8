"""Rollouts of the oracle: candidates x time x people who keep their velocity; compiled."""

from __future__ import annotations

import math

from crowdbot.plugin import Array, kernel
from crowdbot.plugins.planners.shared.robot_outline_build import core_gap

#: Time step of a rollout, s.
STEP = 0.125
#: Indices into the kernels' parameter vector.
A_MAX, ALPHA_MAX, V_MAX, W_MAX, HORIZON, TURN_TIME, RADIUS, MARGIN, COMFORT = range(9)
PROGRESS, CLEARANCE, IMPACT, SMOOTHNESS, HEADING = range(9, 14)
PARAMETERS = 14

#: After the arc a rollout turns to the goal with this gain, 1/s.
_GAIN = 2.0
#: Share of the impact cost that remains if the robot stands and a person walks into it.
_STANDING = 0.15
#: A person who is already too near may be passed but not approached, m.
_SLACK = 1e-3


@kernel
def _slewed(value: float, target: float, change: float) -> float:
    return min(max(target, value - change), value + change)


@kernel
def gap_at(
    people: Array, walls: Array, core: Array, x: float, y: float, yaw: float, t: float
) -> float:
    """Return the distance from the robot's core to the nearest surface in ``t`` seconds, m.

    Everyone keeps their velocity. For the core see `robot_outline_build.core_of`; for a disc it is
    the centre.
    """
    best, c, s = math.inf, math.cos(yaw), math.sin(yaw)
    if core.shape[0]:
        for i in range(people.shape[0]):
            dx = people[i, 0] + t * people[i, 2] - x
            dy = people[i, 1] + t * people[i, 3] - y
            best = min(best, core_gap(core, c * dx + s * dy, c * dy - s * dx) - people[i, 4])
        for i in range(walls.shape[0]):
            dx, dy = walls[i, 0] - x, walls[i, 1] - y
            best = min(best, core_gap(core, c * dx + s * dy, c * dy - s * dx))
        return best
    for i in range(people.shape[0]):
        dx = people[i, 0] + t * people[i, 2] - x
        dy = people[i, 1] + t * people[i, 3] - y
        best = min(best, math.sqrt(dx * dx + dy * dy) - people[i, 4])
    for i in range(walls.shape[0]):
        dx, dy = walls[i, 0] - x, walls[i, 1] - y
        best = min(best, math.sqrt(dx * dx + dy * dy))
    return best


@kernel
def roll(
    people: Array,
    walls: Array,
    p: Array,
    core: Array,
    state: tuple[float, float, float, float, float],
    goal: tuple[float, float],
    vt: float,
    wt: float,
) -> tuple[float, float, float, float, float]:
    """Roll out one candidate: slew to (vt, wt), keep it for the turning time, go to the goal.

    Args:
        people: (N, 5) x, y, vx, vy, radius; world frame.
        walls: (P, 2) points, world frame, m.
        core: core of the robot's outline, see `robot_outline_build.core_of`.
        state: the robot's x, y, yaw, v, w.

    Returns:
        mean distance to the goal (m), constant after a hit; time of the hit (s, the horizon if
        there is none); speed then (m/s); closeness, 0 (farther than comfort) to 1 (touching); angle
        between heading and goal after the arc (rad).
    """
    x, y, yaw, v, w = state
    need = min(p[MARGIN], gap_at(people, walls, core, x, y, yaw, 0.0) - p[RADIUS] - _SLACK)
    close, t, target, total, aside = 0.0, 0.0, wt, 0.0, 0.0
    while t < p[HORIZON] - 0.5 * STEP:
        t += STEP
        off = math.atan2(goal[1] - y, goal[0] - x) - yaw
        off -= 2.0 * math.pi * round(off / (2.0 * math.pi))
        if t <= p[TURN_TIME] + STEP:
            aside = abs(off)
        else:
            target = max(-p[W_MAX], min(p[W_MAX], _GAIN * off)) if vt > 0.0 else 0.0
        away = math.hypot(goal[0] - x, goal[1] - y)
        v_next = _slewed(v, min(vt, math.sqrt(2.0 * p[A_MAX] * away)), p[A_MAX] * STEP)
        w_next = _slewed(w, target, p[ALPHA_MAX] * STEP)
        middle = yaw + (w + w_next) / 4.0 * STEP
        x += (v + v_next) / 2.0 * STEP * math.cos(middle)
        y += (v + v_next) / 2.0 * STEP * math.sin(middle)
        yaw += (w + w_next) / 2.0 * STEP
        v, w = v_next, w_next
        gap = gap_at(people, walls, core, x, y, yaw, t) - p[RADIUS]
        away = math.hypot(goal[0] - x, goal[1] - y)
        if gap < need:
            return (total + away * (p[HORIZON] - t + STEP)) / p[HORIZON], t, v, 1.0, aside
        total += away * STEP
        need = min(p[MARGIN], max(need, gap))
        close = max(close, (1.0 - gap / p[COMFORT]) * (1.0 - 0.5 * t / p[HORIZON]))
    return total / p[HORIZON], p[HORIZON], v, close, aside


@kernel
def best(
    people: Array,
    walls: Array,
    p: Array,
    core: Array,
    state: tuple[float, float, float, float, float],
    goal: tuple[float, float],
    candidates: Array,
    last: tuple[float, float],
) -> tuple[int, float]:
    """Return the best candidate after which the robot can still stop before the first hit.

    Args:
        core: core of the robot's outline, see `robot_outline_build.core_of`.
        candidates: (C, 2) target v and w; standing still is always admissible, and turning on the
            spot if the robot is round.
        last: last command.

    Returns:
        its index, -1 if none is admissible; its cost.
    """
    least, index = math.inf, -1
    away = math.hypot(goal[0] - state[0], goal[1] - state[1])
    for k in range(candidates.shape[0]):
        vt, wt = candidates[k, 0], candidates[k, 1]
        mean, hit, speed, close, aside = roll(people, walls, p, core, state, goal, vt, wt)
        if vt != 0.0 and hit < max(abs(state[3]), vt) / p[A_MAX] + STEP:
            continue
        if core.shape[0] and wt != 0.0 and hit < abs(wt) / p[ALPHA_MAX] + STEP:
            continue
        made = (away - mean) / (0.5 * p[V_MAX] * p[HORIZON])  # earlier is better
        blow = (1.0 - hit / p[HORIZON]) * (_STANDING + speed / p[V_MAX])
        change = abs(vt - last[0]) / p[V_MAX] + abs(wt - last[1]) / p[W_MAX]
        cost = (
            p[PROGRESS] * (1.0 - made)
            + p[CLEARANCE] * close
            + p[IMPACT] * blow
            + p[HEADING] * aside / math.pi
            + p[SMOOTHNESS] * change
        )
        if cost < least:
            least, index = cost, k
    return index, least
