"""Bounding box of a mesh: STL (binary or text) or Wavefront OBJ."""

from __future__ import annotations

import struct
from pathlib import Path

import numpy as np

from crowdbot.core.robots.xml import numbers
from crowdbot.core.support.text_files import LARGEST_TABLE, input_bytes
from crowdbot.core.types.arrays import Array

_HEAD, _FACE = 84, 50  # bytes of a binary STL's header, and of each triangle
_THINNEST = 1e-3  # m; a sheet becomes a plate
Vector = tuple[float, float, float]


def mesh_box(file: Path, scale: str = "1 1 1") -> tuple[Vector, Vector] | None:
    """Return sides and centre (m) of a mesh's bounding box, along its own axes.

    Args:
        scale: three scale factors, as in a URDF.

    Returns:
        None for another format, or a file without vertices.

    Raises:
        PluginError: ``scale`` does not consist of numbers.
    """
    factors = numbers(scale, "the scale of a mesh")
    points = mesh_points(file)
    if points is None or len(factors) != 3:
        return None
    ends = np.stack([points.min(axis=0), points.max(axis=0)]) * factors
    low, high = ends.min(axis=0), ends.max(axis=0)
    sides, centre = np.maximum(high - low, _THINNEST).tolist(), (0.5 * (low + high)).tolist()
    return (sides[0], sides[1], sides[2]), (centre[0], centre[1], centre[2])


def mesh_points(file: Path) -> Array | None:
    """Return the corners (N, 3) of an STL or OBJ file, m; None if there are none."""
    read = {".stl": _stl, ".obj": _obj}.get(file.suffix.lower())
    points = np.zeros((0, 3)) if read is None else read(input_bytes(file, LARGEST_TABLE))
    return points if len(points) and np.all(np.isfinite(points)) else None


def _stl(data: bytes) -> Array:
    """Return the corners of all triangles (N, 3)."""
    if len(data) >= _HEAD:
        (count,) = struct.unpack_from("<I", data, _HEAD - 4)
        if len(data) == _HEAD + _FACE * count:
            rows = np.frombuffer(data, np.uint8, offset=_HEAD).reshape(count, _FACE)
            return np.ascontiguousarray(rows[:, 12:48]).view("<f4").reshape(-1, 3).astype(float)
    return _lines(data, b"vertex")


def _obj(data: bytes) -> Array:
    return _lines(data, b"v")


def _lines(data: bytes, word: bytes) -> Array:
    """Return the three numbers after a word at the start of lines (N, 3)."""
    rows = (line.split() for line in data.splitlines())
    try:
        found = [[float(x) for x in row[1:4]] for row in rows if row[:1] == [word]]
    except ValueError:
        return np.zeros((0, 3))
    return np.array([row for row in found if len(row) == 3]).reshape(-1, 3)
