"""Floor plans from files: GeoJSON, JuPedSim's WKT, DXF, and ROS occupancy grids."""

from __future__ import annotations

from pathlib import Path

from crowdbot.plugin import Agreement, Component, Place, Rectangle
from crowdbot.plugins.environments.floor_plan_fields import FloorPlanFields


class FloorPlanSpec(FloorPlanFields):
    """The walls of a building, from a file.

    Polygons are the floor that people walk on, as in JuPedSim: their holes are solid. Features of
    GeoJSON with ``"kind": "obstacle"`` among their properties are solid, from ``base`` to
    ``height``; lines are thin walls.
    """

    def beside(self, name: str, file: Path) -> dict[str, str]:
        """Return the image that a map refers to, if the document names none."""
        if name != "file" or self.read_as != "ros_map" or self.image is not None:
            return {}
        from crowdbot.plugins.environments.ros_map_build import image_of

        found = image_of(file)
        return {"image": found} if found else {}

    def place(self) -> Place:
        """Return the walls of the plan.

        Raises:
            InputError: the file cannot be read, or is not a plan.
        """
        # Polygons need shapely and numpy: import them only for documents with a plan.
        from crowdbot.plugins.environments.floor_plan_build import place_of

        return place_of(self)

    def against_image(self) -> Agreement | None:
        """Return the agreement of the place with the image of an occupancy grid, cell by cell."""
        if self.read_as != "ros_map":
            return None
        from crowdbot.plugins.environments.floor_plan_agreement_build import agreement

        return agreement(self, self.place())

    def extent(self) -> Rectangle:
        """Return the box around the plan."""
        points = [p for side in self.place().segments() for p in side]
        xs, ys = [p[0] for p in points], [p[1] for p in points]
        return Rectangle(x=(min(xs), max(xs)), y=(min(ys), max(ys)))


FLOOR_PLAN = Component(
    spec=FloorPlanSpec,
    build="crowdbot.plugins.environments.place_build:build",
    summary="floor plan from GeoJSON, WKT, DXF or an occupancy grid of ROS",
    examples=(
        {
            "wkt": "POLYGON ((0 0, 12 0, 12 4, 8 4, 8 9, 0 9, 0 0), "
            "(3 2, 4 2, 4 3, 5 3, 5 4, 3 4, 3 2))"
        },
    ),
)
