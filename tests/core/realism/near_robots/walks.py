"""Clips made up for tests: robots that drive straight on, and people who do this or that."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np

from crowdbot.core.geometry.footprint import Footprint
from crowdbot.core.realism.near_robots.clip import RATE, Clip, clip_from_arrays
from crowdbot.core.types.arrays import Array

DISC = Footprint(np.zeros((0, 2)), 0.25)


def clip(
    angle: float = math.pi, speed: float = 1.0, own: float = 1.2, aside: float = 0.0,
    offset: float = 0.0, seconds: float = 9.0, slow: float = 1.0,
) -> Clip:  # fmt: skip
    """Return a robot along x that is at the origin after 5 s, and a person who meets it there.

    Args:
        angle: heading of the person, rad.
        aside: how far the person steps to its left, 3 s to 1 s before the origin, m.
        offset: how far to its left the person walks all the time, m.
        slow: factor of the person's speed from 3 s before on.
    """
    t = np.arange(0.0, seconds, 1.0 / RATE)
    pose = np.column_stack([speed * (t - 5.0), np.zeros(len(t)), np.zeros(len(t))])
    way = np.array([math.cos(angle), math.sin(angle)])
    left = np.array([-way[1], way[0]])
    along = own * (t - 5.0) + own * (slow - 1.0) * np.maximum(0.0, t - 2.0)
    share = np.clip((t - 2.0) / 2.0, 0.0, 1.0)
    beside = offset + aside * share * share * (3.0 - 2.0 * share)
    people = along[:, np.newaxis] * way + beside[:, np.newaxis] * left
    return clip_from_arrays("made up", "here", t, pose, people[:, np.newaxis], DISC)


def as_table(folder: Path, clips: list[Clip]) -> list[Path]:
    """Write tables with a robot, and return their paths."""
    paths = []
    for k, one in enumerate(clips):
        rows = ["t,id,x,y,radius"]
        for row, t in enumerate(one.t):
            x, y = one.pose[row, :2]
            rows.append(f"{t:.4f},robot,{x:.4f},{y:.4f},0.25")
            x, y = one.people[row, 0]
            rows.append(f"{t:.4f},p1,{x:.4f},{y:.4f},")
        path = folder / f"clip{k}.csv"
        path.write_text("\n".join(rows) + "\n", encoding="utf-8")
        paths.append(path)
    return paths


def various(count: int, aside: float = 0.6) -> list[Clip]:
    """Return head-on clips that differ in speed and offset."""
    spread: Array = np.linspace(-1.0, 1.0, count)
    return [clip(own=1.2 + 0.1 * s, aside=aside + 0.1 * s, offset=0.1 * s) for s in spread]
