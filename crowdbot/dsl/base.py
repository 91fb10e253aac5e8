"""The ground that every spec stands on: strict, frozen, no unknown field, no NaN."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar, Literal

from pydantic import BaseModel, ConfigDict, Field, model_validator

from crowdbot.dsl.quantities import Angle, Length, PositiveLength

if TYPE_CHECKING:
    from crowdbot.dsl.assets import Asset


class Spec(BaseModel):
    """A frozen, strict document."""

    model_config = ConfigDict(
        strict=True,
        frozen=True,
        extra="forbid",
        allow_inf_nan=False,
        validate_default=True,
        defer_build=True,  # a document uses few of the specs that are installed
    )


class ComponentSpec(Spec):
    """Spec of something pluggable, told apart by ``kind``.

    The abstract specs below only say which category a component belongs to. They refuse
    documents: the union of concrete specs is assembled from the registry.
    """

    category: ClassVar[str] = "component"
    kind: str = Field(description="Name of the component.")

    @model_validator(mode="before")
    @classmethod
    def _refuse_abstract(cls, value: Any) -> Any:
        abstract = cls.model_fields["kind"].annotation is str  # concrete ones name theirs
        if abstract and not isinstance(value, cls):
            raise ValueError(f"{cls.__name__} is abstract; build the model from a registry")
        return value


class Mount(Spec):
    """Pose of a sensor on the robot, from base_link: x forward, y left, z up (REP-103)."""

    x: Length = Field(default=0.0, description="Forward offset, m.")
    y: Length = Field(default=0.0, description="Offset to the left, m.")
    z: Length = Field(default=0.0, description="Height above base_link, m.")
    yaw: Angle = Field(default=0.0, description="Heading, rad, counter-clockwise.")


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
        """Area, m^2."""
        return (self.x[1] - self.x[0]) * (self.y[1] - self.y[0])

    @property
    def polygon(self) -> tuple[tuple[float, float], ...]:
        """The corners, counter-clockwise, m."""
        (x0, x1), (y0, y1) = self.x, self.y
        return ((x0, y0), (x1, y0), (x1, y1), (x0, y1))

    def contains(self, x: float, y: float) -> bool:
        """Whether a point lies inside or on the border."""
        return self.x[0] <= x <= self.x[1] and self.y[0] <= y <= self.y[1]


class Range(Spec):
    """How far a cost function looks, and from where to where it measures.

    A bare length is short for a range between centres.
    """

    model_config = ConfigDict(json_schema_extra={"short": "value"})

    value: PositiveLength = Field(default=5.0, description="Distance, m.")
    measure: Literal["centre", "surface"] = Field(
        default="centre", description="Between centres, or between the surfaces of the discs."
    )

    @model_validator(mode="before")
    @classmethod
    def _short_form(cls, value: Any) -> Any:
        return {"value": value} if isinstance(value, int | float | str) else value


class EnvironmentSpec(ComponentSpec):
    """Abstract: a place. Its zones and portals are words; its walls are built."""

    category: ClassVar[str] = "environment"
    zones: dict[str, Rectangle] = Field(default={}, description="Named areas of the floor.")
    portals: dict[str, Rectangle] = Field(
        default={}, description="Named areas through which people leave and re-enter."
    )


class RobotSpec(ComponentSpec):
    """Abstract: a robot's body, drive and limits."""

    category: ClassVar[str] = "robot"
    #: Control modes that fit the drive; the first is the default. A holonomic robot says
    #: ``("force", "kinematic")``.
    controls: ClassVar[tuple[str, ...]] = ("differential_drive", "force", "kinematic")


class SensorSpec(ComponentSpec):
    """Abstract: one sensor on a robot."""

    category: ClassVar[str] = "sensor"


class NoiseSpec(ComponentSpec):
    """Abstract: one error in the readings of a sensor."""

    category: ClassVar[str] = "noise"


class PlannerSpec(ComponentSpec):
    """Abstract: the thing under test. Never part of a scenario."""

    category: ClassVar[str] = "planner"


class CrowdPolicySpec(ComponentSpec):
    """Abstract: how people decide where to walk."""

    category: ClassVar[str] = "crowd policy"
    #: Whether the policy is nothing without cost functions.
    needs_costs: ClassVar[bool] = False

    @property
    def record(self) -> Asset | None:
        """Recorded people who walk where the crowd names nobody; None without a record."""
        return None


class CostFunctionSpec(ComponentSpec):
    """Abstract: one cost over candidate velocities."""

    category: ClassVar[str] = "cost function"


class MetricSpec(ComponentSpec):
    """Abstract: one metric and its parameters."""

    category: ClassVar[str] = "metric"


CATEGORIES: tuple[type[ComponentSpec], ...] = (
    EnvironmentSpec,
    RobotSpec,
    SensorSpec,
    NoiseSpec,
    PlannerSpec,
    CrowdPolicySpec,
    CostFunctionSpec,
    MetricSpec,
)
