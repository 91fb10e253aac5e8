"""Packs a run for the replay page: centimetres as int16, differences in time, zlib, base64.

A row of numbers becomes its first value and then differences, modulo 2^16; all low bytes come
before all high bytes, which are nearly all alike. `decode.js` undoes it.
"""

from __future__ import annotations

import base64
import zlib
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.geometry.footprint import body_side
from crowdbot.core.recording.scans import CENTIMETRE, REPLAY_RATE, ReplayScan
from crowdbot.core.trajectories.footprint_of_run import footprint_of
from crowdbot.core.trajectories.trajectories import AgentTracks, RobotTrack, Trajectories
from crowdbot.core.types.arrays import Array

ABSENT = -32768
#: Faster than this is not a step but a teleport, m/s (metric specification, 1.3).
JUMP_SPEED = 10.0
SCAN_BEAMS = 300
#: Of zlib: a twentieth of the time of level 9, for a seventh more bytes.
_LEVEL = 5
_LARGEST = 32000
_SIDES = ("front", "left", "right", "rear")


def encode(run: Trajectories, scans: Sequence[ReplayScan]) -> tuple[dict[str, Any], dict[str, str]]:
    """What the page needs to draw: plain data for JSON, and named blobs of base64."""
    blobs = {"t": deflate(run.t.astype("<f8").tobytes())}
    meta: dict[str, Any] = {
        "n": len(run.t),
        "walls": nested(run.walls),
        "zone": nested(run.goal_zone),
        "contacts": _contacts(run),
        "robot": None,
        "people": None,
        "scans": [],
        "cones": [],
    }
    if run.robot is not None:
        meta["robot"], blobs["robot"] = _robot(run, run.robot)
    if run.agents is not None:
        meta["people"], blobs["people"] = _people(run.t, run.agents)
    if run.robot is not None:
        for i, scan in enumerate(s for s in scans if len(s.t) and not s.cone):
            about, blobs[f"scan{i}"] = _scan(scan)
            meta["scans"].append(about)
        for i, cones in enumerate(_together([s for s in scans if len(s.t) and s.cone])):
            about, blobs[f"cones{i}"] = _cones(cones)
            meta["cones"].append(about)
    return meta, blobs


def _robot(run: Trajectories, robot: RobotTrack) -> tuple[dict[str, Any], str]:
    rows = np.stack((robot.x, robot.y, robot.theta, robot.v)).astype("<f4")
    about = {
        "radius": robot.radius,
        "outline": nested(run.robot_footprint),
        "goal": robot.goal,
        "goalRadius": robot.goal_radius,
        "goalTime": robot.goal_time,
    }
    return about, deflate(rows.tobytes())


def _people(t: Array, agents: AgentTracks) -> tuple[dict[str, Any], str]:
    rows = np.stack((agents.x.T, agents.y.T))
    rows[:, np.isnan(agents.x.T) | np.isnan(agents.y.T)] = np.nan
    farthest = float(np.nanmax(np.abs(rows), initial=0.0, where=np.isfinite(rows)))
    scale = max(CENTIMETRE, farthest / _LARGEST)
    jumps = np.flatnonzero(_jumps(t, agents))
    radius = agents.radius.tolist()
    about = {
        "count": len(agents.id),
        "scale": scale,
        "radius": radius if len(set(radius)) > 1 else radius[:1],
        "jumps": jumps.tolist(),  # step * count + person
    }
    return about, _pack(_quantise(rows.reshape(-1, len(t)), scale))


def _jumps(t: Array, agents: AgentTracks) -> NDArray[np.bool_]:
    if agents.jump is not None:
        return agents.jump
    step = np.hypot(np.diff(agents.x, axis=0), np.diff(agents.y, axis=0))
    fast: NDArray[np.bool_] = step > JUMP_SPEED * np.diff(t)[:, None]  # False where NaN
    return fast


def _contacts(run: Trajectories) -> list[dict[str, Any]]:
    """Contacts with the person's place in the list instead of an id; -1: a wall."""
    table = run.contacts
    if table is None:
        return []
    place = {-1: -1}
    if run.agents is not None:
        place |= {id_: i for i, id_ in enumerate(run.agents.id.tolist())}
    return [
        {
            "t0": float(table.t0[i]),
            "t1": float(table.t1[i]),
            "person": place.get(int(table.agent[i]), -1),
            "impulse": _number(table.impulse[i]),
            "bearing": _number(table.bearing[i]),
            "reach": round(_reach(run, float(table.bearing[i])), 4),
            "side": body_side(float(table.bearing[i])),
        }
        for i in np.argsort(table.t0, kind="stable")
    ]


def _reach(run: Trajectories, bearing: float) -> float:
    """How far a robot's surface is from its base in some direction, m; 0 where it has none."""
    if run.robot is None or not np.isfinite(bearing):
        return 0.0
    body = footprint_of(run)
    if body is None:
        return run.robot.radius
    steps = np.linspace(0.0, body.reach, 257)
    covered = body.gap(steps * np.cos(bearing), steps * np.sin(bearing)) <= 0.0
    return float(steps[covered].max(initial=0.0))


def _together(cones: Sequence[ReplayScan]) -> Iterable[Sequence[ReplayScan]]:
    """Cones that were read at the same times."""
    groups: dict[bytes, list[ReplayScan]] = {}
    for cone in cones:
        groups.setdefault(cone.t.tobytes(), []).append(cone)
    return groups.values()


def _cones(cones: Sequence[ReplayScan]) -> tuple[dict[str, Any], str]:
    """Readings of several sensors, a row each; 0 stands for nothing that came back."""
    chosen = _thinned(cones[0].t)
    ranges = np.stack([cone.ranges[chosen, 0] for cone in cones])
    ranges = np.where(np.isfinite(ranges), np.maximum(ranges, CENTIMETRE), 0.0)
    about = {
        "sensors": [
            {
                "sensor": cone.sensor,
                "mount": list(cone.mount),
                "edges": [round(float(a), 5) for a in cone.angles],
            }
            for cone in cones
        ],
        "t": [round(float(t), 6) for t in cones[0].t[chosen]],
    }
    return about, _pack(_quantise(ranges, CENTIMETRE))


def _scan(scan: ReplayScan) -> tuple[dict[str, Any], str]:
    """Some beams of some scans; 0 stands for nothing that came back."""
    every = max(1, -(-len(scan.angles) // SCAN_BEAMS))
    chosen = _thinned(scan.t)
    ranges = scan.ranges[chosen, ::every].T
    ranges = np.where(np.isfinite(ranges), np.maximum(ranges, CENTIMETRE), 0.0)
    about = {
        "sensor": scan.sensor,
        "mount": list(scan.mount),
        "rangeMax": _number(scan.range_max) or float(ranges.max(initial=1.0)),
        "angles": [round(float(a), 5) for a in scan.angles[::every]],
        "t": [round(float(t), 6) for t in scan.t[chosen]],
    }
    return about, _pack(_quantise(ranges, CENTIMETRE))


def _thinned(t: Array) -> list[int]:
    """Indices of stamps at least 1/`REPLAY_RATE` apart."""
    chosen: list[int] = []
    for i, stamp in enumerate(t.tolist()):
        if not chosen or stamp - t[chosen[-1]] > 0.99 / REPLAY_RATE:
            chosen.append(i)
    return chosen


def _quantise(rows: Array, scale: float) -> NDArray[np.int16]:
    known = np.isfinite(rows)
    steps = np.rint(np.where(known, rows, 0.0) / scale)
    clipped = np.clip(steps, -_LARGEST, _LARGEST)
    return np.where(known, clipped, ABSENT).astype(np.int16)


def _pack(rows: NDArray[np.int16]) -> str:
    words = rows.astype(np.uint16)
    words[:, 1:] -= rows.astype(np.uint16)[:, :-1]
    pairs = np.ascontiguousarray(words, "<u2").view(np.uint8).reshape(-1, 2)
    return deflate(pairs.T.tobytes())


def deflate(data: bytes) -> str:
    """Bytes as the page reads them."""
    return base64.b64encode(zlib.compress(data, _LEVEL)).decode("ascii")


def nested(rows: Array | None) -> list[list[float]]:
    """A table (K, C) as lists, to a tenth of a millimetre; empty for None."""
    return [] if rows is None else np.round(rows, 4).tolist()


def _number(value: float) -> float | None:
    return float(value) if np.isfinite(value) else None


def summary(run: Trajectories) -> Mapping[str, str]:
    """Facts of the run that the page shows whatever it is told."""
    facts = {"Duration": f"{run.t[-1] - run.t[0]:.1f} s"}
    if run.agents is not None:
        facts["People"] = str(len(run.agents.id))
    if run.contacts is not None:
        sides = Counter(map(body_side, run.contacts.bearing.tolist()))
        told = ", ".join(f"{sides[s]} {s}" for s in _SIDES if sides[s])
        count = str(len(run.contacts.agent))
        facts["Contacts"] = f"{count} ({told})" if told else count
    return facts
