"""Convex pieces of a collision mesh, by CoACD where it is installed, else its convex hull.

Source of the decomposition: Wei, Liu, Ling, Su, "Approximate convex decomposition for 3D meshes
with collision-aware concavity and tree search", ACM Transactions on Graphics 41(4), 2022; the
authors' library coacd does it. The same mesh gives the same pieces: the seed is fixed, and pieces
are sorted and rounded. They are kept in the user's cache by the content of the mesh, since cutting
it takes seconds.
"""

from __future__ import annotations

import hashlib
import json
import math
import os
import tempfile
from contextlib import suppress
from importlib import util
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Literal, NamedTuple

import numpy as np

from crowdbot.core.robots.mesh_box import mesh_points
from crowdbot.core.robots.xml import numbers
from crowdbot.core.support.text_files import LARGEST_TABLE, input_bytes
from crowdbot.core.types.arrays import Array

#: How collision meshes are simplified.
MeshShape = Literal["boxes", "hulls", "pieces"]
#: Most pieces of a mesh and corners of a piece, so that Drake's contacts stay fast.
MOST_PIECES, MOST_CORNERS = 16, 64
#: Concavity below which a piece is not cut further; CoACD's own default.
_CONCAVITY = 0.05
#: Corners are rounded to this many digits after the point, m.
_DIGITS = 6
_LEAST_VOLUME = 1e-12  # m^3; thinner pieces have no hull


class MeshPieces(NamedTuple):
    """A mesh as convex pieces.

    Attributes:
        corners: (N, 3) of each piece, m.
        why: why it is one hull though pieces were asked for; empty if it is not.
    """

    corners: tuple[Array, ...]
    why: str = ""


def mesh_pieces(file: Path, scale: str, shape: MeshShape) -> MeshPieces | None:
    """Return the convex pieces of a mesh; None if it cannot be read, or has no volume.

    Args:
        file: STL or OBJ; with the extra ``meshes`` also what trimesh reads.
        scale: three factors, as in a URDF.
        shape: ``hulls`` or ``pieces``.

    Raises:
        PluginError: ``scale`` does not consist of numbers.
    """
    factors = numbers(scale, "the scale of a mesh")
    if len(factors) != 3:
        return None
    if shape == "pieces":
        missing = [name for name in ("coacd", "trimesh") if util.find_spec(name) is None]
        if not missing:
            return _cut(file, factors)
        why = f"{' and '.join(missing)} not installed: pip install 'crowdbot[meshes]'"
    else:
        why = ""
    points = _points(file)
    hull = None if points is None else bounded_hull(points * factors)
    return None if hull is None else MeshPieces((hull,), why)


def bounded_hull(points: Array, most: int = MOST_CORNERS) -> Array | None:
    """Return at most ``most`` corners of a convex hull (N, 3), sorted; None without volume.

    If the hull has more, the corners farthest in evenly spread directions are kept: it shrinks a
    little and never grows.
    """
    from scipy.spatial import ConvexHull, QhullError  # half a second

    points = np.unique(np.round(points, _DIGITS), axis=0)
    if len(points) < 4 or not np.all(np.isfinite(points)):
        return None
    try:
        hull = ConvexHull(points)
    except QhullError:
        return None
    if hull.volume < _LEAST_VOLUME:
        return None
    corners = points[np.sort(hull.vertices)]
    if len(corners) > most:
        corners = corners[np.unique(np.argmax(corners @ _directions(most).T, axis=0))]
    return np.asarray(corners)


def _directions(count: int) -> Array:
    """Return unit vectors (count, 3): the six axes, and a Fibonacci lattice."""
    rest = count - 6
    k = np.arange(rest)
    z, turn = 1.0 - (2.0 * k + 1.0) / rest, math.pi * (3.0 - math.sqrt(5.0)) * k
    flat = np.sqrt(1.0 - z * z)
    lattice = np.column_stack([flat * np.cos(turn), flat * np.sin(turn), z])
    return np.concatenate([np.eye(3), -np.eye(3), lattice])


def _points(file: Path) -> Array | None:
    points = mesh_points(file)
    if points is None and util.find_spec("trimesh") is not None:
        loaded = _load(file)
        points = None if loaded is None else loaded[0]
    return points


def _load(file: Path) -> tuple[Array, Array] | None:
    """Return corners (N, 3) and triangles (M, 3) of a mesh that trimesh reads, else None."""
    import trimesh

    try:
        mesh = trimesh.load_mesh(file)
    except Exception:
        return None
    if not isinstance(mesh, trimesh.Trimesh) or not len(mesh.faces):
        return None
    return np.asarray(mesh.vertices, float), np.asarray(mesh.faces)


def _cut(file: Path, factors: list[float]) -> MeshPieces | None:
    kept = _kept(file, factors)
    with suppress(OSError, ValueError, TypeError, KeyError):
        found = json.loads(kept.read_text(encoding="utf-8"))
        return MeshPieces(tuple(np.array(p, float).reshape(-1, 3) for p in found["pieces"]))
    loaded = _load(file)
    if loaded is None:
        return None
    pieces = decompose(loaded[0] * factors, loaded[1])
    if pieces:
        _keep(kept, pieces)
        return MeshPieces(pieces)
    hull = bounded_hull(loaded[0] * factors)
    return None if hull is None else MeshPieces((hull,), "it cannot be cut")


def decompose(points: Array, triangles: Array) -> tuple[Array, ...]:
    """Return the corners of the convex pieces of a mesh, sorted; none if it cannot be cut.

    Args:
        points: (N, 3) m.
        triangles: (M, 3) rows of points.
    """
    import coacd

    coacd.set_log_level("error")
    try:
        found = coacd.run_coacd(
            coacd.Mesh(points, triangles), threshold=_CONCAVITY, max_convex_hull=MOST_PIECES,
            max_ch_vertex=MOST_CORNERS, decimate=True, seed=0,
        )  # fmt: skip
    except RuntimeError:
        return ()
    hulls = (bounded_hull(np.asarray(corners, float)) for corners, _ in found)
    return tuple(sorted((h for h in hulls if h is not None), key=lambda h: h.tolist()))


def _kept(file: Path, factors: list[float]) -> Path:
    """Return the path of a mesh's file in the cache."""
    try:
        made_by = version("coacd")
    except PackageNotFoundError:
        made_by = ""
    inputs = [factors, MOST_PIECES, MOST_CORNERS, _CONCAVITY, _DIGITS, made_by, file.suffix.lower()]
    digest = hashlib.sha256(json.dumps(inputs).encode() + input_bytes(file, LARGEST_TABLE))
    base = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")
    return base / "crowdbot" / "pieces" / f"{digest.hexdigest()}.json"


def _keep(kept: Path, pieces: tuple[Array, ...]) -> None:
    """Write a mesh's pieces to the cache; do nothing if that is not possible."""
    with suppress(OSError):
        kept.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.NamedTemporaryFile(
            "w", encoding="utf-8", dir=kept.parent, delete=False
        ) as text:
            json.dump({"pieces": [p.tolist() for p in pieces]}, text)
        Path(text.name).replace(kept)
