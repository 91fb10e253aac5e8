"""Writes the replay page."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from crowdbot.core.recording.scans import ReplayScan
from crowdbot.core.replay.encode import encode, summary
from crowdbot.core.replay.other_track import OtherTrack, Seen, other_robot
from crowdbot.core.replay.scores import grouped
from crowdbot.core.support.atomic_write import atomic_write
from crowdbot.core.support.html_page import render_page
from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.core.types.score import Score

_SCRIPTS = ("decode.js", "motion.js", "draw.js", "timeline.js", "app.js")


def write_replay(
    path: Path,
    run: Trajectories,
    scans: Sequence[ReplayScan],
    scores: Sequence[Score],
    title: str,
    facts: Mapping[str, str],
    look: Sequence[Seen] = (),
    others: Sequence[OtherTrack] = (),
) -> None:
    """Write one offline HTML page; equal input gives equal bytes.

    Args:
        path: file to write, aside first and then renamed.
        run: what to show; a run without robot or without people is fine.
        scans: what lidars saw; drawn from the robot's true pose.
        scores: shown beside the run; may be empty.
        title: heading, e.g. the scenario's id.
        facts: name -> text; ``Status`` is shown beside the title.
        look: parts of the robot as they are seen from above, the lowest first: outline (K, 2) in
            its frame, m, and colour; without any it is its outline and an arrow.
        others: the other robots of a fleet.

    Raises:
        InputError: the path cannot be written.
    """
    text = _render(run, scans, scores, title, facts, look, others)
    atomic_write(path, text)


def _render(
    run: Trajectories,
    scans: Sequence[ReplayScan],
    scores: Sequence[Score],
    title: str,
    facts: Mapping[str, str],
    look: Sequence[Seen],
    others: Sequence[OtherTrack],
) -> str:
    meta, blobs = encode(run, scans)
    if meta["robot"] is not None:
        meta["robot"]["look"] = [[c, np.round(np.asarray(o), 3).tolist()] for o, c in look]
    for i, other in enumerate(others):
        about, blobs[f"other{i}"] = other_robot(run.t, other)
        meta.setdefault("others", []).append(about)
    status = next((v for k, v in facts.items() if k.lower() == "status"), "")
    return render_page(
        __package__,
        scripts=_SCRIPTS,
        title=title,
        status=status,
        facts={k: v for k, v in facts.items() if k.lower() != "status"} | dict(summary(run)),
        groups=grouped(scores),
        meta=meta,
        blobs=blobs,
    )
