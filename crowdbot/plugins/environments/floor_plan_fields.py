"""The fields of a floor plan, and the format of its file."""

from __future__ import annotations

from pathlib import PurePosixPath
from typing import Annotated, Literal

from annotated_types import Ge, Le
from pydantic import model_validator

from crowdbot.plugin import (
    Angle,
    Asset,
    EnvironmentSpec,
    NonNegativeLength,
    PositiveLength,
    Quantity,
    default,
)

Format = Literal["auto", "geojson", "wkt", "dxf", "ros_map"]
#: Meaning of a layer of DXF.
Layer = Literal["floor", "walls", "obstacles", "ignore"]
_SUFFIXES: dict[str, Format] = {
    ".geojson": "geojson", ".json": "geojson", ".wkt": "wkt", ".txt": "wkt",
    ".yaml": "ros_map", ".yml": "ros_map", ".dxf": "dxf",
}  # fmt: skip

_IMAGES = (
    ".pgm",
    ".ppm",
    ".pbm",
    ".png",
    ".bmp",
    ".jpg",
    ".jpeg",
    ".gif",
    ".tif",
    ".tiff",
    ".webp",
)

#: Smallest pieces of a plan in GeoJSON or WKT that are kept, m^2.
_LEAST_AREA = 0.02
#: National grids have numbers of this size.
_FarLength = Annotated[float, Quantity("length", most=1e8)]


class FloorPlanFields(EnvironmentSpec):
    """The fields of a floor plan in a document."""

    kind: Literal["floor_plan"] = "floor_plan"
    file: Asset | None = default(
        None, "GeoJSON, WKT, DXF, or the `map.yaml` of an occupancy grid of ROS; this or `wkt`."
    )
    image: Asset | None = default(
        None,
        "Image of an occupancy grid: PGM, PNG, JPEG, BMP, GIF, TIFF, WebP; without it the one "
        "that the `map.yaml` names, or the one of that name beside it where it names an absolute "
        "path.",
    )
    wkt: str | None = default(None, "The geometry as well-known text; this or `file`.")
    format: Format = default("auto", "Of the file; `auto`: by the ending of its name.")
    polygons: Literal["walkable", "obstacles"] = default(
        "walkable", "What polygons are that do not say so themselves."
    )
    unit: Literal["m", "cm", "mm", "ft", "in", "deg"] = default(
        "m",
        "Of the numbers in GeoJSON, WKT and DXF; `deg`: longitude and latitude. DXF "
        "without it: what the drawing declares.",
    )
    origin: tuple[_FarLength, _FarLength] = default(
        (0.0, 0.0),
        "Where the file's (0, 0) lies in the world, m; with `deg`, the longitude and "
        "latitude of the world's (0, 0), as bare numbers.",
        strict=False,
    )
    rotation: Angle = default(0.0, "The plan is turned about its (0, 0) by this angle, rad.")
    layers: dict[str, Layer] = default(
        {},
        "Meaning of the layers of DXF by patterns of their names, the first that fits; "
        "layers that fit none are left out. Without it all layers are read: closed outlines as "
        "`polygons` says, lines as walls. Outside the hash while it is empty.",
        omitted=True,
    )
    unknown: Literal["solid", "free"] = default(
        "solid", "What cells of a grid are that are neither free nor occupied."
    )
    level: str | int | float | None = default(
        None,
        "Storey to read, if the features of GeoJSON name several as `level`, `storey`, "
        "`floor` and the like, or lie at different heights.",
    )
    tolerance: NonNegativeLength | None = default(
        None,
        "Outlines are simplified by at most this, m; without it 0 in GeoJSON and WKT, "
        "and half a cell in a grid, so that no cell's centre changes sides.",
    )
    least_area: Annotated[float, Ge(0), Le(100)] | None = default(
        None,
        "Smaller pieces and holes are left out, with a warning, m^2; without it 0.02 "
        "in GeoJSON and WKT, and 0 in a grid.",
    )
    thickness: PositiveLength = default(0.1, "Of lines that are walls, m.")
    wall_height: PositiveLength = default(2.5, "Height of the walls, m.")

    @model_validator(mode="after")
    def _one_source(self) -> FloorPlanFields:
        if (self.file is None) == (self.wkt is None):
            raise ValueError("write one of 'file' and 'wkt'")
        if self.wkt is not None and self.format not in ("auto", "wkt"):
            raise ValueError(f"format '{self.format}' needs a 'file', not 'wkt'")
        if self.layers and (self.file is None or self.read_as != "dxf"):
            raise ValueError("'layers' is for DXF files only: leave it out")
        if self.file is not None and self.format == "auto" and self._suffix not in _SUFFIXES:
            known = ", ".join(sorted(_SUFFIXES))
            hint = "write its 'format'"
            if self._suffix in _IMAGES:
                hint = "for an image, name the map.yaml beside it, which says where it lies"
            raise ValueError(f"the name of file ends in none of {known}; {hint}")
        return self

    @property
    def read_as(self) -> Format:
        """Return the file's format, from the spec or the file name."""
        if self.format != "auto" or self.file is None:
            return "wkt" if self.format == "auto" else self.format
        return _SUFFIXES[self._suffix]

    @property
    def smallest(self) -> float:
        """Return the area of the smallest pieces that are kept, m^2."""
        if self.least_area is not None:
            return self.least_area
        return 0.0 if self.read_as == "ros_map" else _LEAST_AREA

    @property
    def _suffix(self) -> str:
        return "" if self.file is None else PurePosixPath(self.file.path).suffix.lower()
