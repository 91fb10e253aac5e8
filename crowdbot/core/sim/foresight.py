"""Foresight: predict people by advancing a copy of the crowd's state.

People decide, wander and respond to the robot as they will in the run, so the prediction comes true
if the robot drives along the given path. It does not change the run.
"""

from __future__ import annotations

import numpy as np

from crowdbot.core.crowd import CrowdEngine
from crowdbot.core.crowd import state as s
from crowdbot.core.crowd.contact.robot_contact import R_W, R_YAW, RVX, RVY, RX, RY
from crowdbot.core.support.ticks import TICK, TICKS_PER_SECOND
from crowdbot.core.types.arrays import Array

#: A person who is not there is foreseen here, m: far from everything.
AWAY = 1e6
#: Longest time that can be foreseen at once, s.
_LONGEST = 60.0


class Foresight:
    """Foresees the people of one crowd and one robot.

    Args:
        engine: the crowd.
        row: (8,) the robot's row, without its pose.
        outline: (1, K, 2) of the robot, m.
        stiffness: of the contact with it, N/m.
    """

    def __init__(self, engine: CrowdEngine, row: Array, outline: Array, stiffness: float) -> None:
        self._engine, self._row, self._outline = engine, row, outline
        self._numbers, self._stiffnesses = np.zeros(1, np.int64), np.array([stiffness])

    def places(self, state: Array, steps: int, step: float, path: Array | None = None) -> Array:
        """Return where each person of a crowd will be after each step, (T, N, 2), m.

        Args:
            state: the crowd's flat state now; not changed.
            steps: T.
            step: s.
            path: (T + 1, 3) x, y and yaw of the robot now and after each step, m, rad; None: no one
                meets a robot.

        Raises:
            ValueError: the path is of another length, or the time is longer than a minute.
        """
        if not 0.0 < steps * step <= _LONGEST:
            raise ValueError(f"foresee: {steps} steps of {step:g} s; at most {_LONGEST:g} s in all")
        if path is not None and np.shape(path) != (steps + 1, 3):
            raise ValueError(f"foresee: a path of {steps} steps has {steps + 1} rows x, y, yaw")
        flat = np.array(state)
        out = np.empty((steps, len(self._engine.agents), 2))
        done = 0
        for k in range(steps):
            due = round((k + 1) * step * TICKS_PER_SECOND)
            if path is None:
                self._alone(flat, due - done)
            else:
                self._beside(flat, path[k : k + 2], step, due - done)
            done = due
            out[k] = _places(flat, (k + 1) * step - done * TICK)
        return out

    def _alone(self, flat: Array, count: int) -> None:
        while count > 0:
            count -= self._engine.advance_alone(flat, count)

    def _beside(self, flat: Array, poses: Array, step: float, count: int) -> None:
        """Advance beside a robot that moves evenly from one pose to the next."""
        (x, y, yaw), going = poses[0].tolist(), ((poses[1] - poses[0]) / step).tolist()
        row = self._row.copy()
        row[[RVX, RVY, R_W]] = going
        for tick in range(count):
            t = step * (tick + 1) / count
            row[[RX, RY, R_YAW]] = x + t * going[0], y + t * going[1], yaw + t * going[2]
            self._engine.advance(
                flat, row[np.newaxis], self._outline,
                numbers=self._numbers, stiffnesses=self._stiffnesses,
            )  # fmt: skip


def _places(flat: Array, late: float) -> Array:
    """Return positions (N, 2) extrapolated by ``late`` seconds, part of a tick, m."""
    _, rows = s.view(flat)
    here = rows[:, s.WAITING] == s.PRESENT
    places = rows[:, s.X : s.Y + 1] + late * rows[:, s.VX : s.VY + 1]
    return np.where(here[:, np.newaxis], places, AWAY)
