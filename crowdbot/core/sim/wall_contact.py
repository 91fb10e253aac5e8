"""WallContacts: the book of the robot's contacts with walls and pillars.

A contact begins with the first force (a kinematic robot feels none: where it touches) and ends
when the gap exceeds the release gap, as contacts with people do. Its impulse is the sum of the
horizontal contact force over the ticks, its speed that of the robot one tick before it began.
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
from crowdbot.core.sim.control.kinematic import obstacles
from crowdbot.core.sim.outline_gap import outline_gap, touched_at
from crowdbot.core.support.ticks import TICK
from crowdbot.core.types.environment import EnvironmentParts
from crowdbot.core.types.robot import RobotModel, RobotState

#: Nearer than this the plant is asked for forces, m.
_NEAR = 0.01
#: A normal steeper than this belongs to the floor.
_LEVEL = 0.5
#: What a robot without forces counts as touching, m.
_TOUCH = 1e-6
_WALL = -1


@dataclass(slots=True)
class _Contact:
    start: float
    end: float
    speed: float
    bearing: float
    impulse: float = 0.0
    peak: float = 0.0


class _Near(NamedTuple):
    """A tick at which the robot was near a wall: when, its state, speed before and gap (m)."""

    t: float
    robot: RobotState
    speed: float
    gap: float


class WallContacts:
    """Watches one robot; to be told its state at every tick at which it may be near."""

    def __init__(self, parts: EnvironmentParts, robot: RobotModel, log: RunLog) -> None:
        self._walls, self._pillars = obstacles(parts, robot.height)
        self._body, self._log = footprint_of_model(robot), log
        # A disc has the same gap whatever its heading; corners swing.
        self._swing = 2.0 * float(np.max(np.hypot(*self._body.corners.T), initial=0.0))
        self._contact: _Contact | None = None
        self._near: _Near | None = None

    def watch(self, t: float, robot: RobotState, speed: float) -> float:
        """One tick; where something is ``near`` afterwards, `feel` has to be called, too.

        Args:
            speed: of the robot one tick ago, m/s.

        Returns:
            how far the robot may go before this has to be called again, m; maybe negative.
        """
        at = (self._walls, self._pillars, self._body.corners, robot.x, robot.y, robot.yaw)
        gap = outline_gap(*at) - self._body.radius
        self._near = _Near(t, robot, speed, gap) if gap < _NEAR else None
        if gap > RELEASE_GAP:
            self.finish()
        return gap - RELEASE_GAP - self._swing

    @property
    def near(self) -> bool:
        """Whether the last tick waits for `feel`."""
        return self._near is not None

    def feel(self, force: float | None) -> None:
        """What walls do to the robot at the tick that was watched last.

        Args:
            force: their horizontal force on the robot, N; None where it feels none.
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
        """End the contact that is going on, if any."""
        if self._contact is not None:
            c, self._contact = self._contact, None
            self._log.writer.contact(
                t0=c.start, t1=c.end, agent=_WALL, impulse=c.impulse, peak_force=c.peak,
                relative_speed=c.speed, bearing=c.bearing,
            )  # fmt: skip


def wall_force(results: ContactResults) -> float:
    """Norm of the sum of all contact forces on the robot but the floor's, N."""
    total = np.zeros(2)
    for k in range(results.num_point_pair_contacts()):
        info = results.point_pair_contact_info(k)
        if abs(info.point_pair().nhat_BA_W[2]) < _LEVEL:
            sign = -1.0 if info.bodyB_index() == world_index() else 1.0
            total += sign * info.contact_force()[:2]
    return float(np.linalg.norm(total))
