"""Rollouts of people_mpc's plans among predicted people; compiled."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from crowdbot.plugin import Array, array_kernel, inline_kernel, kernel
from crowdbot.plugins.planners.people_mpc.giving_way_build import give_way
from crowdbot.plugins.planners.people_mpc.plan_world_build import (
    STEP,
    PlanWorld,
    at_first,
    extent_of,
    gaps,
)
from crowdbot.plugins.planners.shared.follow_velocity_build import slewed
from crowdbot.plugins.planners.shared.points_build import wrapped

#: Directions of the second stretch beside the goal's, rad, and its speeds as shares.
ASIDE = (0.0, 0.35, -0.35, 0.8, -0.8, 1.4, -1.4)
PACES = (1.0, 0.5)
#: A plan's heading follows its direction with this gain, 1/s; slower while it turns more.
_GAIN = 2.0
#: Share of the cost of a hit that remains if the robot stands and a person walks into it.
_STANDING = 0.15
#: What is already too near may be passed but not approached, m.
_SLACK = 1e-3
#: Columns of a first velocity, and of people.
V, W, VY = range(3)
#: Indices into the parameter vector.
A_MAX, ALPHA_MAX, V_MAX, W_MAX, HORIZON, TURN_TIME, MARGIN, COMFORT, GROWTH = range(9)
PROGRESS, CLEARANCE, IMPACT, SMOOTHNESS, SIDEWAYS, ASIDE_COST, HEADING, SWERVE = range(9, 17)
HURRY, HEADWAY, HURRY_WITHIN, HURRY_ROOM = range(17, 21)
PARAMETERS = 21


class PlanOutcome(NamedTuple):
    """The end of a rollout.

    Attributes:
        mean: mean distance to the goal, m; after a hit it no longer falls.
        hit: time of the first hit, s; the horizon if there is none.
        speed: speed at the hit, m/s.
        close: 0 (farther than comfort) to 1 (touching).
        aside: angle between heading, or motion sideways, and the goal after the first stretch, rad.
        hurried: share of the horizon in which the robot would reach a person who stood still within
            the headway, in the part that is watched; sooner counts more; 0 if that costs nothing.
    """

    mean: float
    hit: float
    speed: float
    close: float
    aside: float
    hurried: float


@kernel
def _second(
    p: Array, first: tuple[float, float, float], off: float, aside: float, top: float
) -> tuple[float, float, float]:
    """Return the velocity v, w, vy that the robot wants in the second stretch.

    Args:
        p: parameters.
        first: v, w, vy of the first stretch.
        off: direction of the goal from the heading, rad.
        aside: angle of the motion from the goal's direction, rad.
        top: speed, m/s.
    """
    if p[SIDEWAYS] > 0.0:
        w = _GAIN * wrapped(off)
        v, vy = top * math.cos(off + aside), top * math.sin(off + aside)
    else:
        off = wrapped(off + aside)
        w = _GAIN * off
        v, vy = top * max(0.0, math.cos(off)) if abs(off) < 1.3 else 0.0, first[2]
    return v, max(-p[W_MAX], min(p[W_MAX], w)), vy


@kernel
def _stepped(
    p: Array, state: tuple[float, float, float, float], target: tuple[float, float, float]
) -> tuple[float, float, float, float, float, float]:
    """Return the way in x and y (m), then yaw, v, w, vy, after a step within acceleration limits.

    Args:
        p: parameters.
        state: yaw, v, w, vy before.
        target: v, w, vy.
    """
    yaw, v, w, vy = state
    dv, dvy = target[0] - v, target[2] - vy
    most, change = p[A_MAX] * STEP, math.sqrt(dv * dv + dvy * dvy)
    if change > most:
        dv, dvy = dv * most / change, dvy * most / change
    w_next = slewed(w, target[1], p[ALPHA_MAX] * STEP)
    middle = yaw + (w + w_next) / 4.0 * STEP
    c, s = math.cos(middle), math.sin(middle)
    ahead, left = (v + 0.5 * dv) * STEP, (vy + 0.5 * dvy) * STEP
    yaw += (w + w_next) / 2.0 * STEP
    return ahead * c - left * s, ahead * s + left * c, yaw, v + dv, w_next, vy + dvy


@inline_kernel
def _target(
    p: Array,
    first: tuple[float, float, float],
    off: float,
    aside: float,
    pace: float,
    away: float,
    t: float,
) -> tuple[float, float, float]:
    """Return the velocity v, w, vy that a plan wants at time t, slow enough to stop at the goal.

    Args:
        p, first, aside, pace: as in `roll`.
        off: direction of the goal from the heading, rad.
        away: distance to the goal, m.
        t: since the plan began, s.
    """
    brake = math.sqrt(2.0 * p[A_MAX] * away)
    if t > p[TURN_TIME] + 0.5 * STEP:
        top = min(pace * p[V_MAX], brake)
        return _second(p, first, off, aside * max(0.0, 1.0 - t / p[HORIZON]), top)
    return min(first[0], brake), first[1], first[2]


@inline_kernel
def _hurries(
    world: PlanWorld,
    p: Array,
    gap: float,
    pose: tuple[float, float, float],
    going: tuple[float, float],
    t: float,
    since: float,
) -> bool:
    """Return True if the robot would reach a person who stood still within the headway.

    Args:
        world, p: as in `roll`.
        gap: to the nearest person, m.
        pose: x, y, yaw of the robot.
        going: its velocity, m/s.
        t: since the plan began, s.
        since: time for which people walk on, s.
    """
    near = gap < p[HEADWAY] * p[V_MAX] + p[HURRY_ROOM]
    if not (p[HURRY] > 0.0 and t < p[HURRY_WITHIN] and near):
        return False
    x, y = pose[0] + p[HEADWAY] * going[0], pose[1] + p[HEADWAY] * going[1]
    return bool(gaps(world, x, y, pose[2], since)[0] < p[HURRY_ROOM])


@inline_kernel
def _least_cost(p: Array, start: float, away: float, total: float, close: float, t: float) -> float:
    """Return the least cost of progress and clearance with which a plan can end.

    Args:
        p: parameters.
        start, away: distances to the goal when the plan began, and now, m.
        total: integral of the distance to the goal until now, m s.
        close: closeness until now.
        t: since the plan began, s.
    """
    scale, left = 2.0 / (p[V_MAX] * p[HORIZON]), p[HORIZON] - t
    least = total + max(0.0, left * (away - 0.5 * p[V_MAX] * left))
    made = (start - least / p[HORIZON]) * scale
    return float(p[PROGRESS] * (1.0 - made) + p[CLEARANCE] * close)


@inline_kernel
def _give_way_at(
    world: PlanWorld, now: PlanWorld, t: float, robot: tuple[float, float, float, float, float]
) -> None:
    """Move people by a step of the prediction, those who yield out of the robot's way.

    Args:
        world: people when the plan began, and their prediction.
        now: people at time t, changed in place.
        t: since the plan began, s.
        robot: x, y, velocity and extent of the robot.
    """
    n = min(round(t / STEP), world.predicted.shape[0]) - 1
    give_way(now.people, world.people, world.yields, world.predicted, n, robot, STEP)


@kernel
def roll(
    world: PlanWorld,
    p: Array,
    state: tuple[float, float, float, float, float, float],
    first: tuple[float, float, float],
    aside: float,
    pace: float,
    budget: float,
) -> PlanOutcome:
    """Roll a plan out: a first velocity, then a direction beside the goal's.

    It stops early once its cost exceeds the budget, with an infinite mean.

    Args:
        p: parameters.
        state: x, y, yaw, v, w, vy of the robot.
        first: v, w, vy of the first stretch.
        aside: angle of the second direction from that of the goal, rad; it shrinks as the plan
            goes on, so that plans end towards the goal.
        pace: speed of the second stretch as a share of the largest.
        budget: cost of progress and clearance beyond which the plan is of no interest.
    """
    x, y, yaw, v, w, vy = state
    responds = world.yields.shape[0] > 0
    now, extent = world, 0.0
    if responds:
        now, extent = at_first(world), extent_of(world.robot)
    person, wall = gaps(world, x, y, yaw, 0.0)
    need = min(p[MARGIN], min(person, wall) - _SLACK)
    close, t, total, beside, hurried = 0.0, 0.0, 0.0, 0.0, 0.0
    start = math.sqrt((world.goal[0] - x) ** 2 + (world.goal[1] - y) ** 2)
    while t < p[HORIZON] - 0.5 * STEP:
        t += STEP
        gx, gy = world.goal[0] - x, world.goal[1] - y
        away = math.sqrt(gx * gx + gy * gy)
        off = math.atan2(gy, gx) - yaw
        if t <= p[TURN_TIME] + 0.5 * STEP:
            beside = abs(wrapped(off))
        target = _target(p, first, off, aside, pace, away, t)
        dx, dy, yaw, v, w, vy = _stepped(p, (yaw, v, w, vy), target)
        x += dx
        y += dy
        going = dx / STEP, dy / STEP
        if responds:
            _give_way_at(world, now, t, (x, y, going[0], going[1], extent))
        since = 0.0 if responds else t
        person, wall = gaps(now, x, y, yaw, since)
        if _hurries(now, p, person, (x, y, yaw), going, t, since):
            hurried += STEP / p[HORIZON] * (1.0 - 0.6 * t / p[HORIZON])
        gap = min(person, wall)
        gx, gy = world.goal[0] - x, world.goal[1] - y
        away = math.sqrt(gx * gx + gy * gy)
        if gap < need:
            mean = (total + away * (p[HORIZON] - t + STEP)) / p[HORIZON]
            return PlanOutcome(mean, t, math.sqrt(v * v + vy * vy), 1.0, beside, hurried)
        total += away * STEP
        need = min(p[MARGIN], max(need, gap))
        doubted = min(person - p[GROWTH] * t, wall + 0.5 * p[COMFORT])
        close = max(close, (1.0 - doubted / p[COMFORT]) * (1.0 - 0.6 * t / p[HORIZON]))
        if _least_cost(p, start, away, total, close, t) > budget:
            return PlanOutcome(math.inf, t, 0.0, close, beside, hurried)
    speed = math.sqrt(v * v + vy * vy)
    return PlanOutcome(total / p[HORIZON], p[HORIZON], speed, min(1.0, close), beside, hurried)


@kernel
def best_plan(
    world: PlanWorld,
    p: Array,
    state: tuple[float, float, float, float, float, float],
    firsts: Array,
    last: tuple[float, float, float],
    last_aside: float,
) -> tuple[int, int, int, float]:
    """Return the best plan from whose beginning the robot can stop before the first hit.

    Args:
        firsts: (C, 3) first velocities v, w, vy.
        last: last command, v, w, vy.
        last_aside: second direction of the last plan, rad.

    Returns:
        indices of the first velocity (-1: no plan is admissible), of `ASIDE` and of `PACES`; cost.
    """
    best, at, at_aside, at_pace = math.inf, -1, 0, 0
    gx, gy = world.goal[0] - state[0], world.goal[1] - state[1]
    away = math.sqrt(gx * gx + gy * gy)
    going = math.sqrt(state[3] ** 2 + state[5] ** 2)
    outlined = world.robot.shape[0] > 1
    turned = abs(wrapped(math.atan2(gy, gx) - state[2]))
    for k in range(firsts.shape[0] - 1, -1, -1):  # fast ones first, which are seldom worse
        first = firsts[k, V], firsts[k, W], firsts[k, VY]
        speed = math.sqrt(first[0] ** 2 + first[2] ** 2)
        change = abs(first[0] - last[0]) + abs(first[2] - last[2])
        base = p[SMOOTHNESS] * (change / p[V_MAX] + abs(first[1] - last[1]) / p[W_MAX])
        if base >= best:
            continue
        stop = max(going, speed) / p[A_MAX] + STEP
        if outlined and speed == 0.0 and first[1] != 0.0:
            stop = abs(first[1]) / p[ALPHA_MAX] + STEP
        moves = speed > 0.0 or (outlined and first[1] != 0.0)
        for a in range(len(ASIDE)):
            turn = base + p[ASIDE_COST] * abs(ASIDE[a] - last_aside)
            if turn >= best:
                continue
            for n in range(len(PACES)):
                end = roll(world, p, state, first, ASIDE[a], PACES[n], best - turn)
                if end.mean == math.inf:
                    continue
                if moves and end.hit < stop:
                    continue
                if end.aside > p[SWERVE] and (speed > 0.0 or end.aside > turned):
                    continue  # those who turn round flee with the people who come towards them
                made = (away - end.mean) / (0.5 * p[V_MAX] * p[HORIZON])  # earlier is better
                blow = (1.0 - end.hit / p[HORIZON]) * (_STANDING + end.speed / p[V_MAX])
                cost = turn + p[PROGRESS] * (1.0 - made) + p[CLEARANCE] * end.close
                cost += p[IMPACT] * blow + p[HEADING] * end.aside / math.pi
                cost += p[HURRY] * end.hurried
                if cost < best:
                    best, at, at_aside, at_pace = cost, k, a, n
    return at, at_aside, at_pace, best


@array_kernel
def path_of(
    p: Array,
    state: tuple[float, float, float, float, float, float],
    goal: tuple[float, float],
    first: tuple[float, float, float],
    aside: float,
    pace: float,
) -> Array:
    """Return the poses (S, 3) of a plan at each step, ignoring hits: x, y (m), yaw (rad).

    Args:
        goal: m; the others as for `roll`.
    """
    out = np.empty((int(p[HORIZON] / STEP), 3))
    x, y, yaw, v, w, vy = state
    for n in range(out.shape[0]):
        t = (n + 1) * STEP
        vt, wt, vyt = first
        if t > p[TURN_TIME] + 0.5 * STEP:
            off = math.atan2(goal[1] - y, goal[0] - x) - yaw
            turn = wrapped(off + aside * max(0.0, 1.0 - t / p[HORIZON]))
            vt = pace * p[V_MAX] * max(0.0, math.cos(turn))
            wt, vyt = _GAIN * turn, 0.0
            if p[SIDEWAYS] > 0.0:
                wt = _GAIN * wrapped(off)
                vt, vyt = pace * p[V_MAX] * math.cos(turn), pace * p[V_MAX] * math.sin(turn)
        v, vy = slewed(v, vt, p[A_MAX] * STEP), slewed(vy, vyt, p[A_MAX] * STEP)
        w = slewed(w, max(-p[W_MAX], min(p[W_MAX], wt)), p[ALPHA_MAX] * STEP)
        yaw += w * STEP
        x += (v * math.cos(yaw) - vy * math.sin(yaw)) * STEP
        y += (v * math.sin(yaw) + vy * math.cos(yaw)) * STEP
        out[n, 0], out[n, 1], out[n, 2] = x, y, yaw
    return out
