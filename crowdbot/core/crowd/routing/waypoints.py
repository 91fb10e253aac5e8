"""Waypoints: each person walks straight to the goal, or to a point beside the next corner."""

from __future__ import annotations

import math

import numpy as np

from crowdbot.core.crowd.routing.corners import OUT_X, OUT_Y, ROOM
from crowdbot.core.crowd.routing.corners import X as CORNER_X
from crowdbot.core.crowd.routing.corners import Y as CORNER_Y
from crowdbot.core.crowd.routing.packed_mesh import sight_in, table_in
from crowdbot.core.crowd.routing.parameters import WayFinding
from crowdbot.core.crowd.routing.sight import Sight, is_clear
from crowdbot.core.crowd.routing.trees import TO_GOAL
from crowdbot.core.crowd.state import (
    GONE,
    PRESENT,
    People,
)
from crowdbot.core.crowd.velocity_search import counter_rng
from crowdbot.core.support.compiling.compile import inline_kernel, kernel
from crowdbot.core.types.arrays import Array, Indices

#: Share of the room at a corner over which people spread.
_SHARE_OF_ROOM = 0.8
#: A person nearer to the place aside of a corner, or to the corner, has reached it, m.
_REACHED = 0.4
#: Waypoints that are nearer are moved on, so that people do not brake at them, m.
_LEAST_AHEAD = 1.0
#: Corners closer to each other than this, plus the room at them, form one opening, m.
_SAME_OPENING, _WIDEST_OPENING = 1.0, 3.0
#: Below this share of the preferred speed a person makes no headway.
_SLOW = 0.25
#: People look around at every n-th decision, and at each decision near a corner, m.
_LOOKS_EVERY, _NEAR_CORNER = 4, 1.0
#: In place of a corner: a position to one side of an obstructing person.
_ASIDE_OF_ALL = -1.0
#: In place of a corner: the last one is passed, on the way to a goal in the margin of a solid.
_PAST_THE_LAST = -2.0
#: Its distance, m; reached within this, m; number of positions tried, with these draws.
_STEP, _STEPPED, _SIDES, _SIDE_DRAWS = 1.0, 0.4, 4, 1 << 40
#: On the way there: speed, m/s, and the time in which it is reached, s.
_SQUEEZE, _RELAXATION = 0.4, 0.5
#: Nearer to the goal than this people look for no other way, m.
_NEAR_GOAL = 1.5


@kernel
def find_waypoints(
    agents: People, decision: int, dt: float, members: Indices, ids: Indices, preferred: Array,
    goals: Array, tree_of: Indices, left: Array, after: Indices,
    wholes: Indices, reals: Array, spread: float, patience: float, detour: float, key: np.uint64,
) -> int:  # fmt: skip
    """Set the waypoints of people who are in the world or will be.

    Args:
        decision: number of the decision; below 0: all people look for paths.
        dt: since the last decision, s.
        members: (K,) rows of those whose bodies these corners fit.
        ids, preferred: (N,) numbers and preferred speeds (m/s) of all.
        goals: (K, 2) to which ``tree_of`` leads.
        tree_of: (N,) row of ``left`` and ``after`` that leads to each one's goal.
        left, after: (T, V) see `plan_tree`.
        wholes, reals: see `PackedMesh`: corners; sight at a body's margin, and nearer to walls.
        spread, patience, detour, key: see `WayFinding`.

    Returns:
        1 + the index in ``members`` of the first with a goal other than in ``goals``, and then
        nothing was set; otherwise 0.
    """
    for k in range(members.shape[0]):
        i = members[k]
        if goals[k, 0] != agents[i].goal_x or goals[k, 1] != agents[i].goal_y:
            return k + 1
    table = table_in(wholes, reals)
    sight, wider = sight_in(wholes, reals, 0), sight_in(wholes, reals, 1)
    habits = WayFinding(spread, patience, detour, key)
    for i in members:
        if agents[i].waiting == GONE:
            continue
        blocked = _no_headway(agents, i, preferred[i], patience, dt)
        turn = decision < 0 or (decision + ids[i]) % _LOOKS_EVERY == 0
        if turn or blocked or _looks(agents, i, table):
            tree = tree_of[i]
            _look(agents, i, ids[i], left[tree], after[tree], table, sight, wider, blocked, habits)
    return 0


@kernel
def _looks(agents: People, i: int, table: Array) -> bool:
    """Return True if agent i looks for a path early: it has no waypoint, or is near a corner."""
    v = int(agents[i].corner) - 1
    if v < 0:
        return bool(
            agents[i].waypoint_x != agents[i].goal_x or agents[i].waypoint_y != agents[i].goal_y
        )
    dx, dy = table[v, CORNER_X] - agents[i].x, table[v, CORNER_Y] - agents[i].y
    return bool(dx * dx + dy * dy < _NEAR_CORNER * _NEAR_CORNER)


@inline_kernel
def _look(
    agents: People, i: int, number: int, left: Array, after: Indices, table: Array,
    sight: Sight, wider: Sight, blocked: bool, habits: WayFinding,
) -> None:  # fmt: skip
    """Find agent i's waypoint: its goal, or the corner on the path to it."""
    if blocked:
        agents[i].detours += 1.0
    if _keeps_on(agents, i, blocked, wider):
        return
    v = int(agents[i].corner) - 1
    # A person on the way to a corner after which others follow does not see the goal before them.
    last = v < 0 or after[v] == TO_GOAL or not math.isfinite(left[v])
    if (last or blocked) and _sees_goal(agents, i, sight):
        _forget(agents, i)
        if blocked:
            _step_aside(agents, i, number, sight, habits)
        return
    if blocked and v >= 0:
        _choose(agents, i, left, after, table, sight, v, habits)
        _set_waypoint(agents, i, number, table, sight, habits)
        if agents[i].corner == v + 1.0:  # there is no other path
            _step_aside(agents, i, number, sight, habits)
        return
    found = _follow(agents, i, number, after, left, table, sight, wider, habits)
    w = int(agents[i].corner) - 1
    if w != v and (w < 0 or after[w] == TO_GOAL) and _sees_goal(agents, i, sight):
        _forget(agents, i)
        return
    if w < 0 and not found:
        _choose(agents, i, left, after, table, sight, -1, habits)
    if agents[i].corner == 0.0:
        _choose(agents, i, left, after, table, wider, -1, habits)
    if not found:
        _set_waypoint(agents, i, number, table, sight, habits)


@kernel
def _keeps_on(agents: People, i: int, blocked: bool, wider: Sight) -> bool:
    """Return True if agent i keeps a waypoint that is not a corner; otherwise clear it."""
    if agents[i].corner >= 0.0:
        return False
    if not blocked:
        dx, dy = agents[i].waypoint_x - agents[i].x, agents[i].waypoint_y - agents[i].y
        aside = agents[i].corner == _ASIDE_OF_ALL
        if math.hypot(dx, dy) > _STEPPED if aside else _sees_goal(agents, i, wider):
            return True
    agents[i].corner = 0.0
    return False


@kernel
def _step_aside(agents: People, i: int, number: int, sight: Sight, habits: WayFinding) -> None:
    """Let agent i, which cannot pass the person ahead, first walk a little to one side."""
    dx, dy = agents[i].waypoint_x - agents[i].x, agents[i].waypoint_y - agents[i].y
    away = math.hypot(dx, dy)
    if away == 0.0:
        return
    trip, draw = int(agents[i].trip), int(agents[i].detours)
    for k in range(_SIDES):
        counter = _SIDE_DRAWS + _SIDES * draw + k
        u = counter_rng.uniform(np.uint64(habits.key), number, trip, counter_rng.ROUTE, counter)
        turn = math.pi * (0.4 + 0.6 * u) if u < 0.5 else -math.pi * (0.4 + 0.6 * (u - 0.5))
        c, t = _STEP * math.cos(turn) / away, _STEP * math.sin(turn) / away
        x, y = agents[i].x + c * dx - t * dy, agents[i].y + t * dx + c * dy
        if is_clear(agents[i].x, agents[i].y, x, y, sight):
            agents[i].corner, agents[i].waypoint_x, agents[i].waypoint_y = _ASIDE_OF_ALL, x, y
            return


@kernel
def squeeze(agents: People, max_acceleration: Array) -> None:
    """Set the accelerations of people who step aside, as `find_waypoints` has decided.

    They move slowly and may push others, who would not give way otherwise. So do people at a goal
    in the margin of a solid, from which their policy may keep them.
    """
    for i in range(agents.shape[0]):
        if agents[i].corner >= 0.0 or agents[i].waiting != PRESENT:
            continue
        dx, dy = agents[i].waypoint_x - agents[i].x, agents[i].waypoint_y - agents[i].y
        away = max(math.hypot(dx, dy), 1e-9)
        if agents[i].corner == _PAST_THE_LAST and away > _NEAR_GOAL:
            continue
        ax = (_SQUEEZE * dx / away - agents[i].vx) / _RELAXATION
        ay = (_SQUEEZE * dy / away - agents[i].vy) / _RELAXATION
        scale = min(1.0, max_acceleration[i] / max(math.hypot(ax, ay), 1e-9))
        agents[i].ax, agents[i].ay = scale * ax, scale * ay


@kernel
def _sees_goal(agents: People, i: int, sight: Sight) -> bool:
    return is_clear(agents[i].x, agents[i].y, agents[i].goal_x, agents[i].goal_y, sight)


@kernel
def _shows_goal(agents: People, i: int, v: int, table: Array, sight: Sight) -> bool:
    """Return True if agent i's goal is in sight of corner v; False if it is in a solid's margin."""
    x, y = table[v, CORNER_X], table[v, CORNER_Y]
    return is_clear(x, y, agents[i].goal_x, agents[i].goal_y, sight)


@kernel
def _no_headway(agents: People, i: int, preferred: float, patience: float, dt: float) -> bool:
    """Return True if agent i, on its way, was slow for longer than ``patience``, s; keep count."""
    far = math.hypot(agents[i].goal_x - agents[i].x, agents[i].goal_y - agents[i].y)
    slow = math.hypot(agents[i].vx, agents[i].vy) < _SLOW * preferred
    if agents[i].waiting != PRESENT or not slow or far < _NEAR_GOAL:
        agents[i].slow_for = 0.0
        return False
    agents[i].slow_for += dt
    if agents[i].slow_for <= patience:
        return False
    agents[i].slow_for = 0.0
    return True


@kernel
def _forget(agents: People, i: int) -> None:
    """Let agent i walk straight to its goal."""
    agents[i].corner, agents[i].aside = 0.0, 1.0
    agents[i].waypoint_x, agents[i].waypoint_y = agents[i].goal_x, agents[i].goal_y


@kernel
def _beside(
    agents: People,
    i: int,
    number: int,
    v: int,
    aside: float,
    table: Array,
    habits: WayFinding,
) -> tuple[float, float]:
    """Return the position beside corner v at which agent i passes it on this trip."""
    trip, draw = int(agents[i].trip), int(agents[i].detours)
    u = counter_rng.uniform(
        np.uint64(habits.key), number, trip, counter_rng.ROUTE, (v << 16) + draw
    )
    corner = table[v]
    away = aside * u * u * min(habits.spread, _SHARE_OF_ROOM * corner[ROOM])
    return corner[CORNER_X] + away * corner[OUT_X], corner[CORNER_Y] + away * corner[OUT_Y]


@kernel
def _follow(
    agents: People, i: int, number: int, after: Indices, left: Array, table: Array,
    sight: Sight, wider: Sight, habits: WayFinding,
) -> bool:  # fmt: skip
    """Continue to the next corner if it is visible; drop one that is out of sight.

    Returns:
        True if the waypoint was set.
    """
    v = int(agents[i].corner) - 1
    if v < 0 or not math.isfinite(left[v]):
        agents[i].corner = 0.0
        return False
    x, y = agents[i].x, agents[i].y
    cx, cy = table[v, CORNER_X], table[v, CORNER_Y]
    near = math.hypot(cx - x, cy - y) < _REACHED
    w = after[v]
    if w != TO_GOAL:
        bx, by = _beside(agents, i, number, w, 1.0, table, habits)
        if is_clear(x, y, bx, by, sight):
            agents[i].corner, agents[i].aside = w + 1.0, 1.0
            _head_for(agents, i, bx, by)
            return True
        ox, oy = table[w, CORNER_X], table[w, CORNER_Y]
        if near and is_clear(x, y, ox, oy, wider):
            agents[i].corner, agents[i].aside = w + 1.0, 1.0
            return False
    elif near and not _shows_goal(agents, i, v, table, sight) and _sees_goal(agents, i, wider):
        _forget(agents, i)
        agents[i].corner = _PAST_THE_LAST
        return True
    bx, by = _beside(agents, i, number, v, agents[i].aside, table, habits)
    if not near and math.hypot(bx - x, by - y) < _REACHED:
        agents[i].aside = 0.0  # reached, and the next one is out of sight: go to the corner itself
        return False
    if is_clear(x, y, bx, by, sight):
        _head_for(agents, i, bx, by)
        return True
    if not is_clear(x, y, cx, cy, wider):
        agents[i].corner = 0.0
    return False


@kernel
def _choose(
    agents: People, i: int, left: Array, after: Indices, table: Array, sight: Sight,
    avoided: int, habits: WayFinding,
) -> None:  # fmt: skip
    """Aim agent i at the corner in sight that gives the shortest path; 0 if there is none.

    Args:
        avoided: a corner whose opening is avoided, unless all other paths are too long; -1 for
            none.
    """
    x, y = agents[i].x, agents[i].y
    best, limit = -1, math.inf
    if avoided >= 0:
        away = math.hypot(table[avoided, CORNER_X] - x, table[avoided, CORNER_Y] - y)
        limit = habits.detour * (away + left[avoided])
        best = avoided
    for v in range(table.shape[0]):
        cx, cy = table[v, CORNER_X], table[v, CORNER_Y]
        length = math.hypot(cx - x, cy - y) + left[v]
        if length >= limit or v == avoided:
            continue
        if avoided >= 0 and _leads_past(v, avoided, table, after):
            continue
        if is_clear(x, y, cx, cy, sight):
            best, limit = v, length
    agents[i].corner, agents[i].aside = best + 1.0, 1.0


@kernel
def _leads_past(v: int, avoided: int, table: Array, after: Indices) -> bool:
    """Return True if the way from corner v on leads through an opening to be avoided."""
    near = _SAME_OPENING + min(table[avoided, ROOM], _WIDEST_OPENING)
    while v != TO_GOAL:
        dx = table[v, CORNER_X] - table[avoided, CORNER_X]
        dy = table[v, CORNER_Y] - table[avoided, CORNER_Y]
        if math.hypot(dx, dy) < near:
            return True
        v = after[v]
    return False


@kernel
def _set_waypoint(
    agents: People, i: int, number: int, table: Array, sight: Sight, habits: WayFinding
) -> None:
    """Set the point that agent i walks to."""
    v = int(agents[i].corner) - 1
    if v < 0:  # nothing is visible, as inside a wall
        _forget(agents, i)
        return
    x, y = agents[i].x, agents[i].y
    ax, ay = _beside(agents, i, number, v, agents[i].aside, table, habits)
    if not is_clear(x, y, ax, ay, sight):
        ax, ay = table[v, CORNER_X], table[v, CORNER_Y]
    _head_for(agents, i, ax, ay)


@kernel
def _head_for(agents: People, i: int, x: float, y: float) -> None:
    """Set agent i's waypoint; beyond the point if that is too near."""
    dx, dy = x - agents[i].x, y - agents[i].y
    away = math.hypot(dx, dy)
    if 0.0 < away < _LEAST_AHEAD:
        x = agents[i].x + dx * _LEAST_AHEAD / away
        y = agents[i].y + dy * _LEAST_AHEAD / away
    agents[i].waypoint_x, agents[i].waypoint_y = x, y
