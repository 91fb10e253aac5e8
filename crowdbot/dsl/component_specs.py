"""The abstract spec of each category of components."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar, Literal

from pydantic import Field

from crowdbot.dsl.spec import ComponentSpec, Rectangle

if TYPE_CHECKING:
    from crowdbot.dsl.assets import Asset
    from crowdbot.dsl.place import Place


#: What a planner is there for. ``floor``: every planner worth the name beats it; ``ceiling``: it
#: knows more than any other may; ``baseline``: an honest one to measure against; ``candidate``:
#: all others.
PlannerRole = Literal["floor", "baseline", "ceiling", "candidate"]


class EnvironmentSpec(ComponentSpec):
    """Abstract: a place. Its spec has zones and portals; its walls come from the build function."""

    category: ClassVar[str] = "environment"
    zones: dict[str, Rectangle] = Field(default={}, description="Named areas of the floor.")
    portals: dict[str, Rectangle] = Field(
        default={}, description="Named areas through which people leave and re-enter."
    )

    def place(self) -> Place | None:
        """What it is made of, if its spec can tell; then documents are checked against it.

        Raises:
            InputError: a file that it is made of cannot be read.
        """
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


class SensorSpec(ComponentSpec):
    """Abstract: one sensor on a robot."""

    category: ClassVar[str] = "sensor"


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
