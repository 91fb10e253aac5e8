"""Pack a run for the page: plain data for JSON, and named blobs."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.geometry.footprint import body_side
from crowdbot.core.recording.reading.scans import CENTIMETRE
from crowdbot.core.replay.encode_drawings import encode_drawings
from crowdbot.core.replay.encode_images import encode_images
from crowdbot.core.replay.encode_robot import encode_robots
from crowdbot.core.replay.encode_scans import encode_scans
from crowdbot.core.replay.encode_signals import encode_signals
from crowdbot.core.replay.pack import pack_motion, pack_words, quantise
from crowdbot.core.replay.shown_run import Scenery, ShownRun
from crowdbot.core.trajectories.tracks import AgentTracks
from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.core.types.arrays import Array

#: Faster steps are teleports, m/s (metric specification, 1.3).
JUMP_SPEED = 10.0
_LARGEST = 32000
_SIDES = ("front", "left", "right", "rear")


def encode(shown: ShownRun) -> tuple[dict[str, Any], dict[str, str]]:
    """Return the page's data: plain data for JSON, and named base64 blobs."""
    run = shown.run
    blobs = {"t": pack_words(run.t.astype("<f8"))}
    meta: dict[str, Any] = {
        "title": shown.title,
        "label": shown.label or shown.title,
        "status": shown.status,
        "n": len(run.t),
        "zone": nested(run.goal_zone),
        "people": None,
        **scenery_numbers(_scenery(shown)),
        "solids": shown.solids,
    }
    if run.agents is not None:
        meta["people"], blobs["people"] = _people(run.t, run.agents)
    parts = (
        encode_robots(shown),
        encode_scans(shown.scans if run.robot is not None else ()),
        encode_signals(run),
        encode_drawings(run, shown.drawings),
        encode_images(shown.images),
    )
    for more, packed in parts:
        meta |= more
        blobs |= packed
    return meta, blobs


def _scenery(shown: ShownRun) -> Scenery:
    """Return the scenery; default: the run's walls, which stop robots and people."""
    if shown.scenery is not None:
        return shown.scenery
    walls = np.zeros((0, 4)) if shown.run.walls is None else shown.run.walls.reshape(-1, 4)
    solid = np.ones(len(walls), np.bool_)
    return Scenery(walls=walls, stops_robot=solid, stops_crowd=solid)


def scenery_numbers(scene: Scenery) -> dict[str, Any]:
    """Return walls as x0, y0, x1, y1, m, and whom they stop: 3 all, 1 robots, 2 people, 0 none."""
    stops = scene.stops_robot.astype(int) + 2 * scene.stops_crowd
    walls = np.column_stack((scene.walls, stops))
    return {
        "walls": nested(walls),
        "pillars": nested(scene.pillars),
        "blocks": [nested(outline) for outline in scene.blocks],
        "steps": [nested(outline) for outline in scene.steps],
    }


def _people(t: Array, agents: AgentTracks) -> tuple[dict[str, Any], str]:
    rows = np.concatenate((agents.x, agents.y), axis=1)
    count = len(agents.id)
    absent = ~np.isfinite(agents.x) | ~np.isfinite(agents.y)
    rows[np.tile(absent, 2)] = np.nan
    farthest = float(np.nanmax(np.abs(rows), initial=0.0, where=np.isfinite(rows)))
    scale = max(CENTIMETRE, farthest / _LARGEST)
    jumps = np.flatnonzero(_jumps(t, agents))
    radius = agents.radius.tolist()
    about = {
        "count": count,
        "id": agents.id.tolist(),
        "scale": scale,
        "radius": radius if len(set(radius)) > 1 else radius[:1],
        "jumps": jumps.tolist(),  # step * count + person
    }
    return about, pack_motion(quantise(rows, scale).T)


def _jumps(t: Array, agents: AgentTracks) -> NDArray[np.bool_]:
    if agents.jump is not None:
        return agents.jump
    step = np.hypot(np.diff(agents.x, axis=0), np.diff(agents.y, axis=0))
    fast: NDArray[np.bool_] = step > JUMP_SPEED * np.diff(t)[:, None]  # False if NaN
    return fast


def nested(rows: Array | None) -> list[list[float]]:
    """Return rows for JSON, rounded to a tenth of a millimetre."""
    return [] if rows is None else np.round(rows, 4).tolist()


def summary(run: Trajectories) -> Mapping[str, str]:
    """Return the facts of the run that the page always shows."""
    facts = {"Duration": f"{run.t[-1] - run.t[0]:.1f} s"}
    if run.agents is not None:
        facts["People"] = str(len(run.agents.id))
    if run.contacts is not None:
        sides = Counter(map(body_side, run.contacts.bearing.tolist()))
        by_side = ", ".join(f"{sides[s]} {s}" for s in _SIDES if sides[s])
        count = str(len(run.contacts.agent))
        facts["Contacts"] = f"{count} ({by_side})" if by_side else count
    return facts
