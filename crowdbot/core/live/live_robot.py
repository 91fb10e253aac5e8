"""One robot of a live run: its state, its driver and its commands."""

from __future__ import annotations

from collections.abc import Hashable
from dataclasses import dataclass

from crowdbot.core.types.motion import Command
from crowdbot.core.types.robot import RobotLimits


@dataclass
class PendingStep:
    """The step that waits for its command."""

    ns: int
    answer: Command | None = None


@dataclass
class LiveRobot:
    """One robot; the lock of the session protects it.

    Attributes:
        name: its name in the current run; empty if the run does not have it.
        pose, twist: x, y, yaw and v, w, vy by odometry.
        driver: the client that drives it.
        pending: the step that waits for its command.
        limits: of its commands, once they are known.
        latest, fresh: the latest command; True if it has not been read.
    """

    name: str = ""
    pose: tuple[float, float, float] = (0.0, 0.0, 0.0)
    twist: tuple[float, float, float] = (0.0, 0.0, 0.0)
    driver: Hashable | None = None
    pending: PendingStep | None = None
    latest: Command | None = None
    fresh: bool = False
    limits: RobotLimits | None = None
