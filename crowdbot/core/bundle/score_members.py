"""Score the recordings in a bundle."""

from __future__ import annotations

from collections.abc import Sequence

from crowdbot.core.bundle.archive import Archive
from crowdbot.core.bundle.check_recordings import (
    ownership_problems,
    read_member,
    reference_members,
)
from crowdbot.core.bundle.check_run import ClaimedRun
from crowdbot.core.registry.registry import Registry
from crowdbot.core.runs import run_directory as files
from crowdbot.core.runs.identity import CROWD_ALONE, ROBOT_ALONE
from crowdbot.core.runs.read_and_score import score_robots
from crowdbot.core.scoring.evaluate import Scores
from crowdbot.core.scoring.metric import References
from crowdbot.errors import InputError


def recording_of(run: ClaimedRun) -> str:
    """Return the name of the member that records a run."""
    return f"{run.entry.directory}/{files.RECORDING}"


def score_member(
    archive: Archive, run: ClaimedRun, metrics: str | Sequence[str], registry: Registry
) -> Scores:
    """Score the recordings in the archive, with the available calibration runs.

    Raises:
        InputError: a recording cannot be read, or is not that of the run.
    """
    own = read_member(archive, recording_of(run))
    for problem in ownership_problems(run, own):
        raise InputError(f"{recording_of(run)}: {problem}")
    read = {
        key: read_member(archive, name)
        for key, name in reference_members(run).items()
        if name in archive.names
    }
    for key, found in read.items():
        if found.trajectory != run.record.reference_hashes.get(key):
            raise InputError(f"{run.entry.directory}: its {key} is not the one that it names")
    alone, crowd = read.get(ROBOT_ALONE), read.get(CROWD_ALONE)
    references = {
        name: References(
            robot_alone=None if alone is None else alone.runs.get(name),
            crowd_alone=None if crowd is None else crowd.runs.get(""),
        )
        for name in own.runs
    }
    return score_robots(registry, own.runs, references, metrics=metrics)
