"""The base of every spec: strict, frozen, no unknown fields, no NaN."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any, ClassVar, Literal

from pydantic import BaseModel, ConfigDict, Field, GetJsonSchemaHandler, model_validator
from pydantic.json_schema import JsonSchemaValue
from pydantic_core import CoreSchema

from crowdbot.dsl.spec.default import default
from crowdbot.dsl.spec.quantities import Angle, Length, PositiveLength


class Spec(BaseModel):
    """A frozen, strict document."""

    model_config = ConfigDict(
        strict=True,
        frozen=True,
        extra="forbid",
        allow_inf_nan=False,
        validate_default=True,
        defer_build=True,  # a document uses few of the installed specs
    )

    @classmethod
    def __get_pydantic_json_schema__(
        cls, core_schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> JsonSchemaValue:
        """Return the schema with the names of fields that are omitted while default."""
        made = handler(core_schema)
        left_out = [name for name, f in cls.model_fields.items() if f.exclude_if is not None]
        if left_out:
            handler.resolve_ref_schema(made)["left_out"] = left_out
        return made


class ComponentSpec(Spec):
    """Spec of a component, distinguished by ``kind``.

    Abstract specs only define a component's category. They refuse documents: the registry builds
    the union of concrete specs.
    """

    category: ClassVar[str] = "component"
    #: Name of the field with this component's parts, if it has any: a map of names to specs of one
    #: other category. Parts are built first, and passed to the build function.
    parts_field: ClassVar[str] = ""
    kind: str = Field(description="Name of the component.")

    @model_validator(mode="before")
    @classmethod
    def _refuse_abstract(cls, value: Any) -> Any:
        abstract = cls.model_fields["kind"].annotation is str  # concrete specs set their kind
        if abstract and not isinstance(value, cls):
            raise ValueError(f"{cls.__name__} is abstract; build the model from a registry")
        return value

    def beside(self, name: str, file: Path) -> Mapping[str, str]:
        """Return field -> path of further assets, which the file of an asset names itself.

        Args:
            name: field of the asset whose file was found.
            file: location of this file.
        """
        del name, file
        return {}

    def parts(self) -> Mapping[str, ComponentSpec]:
        """Return specs that are built before this one, by name; empty if there are none."""
        found: Mapping[str, ComponentSpec] = (
            getattr(self, self.parts_field) if self.parts_field else {}
        )
        return found


class Mount(Spec):
    """Pose of a sensor on the robot, from base_link: x forward, y left, z up (REP-103)."""

    x: Length = default(0.0, "Forward offset, m.")
    y: Length = default(0.0, "Offset to the left, m.")
    z: Length = default(0.0, "Height above base_link, m.")
    yaw: Angle = default(0.0, "Heading, rad, counter-clockwise.")


class TiltableMount(Mount):
    """Pose of a sensor that may be tilted.

    Rotated first by roll about x, then by pitch about y, then by yaw about z, as in URDF: with a
    positive pitch it looks down, with a roll of half a turn it hangs upside down.
    """

    roll: Angle = default(
        0.0, "About its own x, rad; positive: the left side goes up.", omitted=True
    )
    pitch: Angle = default(0.0, "About its y, rad; positive: it looks down.", omitted=True)

    @model_validator(mode="before")
    @classmethod
    def _level(cls, value: Any) -> Any:
        """Convert a `Mount` given in Python to one with zero roll and pitch."""
        if isinstance(value, Mount) and not isinstance(value, cls):
            return {name: getattr(value, name) for name in value.model_fields_set}
        return value


class Rectangle(Spec):
    """An axis-aligned rectangle of the floor, world frame, m."""

    x: tuple[Length, Length] = Field(strict=False, description="From, to; m.")
    y: tuple[Length, Length] = Field(strict=False, description="From, to; m.")

    @model_validator(mode="after")
    def _ordered(self) -> Rectangle:
        if not (self.x[0] < self.x[1] and self.y[0] < self.y[1]):
            raise ValueError("each pair must go from the smaller to the larger number")
        return self

    @property
    def area(self) -> float:
        """Return the area, m^2."""
        return (self.x[1] - self.x[0]) * (self.y[1] - self.y[0])

    @property
    def polygon(self) -> tuple[tuple[float, float], ...]:
        """Return the corners, counter-clockwise, m."""
        (x0, x1), (y0, y1) = self.x, self.y
        return ((x0, y0), (x1, y0), (x1, y1), (x0, y1))

    def contains(self, x: float, y: float) -> bool:
        """Return True if a point lies inside or on the border."""
        return self.x[0] <= x <= self.x[1] and self.y[0] <= y <= self.y[1]


class Range(Spec):
    """Range of a cost function, and whether distances are between centres or surfaces.

    A bare length is the short form for a range between centres.
    """

    model_config = ConfigDict(json_schema_extra={"short": "value"})

    value: PositiveLength = default(5.0, "Distance, m.")
    measure: Literal["centre", "surface"] = default(
        "centre", "Between centres, or between the surfaces of the discs."
    )

    @model_validator(mode="before")
    @classmethod
    def _short_form(cls, value: Any) -> Any:
        return {"value": value} if isinstance(value, int | float | str) else value

    def cost_params(self) -> dict[str, float]:
        """Return the fields of `CostParams`: range, m; from_surface, 1 between surfaces, else 0."""
        return {"range": self.value, "from_surface": float(self.measure == "surface")}
