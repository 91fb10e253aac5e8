"""WallContacts: the robot's contacts with walls and pillars.

A contact starts with the first force (for a kinematic robot without forces, when it touches) and
ends when the gap exceeds the release gap, as with people. Its impulse is the sum of the horizontal
contact force over the ticks, its speed that of the robot one tick before it began.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from pydrake.multibody.plant import ContactResults
from pydrake.multibody.tree import world_index

from crowdbot.core.crowd.contact.robot_contact import RELEASE_GAP
from crowdbot.core.geometry.footprint import footprint_of_model
from crowdbot.core.recording.run_log import RunLog
from crowdbot.core.sim.contacts.outline_gap import outline_gap, touched_at
from crowdbot.core.sim.control.kinematic import obstacles
from crowdbot.core.support.ticks import TICK
from crowdbot.core.types.environment import EnvironmentParts
from crowdbot.core.types.robot import RobotModel, RobotState

#: Distance below which the plant's forces are read, m.
_NEAR = 0.01
#: A steeper normal belongs to the floor.
_LEVEL = 0.5
#: Distance at which a robot without forces touches, m.
_TOUCH = 1e-6
_WALL = -1
_WORLD = world_index()


@dataclass(slots=True)
class _Contact:
    start: float
    end: float
    speed: float
    bearing: float
    impulse: float = 0.0
    peak: float = 0.0


class _Near(NamedTuple):
    """A tick at which the robot was near a wall: time, its state, earlier speed and gap (m)."""

    t: float
    robot: RobotState
    speed: float
    gap: float


class WallContacts:
    """Monitors one robot's contacts with walls, at every tick at which it may be near one."""

    def __init__(self, parts: EnvironmentParts, robot: RobotModel, log: RunLog) -> None:
        self._walls, self._pillars = obstacles(parts, robot.height)
        self._body, self._log = footprint_of_model(robot), log
        # A disc's gap does not depend on its heading; corners swing.
        self._swing = 2.0 * float(np.max(np.hypot(*self._body.corners.T), initial=0.0))
        self._contact: _Contact | None = None
        self._near: _Near | None = None

    def watch(self, t: float, robot: RobotState, speed: float) -> float:
        """Process one tick; afterwards call `feel` if something is ``near``.

        Args:
            speed: the robot's speed one tick ago, m/s.

        Returns:
            distance that the robot may move before the next call, m; possibly negative.
        """
        at = (self._walls, self._pillars, self._body.corners, robot.x, robot.y, robot.yaw)
        gap = outline_gap(*at) - self._body.radius
        self._near = _Near(t, robot, speed, gap) if gap < _NEAR else None
        if gap > RELEASE_GAP:
            self.finish()
        return gap - RELEASE_GAP - self._swing

    @property
    def near(self) -> bool:
        """Return True if the last tick needs a call of `feel`."""
        return self._near is not None

    def feel(self, force: float | None) -> None:
        """Set the walls' force on the robot at the last tick.

        Args:
            force: their horizontal force on the robot, N; None for a robot without forces.
        """
        near, self._near = self._near, None
        if near is None or not self._touches(near.gap, force):
            return
        if self._contact is None:
            _, robot, speed, _ = near
            x, y = touched_at(
                self._walls, self._pillars, self._body.corners, robot.x, robot.y, robot.yaw
            )
            self._contact = _Contact(near.t, near.t, speed, math.atan2(y, x))
        self._contact.end = near.t
        self._contact.impulse += (force or 0.0) * TICK
        self._contact.peak = max(self._contact.peak, force or 0.0)

    @staticmethod
    def _touches(gap: float, force: float | None) -> bool:
        return gap <= _TOUCH if force is None else force > 0.0

    def finish(self) -> None:
        """End the active contact, if any."""
        if self._contact is not None:
            c, self._contact = self._contact, None
            self._log.writer.contact(
                t0=c.start, t1=c.end, agent=_WALL, impulse=c.impulse, peak_force=c.peak,
                relative_speed=c.speed, bearing=c.bearing,
            )  # fmt: skip


def wall_force(results: ContactResults) -> float:
    """Return the norm of the sum of all contact forces on the robot except the floor's, N."""
    total_x = total_y = 0.0
    for k in range(results.num_point_pair_contacts()):
        info = results.point_pair_contact_info(k)
        if abs(info.point_pair().nhat_BA_W.item(2)) < _LEVEL:
            sign = -1.0 if info.bodyB_index() == _WORLD else 1.0
            fx, fy, _ = info.contact_force().tolist()
            total_x += sign * fx
            total_y += sign * fy
    total = np.array((total_x, total_y))
    return math.sqrt(total.dot(total))  # the bits of `np.linalg.norm`, without its checks
