"""The steering parts, in the order in which they change what a policy wants."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from crowdbot.core.crowd.policy import CrowdView
from crowdbot.core.crowd.steering.lanes import keep_lane
from crowdbot.core.crowd.steering.parameters import Steering
from crowdbot.core.crowd.steering.personal_space import push_away
from crowdbot.core.crowd.steering.sorted_discs import SortedDiscs, sorted_discs
from crowdbot.core.crowd.steering.time_gap import limit_speed
from crowdbot.core.crowd.steering.wall_push import push_off_walls
from crowdbot.core.crowd.steering.wander import wander
from crowdbot.core.types.arrays import Array

#: Changes accelerations in place: view, neighbours, the policy's relaxation time (s), (N, 2).
Part = Callable[[CrowdView, SortedDiscs, float, Array], None]


def parts_of(steering: Steering) -> list[Part]:
    """The parts that change accelerations, one after the other: first limits, then pushes."""
    found: list[Part] = []
    gap, space = steering.time_gap, steering.personal_space
    lanes, walls, drift = steering.lanes, steering.wall_push, steering.wander
    if gap is not None:
        found.append(lambda view, near, time, out: limit_speed(gap, view, near, time, out))
    if space is not None:
        found.append(lambda _view, near, _time, out: push_away(space, near, out))
    if lanes is not None:
        found.append(lambda _view, near, _time, out: keep_lane(lanes, near, out))
    if walls is not None:
        found.append(lambda view, near, _time, out: push_off_walls(walls, view, near, out))
    if drift is not None:
        found.append(lambda view, near, _time, out: wander(drift, view, near, out))
    return found


def steer(parts: list[Part], view: CrowdView, relaxation: float, wanted: Array) -> Array:
    """Accelerations (N, 2) after all parts, within each agent's limit, m/s^2.

    Args:
        relaxation: time in which the policy reaches the velocity that it has chosen, s; 0 is the
            time between decisions.
        wanted: (N, 2) what the policy wants, m/s^2; left as it is.
    """
    near, changed = sorted_discs(view), np.array(wanted)
    for part in parts:
        part(view, near, max(relaxation, view.dt), changed)
    size = np.hypot(changed[:, 0], changed[:, 1])
    limit = view.agents.max_acceleration
    changed *= np.minimum(1.0, limit / np.maximum(size, limit))[:, np.newaxis]
    return changed
