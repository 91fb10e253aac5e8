"""Two corridors that cross at an angle."""

from __future__ import annotations

import math
from typing import Annotated, Literal

from annotated_types import Ge, Le

from crowdbot.plugin import (
    Component,
    NonNegativeLength,
    Place,
    PositiveLength,
    Quantity,
    Rectangle,
    default,
    outlines,
)
from crowdbot.plugins.environments.walkways import (
    PORTAL_DEPTH,
    WalkwaySpec,
    box,
    rounded,
    walkway,
)

_RIGHT = math.pi / 2
#: Indices of a corner and of the arms' ends in the outline without rounding.
_CORNERS = (2, 5, 8, 11)


class CrossingCorridorSpec(WalkwaySpec):
    """Two corridors that cross at the origin; the first lies along x."""

    kind: Literal["crossing_corridor"] = "crossing_corridor"
    length: PositiveLength = default(30.0, "Of the first corridor, m.")
    width: PositiveLength = default(5.0, "Of the first corridor, m.")
    cross_length: PositiveLength = default(30.0, "Of the second one, m.")
    cross_width: PositiveLength = default(5.0, "Of the second one, m.")
    angle: Annotated[float, Ge(math.radians(30)), Le(math.radians(150)), Quantity("angle")] = (
        default(_RIGHT, "From the first to the second, 30 to 150 deg, rad.")
    )
    corner_radius: NonNegativeLength = default(0.0, "Of the four corners, m; 0: square.")

    def place(self) -> Place:
        """Return the place with four arms; people walk through their ends."""
        plain, points, ends = self._outline(), list[outlines.Point](), list[int]()
        for k, point in enumerate(plain):
            if k in _CORNERS:
                after = plain[(k + 1) % len(plain)]
                points += rounded(plain[k - 1], point, after, self.corner_radius)
                continue
            if k % 3 == 0:
                ends.append(len(points))
            points.append(point)
        return Place(faces=walkway(tuple(points), ends, self.wall_height))

    def usual_zones(self) -> dict[str, Rectangle]:
        """Return the arms of the first corridor, the middle, and, if square, the second's arms.

        If not square, ``across`` is the box around the second corridor.
        """
        a, b, half = 0.5 * self.width, 0.5 * self.cross_width, 0.5 * self.length
        wide = max(abs(x) for x, _ in (self._corner(s, t) for s in (-1, 1) for t in (-1, 1)))
        found = {"west": box(-half, -wide, -a, a), "east": box(wide, half, -a, a)}
        found["middle"] = box(-wide, wide, -a, a)
        if self.angle == _RIGHT:
            far = 0.5 * self.cross_length
            return found | {"south": box(-b, b, -far, -a), "north": box(-b, b, a, far)}
        ends = [point for k, point in enumerate(self._outline()) if k in (3, 4, 9, 10)]
        x, y = max(p[0] for p in ends), max(p[1] for p in ends)
        return found | {"across": box(-x, x, -y, y)}

    def usual_portals(self) -> dict[str, Rectangle]:
        """Return portals behind the ends of the arms; for the second corridor only if square."""
        a, b, half = 0.5 * self.width, 0.5 * self.cross_width, 0.5 * self.length
        portals = {
            "west": box(-half - PORTAL_DEPTH, -half, -a, a),
            "east": box(half, half + PORTAL_DEPTH, -a, a),
        }
        if self.angle == _RIGHT:
            far = 0.5 * self.cross_length
            portals["south"] = box(-b, b, -far - PORTAL_DEPTH, -far)
            portals["north"] = box(-b, b, far, far + PORTAL_DEPTH)
        return portals

    def check_shape(self) -> None:
        """Refuse arms that are shorter than the crossing."""
        outline = self._outline()
        for k in _CORNERS:
            (ax, ay), (bx, by), (cx, cy) = outline[k - 1], outline[k], outline[(k + 1) % 12]
            sides = (bx - ax, by - ay), (cx - bx, cy - by)
            turn = sides[0][0] * sides[1][1] - sides[0][1] * sides[1][0]
            if turn >= 0.0:
                raise ValueError("the arms must be longer than the crossing")
            inner = math.pi - abs(math.atan2(turn, _dot(*sides)))
            reach = self.corner_radius / math.tan(0.5 * inner)
            if reach > min(math.hypot(*side) for side in sides) - 1e-9:
                raise ValueError(
                    f"corner_radius {self.corner_radius:g} m is too large for the arms"
                )

    def _corner(self, above: int, beside: int) -> outlines.Point:
        """Return where a side wall of the first corridor meets one of the second."""
        y = 0.5 * above * self.width
        cos, sin = math.cos(self.angle), math.sin(self.angle)
        return (y * cos - 0.5 * beside * self.cross_width) / sin, y

    def _outline(self) -> outlines.Outline:
        """Return the outline, counter-clockwise from the east end."""
        a, b, half = 0.5 * self.width, 0.5 * self.cross_width, 0.5 * self.length
        ux, uy = math.cos(self.angle), math.sin(self.angle)
        vx, vy, far = -uy * b, ux * b, 0.5 * self.cross_length
        if self.angle == _RIGHT:
            ux, vy = 0.0, 0.0
        return (
            (half, -a), (half, a), self._corner(1, -1),
            (far * ux - vx, far * uy - vy), (far * ux + vx, far * uy + vy), self._corner(1, 1),
            (-half, a), (-half, -a), self._corner(-1, 1),
            (vx - far * ux, vy - far * uy), (-vx - far * ux, -vy - far * uy), self._corner(-1, -1),
        )  # fmt: skip


def _dot(one: outlines.Point, other: outlines.Point) -> float:
    return one[0] * other[0] + one[1] * other[1]


CROSSING_CORRIDOR = Component(
    spec=CrossingCorridorSpec,
    build="crowdbot.plugins.environments.place_build:build",
    summary="two corridors that cross at an angle; square or rounded corners",
    examples=(
        {},
        {"angle": math.radians(60), "corner_radius": 1.0, "cross_width": 3.0},
    ),
)
