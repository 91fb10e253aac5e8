"""The interface of a watcher, which shows a run during the simulation."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Protocol

from crowdbot.core.recording.header import RecordingHeader
from crowdbot.core.types.arrays import Array


class Watcher(Protocol):
    """Gets the ground truth during the simulation, without affecting the run."""

    def begin(self, shared: RecordingHeader, robots: Mapping[str, RecordingHeader]) -> None:
        """Called at the start of a run.

        Args:
            shared: has walls and people.
            robots: by name; each has its robot, sensors and goal.
        """
        ...

    def sample(self, t: float, robots: Mapping[str, Sequence[float]], agents: Array | None) -> None:
        """Called with each sample of the ground truth.

        Args:
            t: time, s.
            robots: x, y, yaw, v, w of each that is there; m, rad, m/s, rad/s.
            agents: (4, M) x, y, vx, vy; NaN where a person is absent. It must not be changed.
        """
        ...

    def drawing(
        self,
        t: float,
        robot: str,
        name: str,
        columns: Array,
        texts: Sequence[str] | None = None,
    ) -> None:
        """Called with each drawing of a robot's planner.

        Args:
            t: time, s.
            robot: its name.
            name: of the drawing; ``tracks`` are the people that the planner knows of.
            columns: (2, K) x, y of a path or of points, m, world frame; of tracks (4, K) with
                vx, vy, m/s. They are placed from the robot's true pose.
            texts: K, each at its x, y; None: no texts.
        """
        ...
