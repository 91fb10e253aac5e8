"""Registers the reader of `Trajectories.from_mcap`, which may not import this package itself."""

from __future__ import annotations

from pathlib import Path

from crowdbot.core.trajectories.from_recordings import register_reader
from crowdbot.core.trajectories.trajectories import Trajectories


def _read(path: Path | str, robot: str | None) -> Trajectories:
    from crowdbot.core.recording.recording import Recording  # for those who read one

    with Recording(path) as recording:
        return recording.trajectories(robot)


register_reader(_read)

__all__ = ["Trajectories"]
