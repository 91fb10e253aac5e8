"""Figures of the people nearest to a camera; everyone else keeps the plain body.

A figure of each phase is a mesh of its own, and the meshes of a few people wait below the floor. So
the number of meshes does not grow with the number of people.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from pydrake.common import MemoryFile
from pydrake.geometry import (
    FrameId,
    GeometryFrame,
    GeometryInstance,
    InMemoryMesh,
    Mesh,
    PerceptionProperties,
    Rgba,
    SceneGraph,
    SourceId,
)
from pydrake.math import RigidTransform, RotationMatrix

from crowdbot.core.figures.figure import Figure, FigurePart
from crowdbot.core.sensing.scene import Scene
from crowdbot.core.types.arrays import Array
from crowdbot.core.types.motion import Pose

#: People farther from the robot are drawn with the plain body, and so are all but the nearest, m.
NEAR, MOST = 12.0, 8
HIDDEN = RigidTransform([0.0, 0.0, -100.0])


class FigurePool:
    """Meshes of figures for the nearest people.

    Args:
        graph, source: where the meshes are added.
        figures: person k has figure k modulo their number.
        height: usual height of the people, m; all figures have it.

    Attributes:
        frames: of the meshes, in the order of `poses`.
    """

    def __init__(
        self, graph: SceneGraph, source: SourceId, figures: Sequence[Figure], height: float
    ) -> None:
        self._figures, self._height = figures, height
        self._graph, self._source = graph, source
        self.frames: list[FrameId] = []
        self._first: dict[tuple[int, int], int] = {}
        for f, figure in enumerate(figures):
            for phase, parts in enumerate(figure.phases):
                self._first[f, phase] = len(self.frames)
                meshes = [_mesh(part, height) for part in parts]
                self.frames += [self._copy(f"figure{f}_{phase}_{k}", parts, meshes)
                                for k in range(MOST)]  # fmt: skip

    def poses(self, scene: Scene, pose: Pose) -> tuple[list[RigidTransform], list[int]]:
        """Return the poses of all meshes, and the people who are drawn by them.

        Args:
            scene: of this instant.
            pose: of the robot.
        """
        found = [HIDDEN] * len(self.frames)
        near = self._nearest(scene, pose)
        taken = dict.fromkeys(self._first, 0)
        headings, walked = scene.headings.tolist(), scene.walked.tolist()
        for k in near:
            f = k % len(self._figures)
            slot = f, self._figures[f].phase(walked[k], self._height)
            x, y = scene.people[k, :2].tolist()
            turn = RotationMatrix.MakeZRotation(headings[k])
            found[self._first[slot] + taken[slot]] = RigidTransform(turn, [x, y, 0.0])
            taken[slot] += 1
        return found, near

    def _nearest(self, scene: Scene, pose: Pose) -> list[int]:
        if not self._figures or not len(scene.people):
            return []
        looks = () if scene.looks is None else scene.looks.look
        usual = np.array([not look for look in looks] or [True] * len(scene.people))
        away = np.hypot(scene.people[:, 0] - pose.x, scene.people[:, 1] - pose.y)
        away[~(scene.present & usual)] = np.inf
        order = np.argsort(away, kind="stable")[:MOST]
        return [int(k) for k in order if away[k] < NEAR]

    def _copy(self, name: str, parts: Sequence[FigurePart], meshes: Sequence[Mesh]) -> FrameId:
        frame = self._graph.RegisterFrame(self._source, GeometryFrame(name))
        for k, (part, mesh) in enumerate(zip(parts, meshes, strict=True)):
            instance = GeometryInstance(RigidTransform(), mesh, f"{name}_{k}")
            looks = PerceptionProperties()
            if not part.texture:
                looks.AddProperty("phong", "diffuse", Rgba(*part.colour, 1.0))
            instance.set_perception_properties(looks)
            self._graph.RegisterGeometry(self._source, frame, instance)
        return frame


def _mesh(part: FigurePart, height: float) -> Mesh:
    beside = {}
    if part.texture:
        material = "newmtl figure\nKd 1 1 1\nmap_Kd figure.png\n"
        beside = {
            "figure.mtl": MemoryFile(material.encode(), ".mtl", "figure.mtl"),
            "figure.png": MemoryFile(part.texture, ".png", "figure.png"),
        }
    text = MemoryFile(figure_obj(part, height).encode(), ".obj", "figure")
    return Mesh(InMemoryMesh(mesh_file=text, supporting_files=beside))


def figure_obj(part: FigurePart, height: float) -> str:
    """Return Wavefront OBJ text of a part of a figure of a height (m), with smooth normals."""
    points = height * part.points
    lines = ["mtllib figure.mtl", "usemtl figure"] if part.texture else []
    lines += [f"v {x:.5f} {y:.5f} {z:.5f}" for x, y, z in points.tolist()]
    lines += [f"vn {x:.5f} {y:.5f} {z:.5f}" for x, y, z in _normals(points, part).tolist()]
    textured = part.uv is not None and bool(part.texture)
    if part.uv is not None and part.texture:
        lines += [f"vt {u:.5f} {1.0 - v:.5f}" for u, v in part.uv.tolist()]
    for row in (part.triangles + 1).tolist():
        lines.append("f " + " ".join(f"{i}/{i if textured else ''}/{i}" for i in row))
    return "\n".join(lines) + "\n"


def _normals(points: Array, part: FigurePart) -> Array:
    a, b, c = (points[part.triangles[:, k]] for k in range(3))
    faces = np.cross(b - a, c - a)
    found = np.zeros_like(points)
    for k in range(3):
        np.add.at(found, part.triangles[:, k], faces)
    length = np.linalg.norm(found, axis=1, keepdims=True)
    return np.where(length > 0.0, found / np.maximum(length, 1e-12), [0.0, 0.0, 1.0])
