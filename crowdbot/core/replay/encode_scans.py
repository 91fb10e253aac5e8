"""Pack range sensor readings; 0 means no return."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.recording.reading.scans import CENTIMETRE, REPLAY_RATE, ReplayScan
from crowdbot.core.replay.encode_contacts import number
from crowdbot.core.replay.pack import ABSENT, pack_motion, pack_readings, quantise
from crowdbot.core.types.arrays import Array

SCAN_BEAMS = 300


def encode_scans(scans: Sequence[ReplayScan]) -> tuple[dict[str, Any], dict[str, str]]:
    """Return each lidar separately.

    Ultrasounds and infrared sensors with the same times together.
    """
    known = [scan for scan in scans if len(scan.t)]
    meta: dict[str, Any] = {"scans": [], "cones": []}
    blobs: dict[str, str] = {}
    for i, scan in enumerate(s for s in known if not s.cone):
        about, blobs[f"scan{i}"] = _scan(scan)
        meta["scans"].append(about)
    for i, cones in enumerate(_together([s for s in known if s.cone])):
        about, blobs[f"cones{i}"] = _cones(cones)
        meta["cones"].append(about)
    return meta, blobs


def _together(cones: Sequence[ReplayScan]) -> Iterable[Sequence[ReplayScan]]:
    """Group cones that were read at the same times."""
    groups: dict[bytes, list[ReplayScan]] = {}
    for cone in cones:
        groups.setdefault(cone.t.tobytes(), []).append(cone)
    return groups.values()


def _cones(cones: Sequence[ReplayScan]) -> tuple[dict[str, Any], str]:
    """Return the data of cones with equal times, and their packed ranges, a row per sensor."""
    chosen = _thinned(cones[0].t)
    ranges = np.stack([cone.ranges[chosen, 0] for cone in cones])
    about = {
        "sensors": [
            {
                "sensor": cone.sensor,
                "mount": list(cone.mount),
                **_tilt(cone),
                "edges": [round(float(a), 5) for a in cone.angles],
            }
            for cone in cones
        ],
        "t": _stamps(cones[0].t[chosen]),
    }
    return about, pack_motion(_centimetres(ranges))


def _scan(scan: ReplayScan) -> tuple[dict[str, Any], str]:
    """Return a lidar's data, and its packed ranges, with fewer beams and scans."""
    every = max(1, -(-len(scan.angles) // SCAN_BEAMS))
    chosen = _thinned(scan.t)
    ranges = scan.ranges[chosen, ::every]
    farthest = float(ranges.max(initial=1.0, where=np.isfinite(ranges)))
    about = {
        "sensor": scan.sensor,
        "mount": list(scan.mount),
        **_tilt(scan),
        "rangeMax": number(scan.range_max) or farthest,
        "angles": [round(float(a), 5) for a in scan.angles[::every]],
        "t": _stamps(scan.t[chosen]),
    }
    return about, pack_readings(_centimetres(ranges).T)


def _tilt(scan: ReplayScan) -> dict[str, list[float]]:
    """Return roll and pitch, if a sensor is not level."""
    return {"tilt": list(scan.tilt)} if any(scan.tilt) else {}


def _centimetres(ranges: Array) -> NDArray[np.int16]:
    steps = quantise(ranges, CENTIMETRE)
    lost = steps == ABSENT
    np.maximum(steps, 1, out=steps)
    steps[lost] = 0
    return steps


def _stamps(t: Array) -> list[float]:
    return np.round(t, 6).tolist()  # type: ignore[no-any-return]


def _thinned(t: Array) -> list[int]:
    """Return indices of stamps at least 1/`REPLAY_RATE` apart."""
    chosen: list[int] = []
    last = -np.inf
    for i, stamp in enumerate(t.tolist()):
        if stamp - last > 0.99 / REPLAY_RATE:
            chosen.append(i)
            last = stamp
    return chosen
