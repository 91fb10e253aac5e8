"""The contract of a watcher: something that shows a run while it goes on."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

from crowdbot.core.recording.header import RecordingHeader
from crowdbot.core.types.arrays import Array


class Watcher(Protocol):
    """Sees the truth, as a recording does; nothing that it does reaches the run."""

    def begin(self, header: RecordingHeader) -> None:
        """A run begins; its header has walls, goal, robot and people."""
        ...

    def sample(self, t: float, robot: Sequence[float] | None, agents: Array | None) -> None:
        """One sample of the log.

        Args:
            t: time, s.
            robot: x, y, yaw, v, w; m, rad, m/s, rad/s.
            agents: (4, M) x, y, vx, vy; NaN where somebody is absent. It must not be changed.
        """
        ...
