"""Encode planners' drawings for the page, in the world: tracks of people, paths, points, texts."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from crowdbot.core.planning.planner import TRACKS
from crowdbot.core.recording.placed_drawings import columns_in_world
from crowdbot.core.recording.reading.one_robot import PlannerDrawing
from crowdbot.core.replay.pack import pack_words
from crowdbot.core.trajectories.trajectories import Trajectories


def encode_drawings(
    run: Trajectories, drawings: Mapping[str, Sequence[PlannerDrawing]]
) -> tuple[dict[str, Any], dict[str, str]]:
    """Return names, times and numbers of rows; and x, y of all rows (2, K), float32.

    Rows of tracks also have their velocities, (4, K). Positions follow from the robot's true pose.
    Each text is stored once, with its index for each row; -1: none.
    """
    about: list[dict[str, Any]] = []
    blobs: dict[str, str] = {}
    if run.robot is None:
        return {"drawings": about}, blobs
    for name, drawn in sorted(drawings.items()):
        rows = [columns_in_world(run, one, tracks=name == TRACKS) for one in drawn]
        columns = np.concatenate(rows, axis=1)
        blobs[f"drawing{len(about)}"] = pack_words(columns.astype("<f4"))
        about.append(
            {
                "name": name,
                "tracks": name == TRACKS,
                "t": [round(one.t, 6) for one in drawn],
                "rows": [part.shape[1] for part in rows],
                **_texts(drawn),
            }
        )
    return {"drawings": about}, blobs


def _texts(drawn: Sequence[PlannerDrawing]) -> dict[str, Any]:
    if all(one.texts is None for one in drawn):
        return {}
    numbers: dict[str, int] = {}
    which: list[int] = []
    for one in drawn:
        if one.texts is None:
            which += [-1] * len(one.rows)
        else:
            which += [numbers.setdefault(text, len(numbers)) for text in one.texts]
    return {"texts": list(numbers), "which": which}
