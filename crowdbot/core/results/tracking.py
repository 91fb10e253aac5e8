"""Quality of people tracking in the runs of a folder."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

from crowdbot.core.planning.planner import TRACKS
from crowdbot.core.recording.recording import Recording
from crowdbot.core.results.results import Results
from crowdbot.core.runs.run_directory import RECORDING
from crowdbot.core.trajectories.tracking_quality import tracking_quality


def tracking_lines(
    results: Results, root: Path, within: Sequence[float]
) -> Iterator[dict[str, Any]]:
    """Yield a line for each run whose planner drew its tracks, and each distance.

    Args:
        results: the runs.
        root: of the run directories.
        within: distances from the robot, m.

    Raises:
        InputError: a recording is damaged.
    """
    for run in results.runs:
        with Recording(root / run.directory / RECORDING) as recording:
            if recording.robots:
                continue  # people near a fleet are recorded apart from each robot
            tracks = recording.drawings().get(TRACKS)
            if not tracks:
                continue
            truth = recording.trajectories()
        if truth.robot is None or truth.agents is None:
            continue
        about = {"scenario": run.scenario, "planner": run.planner, "seed": run.seed}
        for quality in tracking_quality(truth, [(one.t, one.rows) for one in tracks], within):
            yield {**about, **asdict(quality)}
