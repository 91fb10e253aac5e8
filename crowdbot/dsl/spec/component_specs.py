"""The abstract spec of each category of components."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, ClassVar, Literal, Self

from pydantic import Field, model_validator

from crowdbot.dsl.spec.spec import ComponentSpec, Rectangle, Spec

if TYPE_CHECKING:
    from crowdbot.dsl.spec.assets import Asset
    from crowdbot.dsl.spec.place import Place


#: What a planner is there for. ``floor``: every planner worth the name beats it; ``ceiling``: it
#: knows more than any other may; ``baseline``: an honest one to measure against; ``candidate``:
#: all others.
PlannerRole = Literal["floor", "baseline", "ceiling", "candidate"]


class FloorContact(Spec):
    """How wheels grip the floor. It is level: ramps do not exist."""

    friction: float = Field(
        default=1.0,
        gt=0.0,
        le=1.5,
        description="Friction of a tyre on the floor, static and sliding: a ratio of forces.",
    )


class EnvironmentSpec(ComponentSpec):
    """Abstract: a place. Its spec has zones and portals; its walls come from the build function."""

    category: ClassVar[str] = "environment"
    zones: dict[str, Rectangle] = Field(default={}, description="Named areas of the floor.")
    portals: dict[str, Rectangle] = Field(
        default={}, description="Named areas through which people leave and re-enter."
    )

    floor: FloorContact = Field(
        default=FloorContact(),
        exclude_if=lambda floor: floor == FloorContact(),
        description="How wheels grip the floor; outside the hash while it is as usual.",
    )

    def place(self) -> Place | None:
        """What it is made of, if its spec can tell; then documents are checked against it.

        Raises:
            InputError: a file that it is made of cannot be read.
        """
        return None

    @property
    def periodic_floor(self) -> Rectangle | None:
        """The floor, if people who leave it on one side come in again on the other."""
        return None

    def extent(self) -> Rectangle | None:
        """The box around it where its zones do not say; None where they do.

        Raises:
            InputError: as of `place`.
        """
        return None


class RobotSpec(ComponentSpec):
    """Abstract: a robot's body, drive and limits."""

    category: ClassVar[str] = "robot"
    #: Control modes that fit the drive; the first is the default. A holonomic robot says
    #: ``("force", "kinematic")``.
    controls: ClassVar[tuple[str, ...]] = ("differential_drive", "force", "kinematic")
    #: Radius and track of the wheels, m, that wheel odometry computes with where its spec leaves
    #: them open; None: those of the drive, once the robot is built.
    wheels: ClassVar[tuple[float, float] | None] = None


class SensorSpec(ComponentSpec):
    """Abstract: one sensor on a robot."""

    category: ClassVar[str] = "sensor"

    @model_validator(mode="before")
    @classmethod
    def _rest_of_the_mount(cls, data: Any) -> Any:
        """A mount that says some of its numbers keeps the sensor's own defaults for the others."""
        field = cls.model_fields.get("mount")
        if not isinstance(data, Mapping) or field is None or not isinstance(field.default, Spec):
            return data
        given = data.get("mount")
        if not isinstance(given, Mapping):
            return data
        own = field.default
        return {**data, "mount": {**{n: getattr(own, n) for n in own.model_fields_set}, **given}}

    def on_robot(self, robot: RobotSpec) -> Self:
        """Return the sensor with what it takes from its robot's spec.

        The scenario, and so its hash, holds the result. What depends on the built robot or on its
        task is left to the build function.
        """
        del robot
        return self


class NoiseSpec(ComponentSpec):
    """Abstract: one error in the readings of a sensor."""

    category: ClassVar[str] = "noise"


class PlannerSpec(ComponentSpec):
    """Abstract: the thing under test. Never part of a scenario."""

    category: ClassVar[str] = "planner"
    role: ClassVar[PlannerRole] = "candidate"


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
