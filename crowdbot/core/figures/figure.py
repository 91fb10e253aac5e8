"""A figure: meshes of a person, one for each phase of a walk, from a glTF file.

In glTF a figure is upright along y and looks along z; here it is upright along z, looks along x,
stands on the floor and is 1 m high. Nodes, skins and morph targets are posed once for each phase.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.figures.gltf_file import GltfFile
from crowdbot.core.figures.gltf_looks import GREY, Looks, looks_of
from crowdbot.core.figures.gltf_motion import GltfMotion
from crowdbot.core.types.arrays import Array

#: Phases of a walk, of two steps.
PHASES = 8
#: Most triangles of a figure: there are many people.
MOST_TRIANGLES = 20_000
_TRIANGLES, _STRIP, _FAN = 4, 5, 6


@dataclass(frozen=True, slots=True)
class FigurePart:
    """A figure's triangles of one material.

    Attributes:
        points: (N, 3) m, of a figure 1 m high.
        triangles: (M, 3) rows of points.
        colour: red, green, blue, 0 to 1, sRGB.
        uv: (N, 2) place in the texture, from its top left corner; None without.
        texture: PNG; empty without.
    """

    points: Array
    triangles: NDArray[np.int64]
    colour: tuple[float, float, float] = GREY
    uv: Array | None = None
    texture: bytes = b""


@dataclass(frozen=True, slots=True)
class Figure:
    """A person's meshes: parts of each phase; one phase if it is not animated."""

    phases: tuple[tuple[FigurePart, ...], ...]

    def phase(self, walked: float, height: float) -> int:
        """Return the number of the walk's phase after a walked distance.

        Args:
            walked: m; two steps are 0.83 heights long, as sensors see them.
            height: of the person, m.
        """
        return int(walked / (0.83 * height) * len(self.phases)) % len(self.phases)


@cache
def load_figure(path: Path) -> Figure:
    """Read a figure.

    Raises:
        InputError: the file cannot be read, or is not one person of at most `MOST_TRIANGLES`.
    """
    file = GltfFile(path)
    try:
        return _figure(file)
    except (AttributeError, KeyError, IndexError, TypeError, ValueError) as error:
        raise file.error(f"is not valid glTF: {error!r}") from error


def _figure(file: GltfFile) -> Figure:
    motion = GltfMotion(file)
    count = PHASES if motion.duration > 0.0 else 1
    phases = [_parts(file, *motion.at(motion.duration * k / count)) for k in range(count)]
    if not phases[0]:
        raise file.error("has no triangles")
    most = sum(len(part.triangles) for part in phases[0])
    if most > MOST_TRIANGLES:
        raise file.error(f"has {most} triangles; a figure has at most {MOST_TRIANGLES}")
    first = np.concatenate([part.points for part in phases[0]])
    low, high = float(first[:, 2].min()), float(first[:, 2].max())
    if not np.all(np.isfinite(first)) or not high - low > 0.0:
        raise file.error("has no height")
    middle = np.array([*(0.5 * (first.min(axis=0) + first.max(axis=0)))[:2], low])
    ahead = _way(file, motion, first)
    return Figure(
        tuple(
            tuple(_moved(p, middle + k / count * ahead, 1.0 / (high - low)) for p in phase)
            for k, phase in enumerate(phases)
        )
    )


def _way(file: GltfFile, motion: GltfMotion, first: Array) -> Array:
    """Return the horizontal displacement (3,) of a figure over an animation, to be removed."""
    if not motion.duration > 0.0:
        return np.zeros(3)
    last = np.concatenate([part.points for part in _parts(file, *motion.at(motion.duration))])
    return np.asarray((last.mean(axis=0) - first.mean(axis=0)) * [1.0, 1.0, 0.0])


def _moved(part: FigurePart, middle: Array, scale: float) -> FigurePart:
    points = (part.points - middle) * scale
    return FigurePart(points, part.triangles, part.colour, part.uv, part.texture)


def _parts(
    file: GltfFile, matrices: list[Array], weights: dict[int, Array]
) -> tuple[FigurePart, ...]:
    found = []
    for k, node in enumerate(file.list("nodes")):
        if "mesh" not in node:
            continue
        mesh = file.list("meshes")[node["mesh"]]
        usual = np.array(node.get("weights", mesh.get("weights", [])), float)
        for primitive in mesh["primitives"]:
            if primitive.get("mode", _TRIANGLES) in (_TRIANGLES, _STRIP, _FAN):
                points = _morphed(file, primitive, weights.get(k, usual))
                placed = _placed(file, node, primitive, points, matrices, k)
                found.append(_part(file, primitive, placed))
    return tuple(found)


def _morphed(file: GltfFile, primitive: dict[str, Any], weights: Array) -> Array:
    points = np.array(file.values(primitive["attributes"]["POSITION"]), float)
    for weight, target in zip(weights, primitive.get("targets", []), strict=False):
        if weight and "POSITION" in target:
            points += weight * file.values(target["POSITION"])
    return points


def _placed(
    file: GltfFile, node: dict[str, Any], primitive: dict[str, Any], points: Array,
    matrices: list[Array], k: int,
) -> Array:  # fmt: skip
    """Return points in the scene: moved with their node, or with the joints of its skin."""
    ones = np.column_stack([points, np.ones(len(points))])
    names = primitive["attributes"]
    if "skin" not in node or "JOINTS_0" not in names:
        return np.asarray((ones @ matrices[k].T)[:, :3])
    skin = file.list("skins")[node["skin"]]
    binds = np.tile(np.eye(4), (len(skin["joints"]), 1, 1))
    if "inverseBindMatrices" in skin:
        binds = np.asarray(file.values(skin["inverseBindMatrices"]), float)
    joints = np.array([matrices[j] @ b for j, b in zip(skin["joints"], binds, strict=True)])
    which = np.asarray(file.values(names["JOINTS_0"]), np.int64)
    weight = np.asarray(file.values(names["WEIGHTS_0"]), float)
    each = np.einsum("nk,nkij->nij", weight, joints[which])
    return np.asarray(np.einsum("nij,nj->ni", each, ones)[:, :3])


def _part(file: GltfFile, primitive: dict[str, Any], points: Array) -> FigurePart:
    count = len(points)
    rows = file.values(primitive["indices"]) if "indices" in primitive else np.arange(count)
    triangles = _triangles(np.asarray(rows, np.int64), primitive.get("mode", _TRIANGLES))
    if triangles.size and triangles.max() >= count:
        raise file.error("has triangles of points that are not there")
    looks = looks_of(file, primitive) if "material" in primitive else Looks()
    return FigurePart(points[:, [2, 0, 1]], triangles, looks.colour, looks.uv, looks.texture)


def _triangles(rows: NDArray[np.int64], mode: int) -> NDArray[np.int64]:
    """Return triangles (M, 3) of rows of points, from a list, a strip or a fan."""
    if mode == _TRIANGLES:
        return rows.reshape(-1, 3)
    if mode == _FAN:
        return np.column_stack([np.full(len(rows) - 2, rows[0]), rows[1:-1], rows[2:]])
    triangles = np.column_stack([rows[:-2], rows[1:-1], rows[2:]])
    triangles[1::2] = triangles[1::2][:, [1, 0, 2]]  # every other one runs the other way
    return triangles
