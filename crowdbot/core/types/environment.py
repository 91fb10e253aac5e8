"""The parts of an environment."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.types.arrays import Array
from crowdbot.dsl.spec.component_specs import SceneLight


@dataclass(frozen=True, slots=True, kw_only=True)
class EnvironmentParts:
    """Geometry of a place, from which plant, sensors, crowd and drawings are built.

    Attributes:
        walls: (S, 4) segments x0, y0, x1, y1, m; the free side is on their left.
        wall_heights: (S, 2) bottom and top, m.
        stops_robot: (S,) bool, the robot collides with the segment.
        stops_crowd: (S,) bool, people avoid the segment.
        zones: name -> (K, 2) polygon, counter-clockwise, m.
        portals: name -> (x0, x1, y0, y1), m.
        pillars: (P, 3) x, y and radius of round obstacles for robot and people, m.
        pillar_heights: (P, 2) bottom and top, m.
        solids: convex outlines (K, 2), counter-clockwise, of obstacles that the robot collides with
            as a whole, m; sensors and people use their sides, which are among ``walls``.
        solid_heights: (B, 2) bottom and top, m.
        solids_stop_crowd: (B,) bool, people go around the solid; all of them if left out.
        periodic_boundary: (x0, x1, y0, y1) of a floor with periodic boundaries, on which people who
            leave on one side return on the other, m; else None.
        left_out: outlines (K, 2) of what is too small to be kept, m: drawn, and nothing else.
        floor_friction: coefficient of a tyre on the floor; core takes it from the spec.
        light: of the scene; None: the usual one. Core takes it from the spec.
    """

    walls: Array
    wall_heights: Array
    stops_robot: NDArray[np.bool_]
    stops_crowd: NDArray[np.bool_]
    zones: Mapping[str, Array]
    portals: Mapping[str, tuple[float, float, float, float]]
    pillars: Array = field(default_factory=lambda: np.zeros((0, 3)))
    pillar_heights: Array = field(default_factory=lambda: np.zeros((0, 2)))
    solids: tuple[Array, ...] = ()
    solid_heights: Array = field(default_factory=lambda: np.zeros((0, 2)))
    solids_stop_crowd: NDArray[np.bool_] = field(default_factory=lambda: np.zeros(0, np.bool_))
    periodic_boundary: tuple[float, float, float, float] | None = None
    left_out: tuple[Array, ...] = ()
    floor_friction: float = 1.0
    light: SceneLight | None = None

    def __post_init__(self) -> None:
        if not len(self.solids_stop_crowd):
            object.__setattr__(self, "solids_stop_crowd", np.ones(len(self.solids), np.bool_))

    def sides(self) -> NDArray[np.bool_]:
        """Return a mask (S,) of walls that are sides of solids; the robot collides with these."""
        corners = {_rounded(p) for outline in self.solids for p in outline.tolist()}
        return np.array(
            [
                not stops and _rounded(row[:2]) in corners and _rounded(row[2:]) in corners
                for row, stops in zip(self.walls.tolist(), self.stops_robot, strict=True)
            ],
            np.bool_,
        )

    def in_the_way(self, height: float) -> tuple[Array, Array, tuple[Array, ...]]:
        """Return obstacles for people of a height (m): walls (S, 4), pillars (P, 3) and solids."""
        low = self.stops_crowd & (self.wall_heights[:, 0] < height)
        solids = zip(self.solids, self.solids_stop_crowd, self.solid_heights[:, 0], strict=True)
        return (
            self.walls[low],
            self.pillars[self.pillar_heights[:, 0] < height],
            tuple(s for s, stops, bottom in solids if stops and bottom < height),
        )


def _rounded(point: Sequence[float]) -> tuple[float, float]:
    return round(point[0], 6), round(point[1], 6)
