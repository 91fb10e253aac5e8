"""Actions of learned policies: fractions of a robot's velocity limits."""

from __future__ import annotations

import numpy as np

from crowdbot.core.support.compiling.compile import array_kernel
from crowdbot.core.types.arrays import Array
from crowdbot.core.types.robot import RobotLimits


def action_size(limits: RobotLimits) -> int:
    """Return the number of entries of an action: v, w and, if the drive can move sideways, vy."""
    return 3 if limits.vy_max > 0.0 else 2


def commands_of(actions: Array, limits: RobotLimits) -> Array:
    """Return commands v, w, vy (W, 3) of actions (W, 2 or 3) from -1 to 1, m/s and rad/s.

    -1 is the least of a limit, 1 its largest.
    """
    return commands_between(np.ascontiguousarray(actions, np.float64), *bounds_of(limits))


def bounds_of(limits: RobotLimits) -> tuple[Array, Array]:
    """Return the least and the largest v, w, vy (3,), m/s and rad/s."""
    least = np.array([limits.v_min, -limits.w_max, -limits.vy_max])
    return least, np.array([limits.v_max, limits.w_max, limits.vy_max])


@array_kernel
def commands_between(actions: Array, least: Array, most: Array) -> Array:
    """Return commands of actions, as `commands_of`, between bounds (3,)."""
    found = np.empty((actions.shape[0], 3))
    for w in range(actions.shape[0]):
        for k in range(3):
            share = 0.5
            if k < actions.shape[1]:
                share = 0.5 * (min(1.0, max(-1.0, actions[w, k])) + 1.0)
            found[w, k] = least[k] + share * (most[k] - least[k])
    return found


def actions_of(commands: Array, limits: RobotLimits) -> Array:
    """Return the actions (W, 2 or 3) from -1 to 1 of commands (W, 3); the inverse of `commands_of`.

    Commands beyond the limits become -1 or 1.
    """
    size = action_size(limits)
    least = np.array([limits.v_min, -limits.w_max, -limits.vy_max])[:size]
    most = np.array([limits.v_max, limits.w_max, limits.vy_max])[:size]
    return np.asarray(np.clip(2.0 * (commands[:, :size] - least) / (most - least) - 1.0, -1.0, 1.0))
