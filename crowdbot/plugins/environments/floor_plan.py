"""Floor plans from elsewhere: GeoJSON, WKT as of JuPedSim, and occupancy grids of ROS."""

from __future__ import annotations

from importlib import import_module
from pathlib import Path, PurePosixPath
from typing import Annotated, Literal

from annotated_types import Le
from pydantic import Field, model_validator

from crowdbot.dsl import (
    Angle,
    Asset,
    Component,
    EnvironmentSpec,
    NonNegativeLength,
    Place,
    PositiveLength,
    Quantity,
    Rectangle,
)

Format = Literal["auto", "geojson", "wkt", "ros_map"]
_SUFFIXES: dict[str, Format] = {
    ".geojson": "geojson", ".json": "geojson", ".wkt": "wkt", ".txt": "wkt",
    ".yaml": "ros_map", ".yml": "ros_map",
}  # fmt: skip


#: National grids have numbers of this size.
_FarLength = Annotated[float, Quantity("length", most=1e8)]


class FloorPlanSpec(EnvironmentSpec):
    """The walls of a building, from a file.

    Polygons are the floor that people walk on, as in JuPedSim: their holes are solid. Features of
    GeoJSON with ``"kind": "obstacle"`` among their properties are solid, from ``base`` to
    ``height``; lines are thin walls.
    """

    kind: Literal["floor_plan"] = "floor_plan"
    file: Asset | None = Field(
        default=None,
        description="GeoJSON, WKT, or the `map.yaml` of an occupancy grid of ROS; this or `wkt`.",
    )
    image: Asset | None = Field(
        default=None,
        description="Image of an occupancy grid, PGM or PNG; without it the one that the "
        "`map.yaml` names.",
    )
    wkt: str | None = Field(
        default=None, description="The geometry as well-known text; this or `file`."
    )
    format: Format = Field(
        default="auto", description="Of the file; `auto`: by the ending of its name."
    )
    polygons: Literal["walkable", "obstacles"] = Field(
        default="walkable", description="What polygons are that do not say so themselves."
    )
    unit: Literal["m", "cm", "mm", "ft", "in", "deg"] = Field(
        default="m",
        description="Of the numbers in GeoJSON and WKT; `deg`: longitude and latitude.",
    )
    origin: tuple[_FarLength, _FarLength] = Field(
        default=(0.0, 0.0),
        strict=False,
        description="Where the file's (0, 0) lies in the world, m; with `deg`, the longitude and "
        "latitude of the world's (0, 0), as bare numbers.",
    )
    rotation: Angle = Field(
        default=0.0, description="The plan is turned about its (0, 0) by this angle, rad."
    )
    unknown: Literal["solid", "free"] = Field(
        default="solid", description="What cells of a grid are that are neither free nor occupied."
    )
    tolerance: NonNegativeLength | None = Field(
        default=None,
        description="Outlines are simplified by at most this, m; without it 0 in GeoJSON and WKT, "
        "and one cell in a grid.",
    )
    least_area: Annotated[float, Le(100)] = Field(
        default=0.02, ge=0.0, description="Smaller pieces and holes are left out, m^2."
    )
    thickness: PositiveLength = Field(default=0.1, description="Of lines that are walls, m.")
    wall_height: PositiveLength = Field(default=2.5, description="Height of the walls, m.")

    @model_validator(mode="after")
    def _one_source(self) -> FloorPlanSpec:
        if (self.file is None) == (self.wkt is None):
            raise ValueError("write one of 'file' and 'wkt'")
        if self.wkt is not None and self.format not in ("auto", "wkt"):
            raise ValueError(f"format '{self.format}' belongs to a file")
        if self.file is not None and self.format == "auto" and self._suffix not in _SUFFIXES:
            known = ", ".join(sorted(_SUFFIXES))
            raise ValueError(f"the name of file ends in none of {known}; write its 'format'")
        return self

    @property
    def read_as(self) -> Format:
        """The format, found."""
        if self.format != "auto" or self.file is None:
            return "wkt" if self.format == "auto" else self.format
        return _SUFFIXES[self._suffix]

    @property
    def _suffix(self) -> str:
        return "" if self.file is None else PurePosixPath(self.file.path).suffix.lower()

    def beside(self, name: str, file: Path) -> dict[str, str]:
        """The image that a map names, if the document names none."""
        if name != "file" or self.read_as != "ros_map" or self.image is not None:
            return {}
        found = import_module("crowdbot.plugins.environments.ros_map_build").image_of(file)
        return {"image": found} if found else {}

    def place(self) -> Place:
        """The walls of the plan.

        Raises:
            InputError: the file cannot be read, or is not a plan.
        """
        # Polygons need shapely, with numpy: only documents with a plan wait for them.
        build = import_module("crowdbot.plugins.environments.floor_plan_build")
        found: Place = build.place_of(self)
        return found

    def extent(self) -> Rectangle:
        """The box around the plan."""
        points = [p for side in self.place().segments() for p in side]
        xs, ys = [p[0] for p in points], [p[1] for p in points]
        return Rectangle(x=(min(xs), max(xs)), y=(min(ys), max(ys)))


FLOOR_PLAN = Component(
    spec=FloorPlanSpec,
    build="crowdbot.plugins.environments.place_build:build",
    summary="floor plan from GeoJSON, WKT or an occupancy grid of ROS",
    examples=(
        {
            "wkt": "POLYGON ((0 0, 12 0, 12 4, 8 4, 8 9, 0 9, 0 0), "
            "(3 2, 4 2, 4 3, 5 3, 5 4, 3 4, 3 2))"
        },
    ),
)
