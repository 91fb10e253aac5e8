"""The interface of a watcher, which shows a run during the simulation."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

from crowdbot.core.recording.header import RecordingHeader
from crowdbot.core.types.arrays import Array


class Watcher(Protocol):
    """Gets the ground truth, like a recording; it cannot affect the run."""

    def begin(self, header: RecordingHeader) -> None:
        """Start a run; its header has walls, goal, robot and people."""
        ...

    def sample(self, t: float, robot: Sequence[float] | None, agents: Array | None) -> None:
        """Show one sample of the log.

        Args:
            t: time, s.
            robot: x, y, yaw, v, w; m, rad, m/s, rad/s.
            agents: (4, M) x, y, vx, vy; NaN if absent. It must not be changed.
        """
        ...
