"""The steering parts, in the order in which they change accelerations."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

import numpy as np

from crowdbot.core.crowd.policy import CrowdView
from crowdbot.core.crowd.steering.lanes import keep_lane
from crowdbot.core.crowd.steering.moment import Moment
from crowdbot.core.crowd.steering.parameters import Steering
from crowdbot.core.crowd.steering.personal_space import push_away
from crowdbot.core.crowd.steering.sorted_discs import sorted_discs
from crowdbot.core.crowd.steering.time_gap import limit_speed
from crowdbot.core.crowd.steering.wall_push import push_off_walls
from crowdbot.core.crowd.steering.wander import wander
from crowdbot.core.types.arrays import Array

#: Field of `SteeringSpec` -> what changes accelerations (N, 2) in place, given the field's spec.
#: They do so in this order: first limits, then pushes.
PARTS: Mapping[str, Callable[[Any, Moment, Array], None]] = {
    "time_gap": limit_speed,
    "personal_space": push_away,
    "lanes": keep_lane,
    "wall_push": push_off_walls,
    "wander": wander,
}

#: A part with its spec.
Part = Callable[[Moment, Array], None]


def parts_of(steering: Steering) -> list[Part]:
    """Return the functions of a crowd's steering parts, in order of application."""
    specs = {name: getattr(steering.spec, name) for name in PARTS}
    return [partial(PARTS[n], spec) for n, spec in specs.items() if spec is not None]


def steer(
    parts: list[Part], view: CrowdView, relaxation: float, wanted: Array, key: int = 0
) -> Array:
    """Return accelerations (N, 2) after all parts, within each agent's limit, m/s^2.

    Args:
        relaxation: time in which the policy reaches the velocity that it has chosen, s; 0 is the
            time between decisions.
        wanted: (N, 2) what the policy wants, m/s^2; left as it is.
        key: as of `Steering`.
    """
    now, changed = Moment(view, sorted_discs(view), max(relaxation, view.dt), key), np.array(wanted)
    for part in parts:
        part(now, changed)
    size = np.hypot(changed[:, 0], changed[:, 1])
    limit = view.agents.max_acceleration
    changed *= np.minimum(1.0, limit / np.maximum(size, limit))[:, np.newaxis]
    return changed
