"""Nodes of a glTF file at a time of an animation: their matrices, and weights of morph targets."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from crowdbot.core.figures.gltf_file import GltfFile
from crowdbot.core.geometry.rotation import rotation_of
from crowdbot.core.types.arrays import Array

_USUAL = {"translation": (0.0, 0.0, 0.0), "rotation": (0.0, 0.0, 0.0, 1.0), "scale": (1.0,) * 3}


@dataclass(frozen=True, slots=True)
class _Track:
    """Key frames of one property of one node."""

    node: int
    path: str
    times: Array
    values: Array
    step: bool


@dataclass
class GltfMotion:
    """The walking animation of a file: the first with "walk" in its name, else the first.

    Some programs write one animation for each node. So without a walk by name, other animations are
    combined with the first, as far as they move other nodes.

    Attributes:
        duration: s; 0 without an animation.
    """

    file: GltfFile
    duration: float = 0.0
    _tracks: list[_Track] = field(default_factory=list)

    def __post_init__(self) -> None:
        animations = self.file.list("animations")
        walks = [a for a in animations if "walk" in str(a.get("name", "")).lower()]
        for chosen in walks[:1] or animations:
            moved = {(track.node, track.path) for track in self._tracks}
            channels = chosen["channels"]
            if not moved & {(c["target"].get("node"), c["target"]["path"]) for c in channels}:
                for channel in channels:
                    self._add(chosen["samplers"][channel["sampler"]], channel["target"])
        ends = [float(track.times[-1]) for track in self._tracks]
        self.duration = max(ends, default=0.0)

    def _add(self, sampler: dict[str, Any], target: dict[str, Any]) -> None:
        times = np.asarray(self.file.values(sampler["input"]), float)
        values = np.asarray(self.file.values(sampler["output"]), float)
        if "node" not in target or not len(times):
            return
        rows = values.reshape(len(times), -1)
        how = sampler.get("interpolation", "LINEAR")
        if how == "CUBICSPLINE":  # tangent, value, tangent: the values, joined by lines
            width = rows.shape[1] // 3
            rows = rows[:, width : 2 * width]
        self._tracks.append(_Track(target["node"], target["path"], times, rows, how == "STEP"))

    def at(self, t: float) -> tuple[list[Array], dict[int, Array]]:
        """Return the matrix (4, 4) of each node in the scene, and weights of morphed nodes."""
        nodes = self.file.list("nodes")
        local = [dict(node) for node in nodes]
        weights = dict[int, Array]()
        for track in self._tracks:
            value = _value(track, t)
            if track.path == "weights":
                weights[track.node] = value
            else:
                local[track.node][track.path] = value.tolist()
                local[track.node].pop("matrix", None)
        found = [np.eye(4) for _ in nodes]
        parents = {child: k for k, node in enumerate(nodes) for child in node.get("children", [])}
        for k in range(len(nodes)):
            matrix, at, steps = _matrix(local[k]), k, 0
            while at in parents and steps < len(nodes):
                at, steps = parents[at], steps + 1
                matrix = _matrix(local[at]) @ matrix
            found[k] = matrix
        return found, weights


def _value(track: _Track, t: float) -> Array:
    k = int(np.clip(np.searchsorted(track.times, t, "right") - 1, 0, len(track.times) - 1))
    if track.step or k + 1 == len(track.times):
        return np.asarray(track.values[k])
    share = max(0.0, (t - track.times[k]) / (track.times[k + 1] - track.times[k]))
    first, second = track.values[k], track.values[k + 1]
    if track.path == "rotation" and float(first @ second) < 0.0:
        second = -second
    mixed = (1.0 - share) * first + share * second
    return np.asarray(mixed / np.linalg.norm(mixed) if track.path == "rotation" else mixed)


def _matrix(node: dict[str, Any]) -> Array:
    if "matrix" in node:
        return np.array(node["matrix"], float).reshape(4, 4).T
    move, turn, scale = (np.array(node.get(n, usual), float) for n, usual in _USUAL.items())
    x, y, z, w = turn / (np.linalg.norm(turn) or 1.0)
    found = np.eye(4)
    found[:3, :3] = rotation_of(x, y, z, w) * scale
    found[:3, 3] = move
    return found
