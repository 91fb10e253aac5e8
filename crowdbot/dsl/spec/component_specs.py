"""The abstract spec of each category of components."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator, Mapping
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal, NamedTuple, Self

from annotated_types import MinLen
from pydantic import BeforeValidator, model_validator

from crowdbot.dsl.spec.default import default
from crowdbot.dsl.spec.quantities import Angle
from crowdbot.dsl.spec.reading_errors import ReadingError
from crowdbot.dsl.spec.spec import ComponentSpec, Rectangle, Spec

if TYPE_CHECKING:
    from crowdbot.dsl.spec.assets import Asset
    from crowdbot.dsl.spec.place import Place


#: Role of a planner. ``floor``: any useful planner beats it; ``ceiling``: it has privileged
#: information; ``baseline``: a fair reference; ``candidate``: all others.
PlannerRole = Literal["floor", "baseline", "ceiling", "adversary", "candidate"]


class Agreement(NamedTuple):
    """Comparison of an imported place with the image it comes from.

    Attributes:
        image: its name.
        cells: number of cells.
        wrong: number of cells that are floor in either the place or the image, not in both.
        left_out: number of cells of pieces that were left out because they are small.
        where: centres of the first wrong cells, world frame, m.
    """

    image: str
    cells: int
    wrong: int
    left_out: int
    where: tuple[tuple[float, float], ...]


class FloorContact(Spec):
    """Grip of wheels on the floor, which is level: there are no ramps."""

    friction: float = default(
        1.0,
        "Friction of a tyre on the floor, static and sliding: a ratio of forces.",
        gt=0.0,
        le=1.5,
    )


class SceneLight(Spec):
    """Light of a scene, in colour images and in the view in three dimensions only."""

    elevation: Angle = default(math.radians(54.2), "Of the sun, rad.", ge=0.0, le=math.pi / 2)
    azimuth: Angle = default(math.radians(-123.7), "Direction in which the sun is, from x, rad.")
    sun: float = default(1.0, "Strength of the sun, as a factor.", ge=0.0, le=3.0)
    ambient: float = default(
        1.0, "Strength of the light from all sides, as a factor.", ge=0.0, le=3.0
    )
    colour: str = default("#ffffff", "Of the sunlight, `#rrggbb`.", pattern=r"^#[0-9a-fA-F]{6}$")
    sky: str = default("#bfd9f2", "Of the sky, `#rrggbb`.", pattern=r"^#[0-9a-fA-F]{6}$")

    @property
    def towards_sun(self) -> tuple[float, float, float]:
        """Return the unit vector to the sun, world frame."""
        flat = math.cos(self.elevation)
        return (
            flat * math.cos(self.azimuth), flat * math.sin(self.azimuth), math.sin(self.elevation),
        )  # fmt: skip


class EnvironmentSpec(ComponentSpec):
    """Abstract environment.

    Its spec has zones and portals; its walls come from the build function.
    """

    category: ClassVar[str] = "environment"
    zones: dict[str, Rectangle] = default({}, "Named areas of the floor.")
    portals: dict[str, Rectangle] = default(
        {}, "Named areas through which people leave and re-enter."
    )

    floor: FloorContact = default(
        FloorContact(),
        "How wheels grip the floor; outside the hash while it is as usual.",
        omitted=True,
    )
    light: SceneLight | None = default(
        None, "Light of the scene; unset: that of a bright day, and outside the hash.", omitted=True
    )

    def place(self) -> Place | None:
        """Return its geometry if the spec knows it; then documents are checked against it.

        Raises:
            InputError: a file of the environment cannot be read.
        """
        return None

    @property
    def periodic_floor(self) -> Rectangle | None:
        """Return the floor (m) if it is periodic: leaving on one side is entering on the other."""
        return None

    def against_image(self) -> Agreement | None:
        """Return its agreement with the image it was made from; None without an image.

        Raises:
            InputError: as in `place`.
        """
        return None

    def extent(self) -> Rectangle | None:
        """Return the environment's bounding box, m; None if the box around its zones is meant.

        Raises:
            InputError: as in `place`.
        """
        return None


#: Parts that a robot's description names.
DescribedPart = Literal["link", "joint"]


class RobotSpec(ComponentSpec):
    """Abstract robot: body, drive and limits."""

    category: ClassVar[str] = "robot"
    #: Supported control modes; the first is the default. For a holonomic robot ``("force",
    #: "kinematic")``.
    controls: ClassVar[tuple[str, ...]] = ("differential_drive", "force", "kinematic")
    #: Radius and track of the wheels, m, that wheel odometry computes with where its spec leaves
    #: them open; None: those of the drive, once the robot is built.
    wheels: ClassVar[tuple[float, float] | None] = None

    @property
    def half_width(self) -> float:
        """Return the radius of a disc around its base that lies within its outline, m.

        `validate` rejects a start or a goal without room for this disc; a larger one is stricter.
        """
        return 0.1

    def described(self) -> Mapping[DescribedPart, Collection[str]]:
        """Return the links and joints of its description; empty if the spec does not know them.

        `validate` checks names in sensors and in `named` against them.
        """
        return {}

    def named(self) -> Iterator[tuple[DescribedPart, str, tuple[str | int, ...]]]:
        """Yield the links and joints that fields of the spec name, with the fields' paths."""
        yield from ()


class SensorSpec(ComponentSpec):
    """Abstract sensor on a robot."""

    category: ClassVar[str] = "sensor"
    link: str | None = default(
        None,
        "Link of the robot's description that it is mounted on, in place of `mount`.",
        omitted=True,
    )
    errors: dict[str, ReadingError] = default(
        {},
        "Named errors that are added to its readings, in the order of their names; "
        "outside the hash while there are none.",
        omitted=True,
    )

    @model_validator(mode="before")
    @classmethod
    def _rest_of_the_mount(cls, data: Any) -> Any:
        """Fill missing numbers of a mount from the sensor's defaults."""
        field = cls.model_fields.get("mount")
        if not isinstance(data, Mapping) or field is None or not isinstance(field.default, Spec):
            return data
        given = data.get("mount")
        if not isinstance(given, Mapping):
            return data
        own = field.default
        return {**data, "mount": {**{n: getattr(own, n) for n in own.model_fields_set}, **given}}

    def on_robot(self, robot: RobotSpec) -> Self:
        """Return the sensor, completed with values from its robot's spec.

        The scenario, and so its hash, holds the result. Values that depend on the built robot or on
        its task are left to the build function.
        """
        del robot
        return self


class NoiseSpec(ComponentSpec):
    """Abstract noise: one error in the readings of a sensor."""

    category: ClassVar[str] = "noise"


def _as_document(value: Any) -> Any:
    """Convert the bare name of a kind to ``{kind: NAME}``; return other values unchanged."""
    is_kind = isinstance(value, str) and not any(c in value for c in ":/\\ ")
    return {"kind": value} if is_kind and not value.endswith((".yaml", ".yml")) else value


#: The planner within a planner's spec (`PlannerSpec.half`): its document, its kind, or a file.
PlannerDocument = Annotated[
    dict[str, Any] | Annotated[str, MinLen(1)], BeforeValidator(_as_document)
]


class PlannerSpec(ComponentSpec):
    """Abstract planner, the thing under test; never part of a scenario."""

    category: ClassVar[str] = "planner"
    role: ClassVar[PlannerRole] = "candidate"
    #: Name of the field with the planner that this one uses, a `PlannerDocument`; its build
    #: function gets that planner, built, as its second argument. Empty: it uses none.
    half: ClassVar[str] = ""

    @property
    def wants(self) -> tuple[str, ...]:
        """Return categories of optional sensors, which the planner reads if the robot has them."""
        return ()


class CrowdPolicySpec(ComponentSpec):
    """Abstract crowd policy: decides where people walk."""

    category: ClassVar[str] = "crowd policy"
    #: True if the policy requires cost functions.
    needs_costs: ClassVar[bool] = False

    @property
    def record(self) -> Asset | None:
        """Return recorded people, used if the crowd names none; None without a record."""
        return None


class CostFunctionSpec(ComponentSpec):
    """Abstract cost function over candidate velocities."""

    category: ClassVar[str] = "cost function"


class MetricSpec(ComponentSpec):
    """Abstract metric with its parameters."""

    category: ClassVar[str] = "metric"


class ObservationSpec(ComponentSpec):
    """Abstract observation: the input of a learned policy, as one vector."""

    category: ClassVar[str] = "observation"
    #: True if it holds what no real sensor measures; a planner that observes so is privileged.
    privileged: ClassVar[bool] = False
    #: True if it holds people whom the people tracker follows in its lidars; in a batch of worlds,
    #: where there is no tracker, it gets all people instead.
    tracks: ClassVar[bool] = False

    @property
    def needs(self) -> tuple[str, ...]:
        """Return the names or categories of the sensors that the observation reads."""
        return ()


class RewardSpec(ComponentSpec):
    """Abstract reward for training a policy, step by step."""

    category: ClassVar[str] = "reward"


CATEGORIES: tuple[type[ComponentSpec], ...] = (
    EnvironmentSpec,
    RobotSpec,
    SensorSpec,
    NoiseSpec,
    PlannerSpec,
    CrowdPolicySpec,
    CostFunctionSpec,
    MetricSpec,
    ObservationSpec,
    RewardSpec,
)
