"""Two rooms joined by a narrow passage: a doorway and a bottleneck."""

from __future__ import annotations

from typing import Literal

from crowdbot.plugin import (
    Component,
    Length,
    NonNegativeLength,
    Place,
    PositiveLength,
    Rectangle,
    Solid,
    default,
    outlines,
)
from crowdbot.plugins.environments.walkways import PORTAL_DEPTH, WalkwaySpec, box, walkway


class _TwoRoomsSpec(WalkwaySpec):
    """Two rooms joined by a passage along x; the origin is in its middle."""

    room_length: PositiveLength = default(10.0, "Of each room along x, m.")
    width: PositiveLength = default(8.0, "Of both rooms along y, m.")
    opening: PositiveLength = default(1.0, "Width of the way between them, m.")
    offset: Length = default(0.0, "Its middle along y, m.")
    ends: Literal["walls", "open"] = default(
        "walls", "At the far sides of the rooms: walls, or people go on through portals."
    )

    @property
    def depth(self) -> float:
        """Return the length of the passage, m."""
        raise NotImplementedError

    @property
    def cut(self) -> float:
        """Return how far the corners before the passage are cut off, m."""
        return 0.0

    def place(self) -> Place:
        """Return the place: two rooms, and two solids with the passage between them."""
        half, far = 0.5 * self.width, 0.5 * self.depth + self.room_length
        outline: outlines.Outline = ((-far, -half), (far, -half), (far, half), (-far, half))
        ends = (1, 3) if self.ends == "open" else ()
        heights, low, high = (0.0, self.wall_height), self._low, self._high
        return Place(
            faces=walkway(outline, ends, self.wall_height),
            solids=tuple(
                Solid(outline=self._post(wall, edge), heights=heights)
                for wall, edge in ((-half, low), (half, high))
            ),
        )

    def _post(self, wall: float, edge: float) -> outlines.Outline:
        """Return one side of the passage, from the rooms' wall to the passage's edge."""
        before, behind = -0.5 * self.depth, 0.5 * self.depth
        if self.cut == 0.0:
            return ((before, wall), (behind, wall), (behind, edge), (before, edge))
        slant = self.cut if wall < edge else -self.cut
        return (
            (before, wall), (behind, wall), (behind, edge),
            (before + self.cut, edge), (before, edge - slant),
        )  # fmt: skip

    @property
    def _low(self) -> float:
        return self.offset - 0.5 * self.opening

    @property
    def _high(self) -> float:
        return self.offset + 0.5 * self.opening

    def usual_zones(self) -> dict[str, Rectangle]:
        """Return both rooms and the passage between them."""
        half, near = 0.5 * self.width, 0.5 * self.depth
        far = near + self.room_length
        return {
            "before": box(-far, -near, -half, half),
            "opening": box(-near, near, self._low, self._high),
            "beyond": box(near, far, -half, half),
        }

    def usual_portals(self) -> dict[str, Rectangle]:
        """Return portals behind the far sides, where these are open."""
        if self.ends == "walls":
            return {}
        half, far = 0.5 * self.width, 0.5 * self.depth + self.room_length
        return {
            "before": box(-far - PORTAL_DEPTH, -far, -half, half),
            "beyond": box(far, far + PORTAL_DEPTH, -half, half),
        }

    def check_shape(self) -> None:
        """Refuse an opening that does not lie within the wall."""
        room = 0.5 * self.width - self.cut
        if not (self._low > -room and self._high < room):
            raise ValueError("the opening must lie within the width of the rooms")


class DoorwaySpec(_TwoRoomsSpec):
    """Two rooms with a door in the wall between them."""

    kind: Literal["doorway"] = "doorway"
    thickness: PositiveLength = default(0.2, "Of the wall, m.")

    @property
    def depth(self) -> float:
        """Return the thickness of the wall, m."""
        return self.thickness


class BottleneckSpec(_TwoRoomsSpec):
    """A hall that narrows to a passage, as in experiments on the flow through bottlenecks."""

    kind: Literal["bottleneck"] = "bottleneck"
    length: PositiveLength = default(4.0, "Of the passage, m.")
    funnel: NonNegativeLength = default(
        0.0, "How far the corners before the passage are cut off, m."
    )

    @property
    def depth(self) -> float:
        """Return the length of the passage, m."""
        return self.length

    @property
    def cut(self) -> float:
        """Return how far the corners are cut off, m."""
        return self.funnel

    def check_shape(self) -> None:
        """Refuse a funnel that is longer than the passage."""
        super().check_shape()
        if not self.funnel < self.length:
            raise ValueError("funnel must be smaller than length")


DOORWAY = Component(
    spec=DoorwaySpec,
    build="crowdbot.plugins.environments.place_build:build",
    summary="two rooms with a door between them",
    examples=({}, {"opening": 0.9, "offset": -1.5, "ends": "open"}),
)
BOTTLENECK = Component(
    spec=BottleneckSpec,
    build="crowdbot.plugins.environments.place_build:build",
    summary="hall that narrows to a passage",
    examples=({}, {"opening": 1.6, "funnel": 1.0, "ends": "open"}),
)
