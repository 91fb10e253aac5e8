"""Old names of methods of `Recording`, kept until 1.0."""

from __future__ import annotations

import warnings
from pathlib import Path

from crowdbot.core.recording.reading.scans import ReplayScan
from crowdbot.core.recording.recording import Recording, RecordingInfo
from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.old_names import OldNameWarning


def read_trajectories(path: Path, robot: str | None = None) -> Trajectories:
    """Forward to `Recording.trajectories`."""
    _warn("read_trajectories(path, robot)", "trajectories(robot)")
    with Recording(path) as recording:
        return recording.trajectories(robot)


def read_scans(
    path: Path, sensor: str | None = None, max_rate: float | None = None
) -> list[ReplayScan]:
    """Forward to `Recording.scans`; lidars only."""
    _warn("read_scans(path, sensor)", "scans(sensor)")
    with Recording(path, max_rate=max_rate) as recording:
        return [scan for scan in recording.scans(sensor) if not scan.cone]


def recording_info(path: Path) -> RecordingInfo:
    """Forward to `Recording.info`."""
    _warn("recording_info(path)", "info")
    with Recording(path) as recording:
        return recording.info


def _warn(old: str, new: str) -> None:
    text = f"{old} goes with crowdbot 1.0: write crowdbot.Recording(path).{new}"
    warnings.warn(text, OldNameWarning, stacklevel=3)


__all__ = ["read_scans", "read_trajectories", "recording_info"]
