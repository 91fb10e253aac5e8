"""Robots from a URDF: without Python code; drive, wheels and outline are given in the document."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from typing import Annotated, ClassVar, Literal

from annotated_types import Gt, MinLen
from pydantic import Field, model_validator

from crowdbot.plugin import (
    Asset,
    Component,
    DescribedPart,
    InputError,
    Length,
    NonNegativeLength,
    PositiveAcceleration,
    PositiveAngularAcceleration,
    PositiveAngularSpeed,
    PositiveDuration,
    PositiveForce,
    PositiveLength,
    PositiveSpeed,
    RobotSpec,
    Spec,
    default,
)
from crowdbot.plugins.robots.urdf_names import urdf_names, weightless

Torque = Annotated[float, Gt(0)]
WheelJoints = str | Annotated[tuple[str, ...], Field(strict=False), MinLen(1)]


class DiscBody(Spec):
    """An upright cylinder around the base."""

    radius: PositiveLength = Field(description="m.")
    height: PositiveLength = Field(description="Of the whole robot, m.")


class BoxBody(Spec):
    """An upright box, which may be off the base's centre."""

    length: PositiveLength = Field(description="Along x, m.")
    width: PositiveLength = Field(description="Along y, m.")
    height: PositiveLength = Field(description="Of the whole robot, m.")
    x: Length = default(0.0, "Its centre ahead of the base, m.")


class Caster(Spec):
    """A ball that slides on the floor."""

    x: Length = Field(description="From the base, m.")
    y: Length = default(0.0, "From the base, m.")
    radius: PositiveLength = Field(description="m.")


class UrdfFields(RobotSpec):
    """Fields of robots with a URDF, on two driven wheels or holonomic."""

    file: Asset = Field(description="The URDF; joints that are not wheels are held.")
    base: str = default("base_link", "Link on which sensors are mounted: x ahead, z up.")
    positions: dict[str, float] = default(
        {},
        "Where joints are held, such as those of an arm: rad, of prismatic ones m; "
        "the others are held at zero.",
        omitted=True,
    )
    disc: DiscBody | None = default(None, "Outline that people avoid and touch.")
    box: BoxBody | None = default(None, "The same, in place of `disc`.")
    clearance: NonNegativeLength = default(0.03, "Lower edge of the outline above the floor, m.")
    meshes: Literal["boxes", "hulls", "pieces"] = default(
        "boxes",
        "What collision meshes beside the file become: boxes around them, convex "
        "hulls, or convex pieces, for which the extra `meshes` is needed; else they are hulls.",
        omitted=True,
    )
    casters: dict[str, Caster] = default({}, "Named casters.")
    max_speed: PositiveSpeed = Field(description="Largest |v|, m/s.")
    max_yaw_rate: PositiveAngularSpeed = Field(description="Largest |w|, rad/s.")
    max_acceleration: PositiveAcceleration = Field(description="Slew of v, m/s^2.")
    max_yaw_acceleration: PositiveAngularAcceleration = Field(description="Slew of w, rad/s^2.")
    command_timeout: PositiveDuration = default(
        0.6, "The robot stops after this long without a command, s."
    )

    @model_validator(mode="after")
    def _one_outline(self) -> UrdfFields:
        if (self.disc is None) == (self.box is None):
            raise ValueError("give either 'disc' or 'box'")
        return self

    @model_validator(mode="after")
    def _parts_weigh(self) -> UrdfFields:
        if not self.file.is_found:
            return self
        try:
            found = sorted(weightless(self.file.file, self.base, self.turning))
        except (InputError, OSError):  # told with the file
            return self
        if found:
            raise ValueError(
                f"link '{found[0]}' weighs nothing, with all that is fixed to it; a part that "
                "moves needs <inertial> with <mass> and <inertia>"
            )
        return self

    @property
    def turning(self) -> Collection[str]:
        """Return the joints of wheels that turn; others slide."""
        return ()

    def described(self) -> Mapping[DescribedPart, Collection[str]]:
        """Return the names of links and joints; empty if the file has to be converted first."""
        if not self.file.is_found:
            return {}
        try:
            return urdf_names(self.file.file)
        except (InputError, OSError):  # told with the file
            return {}

    def named(self) -> Iterator[tuple[DescribedPart, str, tuple[str | int, ...]]]:
        """Yield the base link, and the fixed and driven joints."""
        yield "link", self.base, ("base",)
        for joint in self.positions:
            yield "joint", joint, ("positions", joint)

    @property
    def height(self) -> float:
        """Return the height of the whole robot, m."""
        body = self.disc or self.box
        assert body is not None
        return body.height

    @property
    def half_width(self) -> float:
        """Return the radius of the disc within its outline around the base, m."""
        if self.disc is not None:
            return self.disc.radius
        assert self.box is not None
        along = 0.5 * self.box.length - abs(self.box.x)
        return max(0.0, min(0.5 * self.box.width, along))


class DrivenWheels(Spec):
    """The driven wheels of a differential drive: one of each side, or several (skid steer)."""

    left: WheelJoints = Field(
        description="Joint of the left wheel, or a list of all driven ones there."
    )
    right: WheelJoints = Field(description="The same on the right.")
    radius: PositiveLength = Field(description="Of all wheels, m.")
    effort: Torque = Field(description="Largest torque of each motor, N m.")

    @property
    def sides(self) -> tuple[tuple[str, ...], tuple[str, ...]]:
        """Return the joints of the left and of the right wheels."""
        left, right = ((x,) if isinstance(x, str) else x for x in (self.left, self.right))
        return left, right


class UrdfSpec(UrdfFields):
    """A robot on two driven wheels, from its URDF.

    Wheels touch the floor as spheres, collision meshes become boxes, and joints that are not driven
    are held; a run says once what was simplified.
    """

    kind: Literal["urdf"] = "urdf"
    drive: DrivenWheels = Field(description="The driven wheels of a differential drive.")

    @property
    def turning(self) -> Collection[str]:
        """Return the joints of the wheels that turn, one of each side."""
        return [side[0] for side in self.drive.sides]

    def named(self) -> Iterator[tuple[DescribedPart, str, tuple[str | int, ...]]]:
        """Yield the base, and the joints that are held and driven."""
        yield from super().named()
        for side, joints in zip(("left", "right"), self.drive.sides, strict=True):
            several = not isinstance(getattr(self.drive, side), str)
            for n, joint in enumerate(joints):
                yield "joint", joint, ("drive", side, *((n,) if several else ()))


class OmniWheels(Spec):
    """The wheels of a holonomic drive, which slide; a force moves the base."""

    joints: tuple[str, ...] = default((), "Joints of the wheels, which do not turn.", strict=False)
    radius: PositiveLength = Field(description="Of the wheels, m.")
    max_force: PositiveForce = Field(description="Largest horizontal force, N.")
    max_torque: Torque = Field(description="Largest torque about the vertical, N m.")
    base_height: NonNegativeLength | None = default(
        None, "Height of the base above the floor, m; unset: that at which the lowest wheel stands."
    )


class HolonomicUrdfSpec(UrdfFields):
    """A robot that also goes sideways, from its URDF."""

    controls: ClassVar[tuple[str, ...]] = ("force", "kinematic")
    kind: Literal["urdf_holonomic"] = "urdf_holonomic"
    drive: OmniWheels = Field(
        description="The wheels of a holonomic drive, which slide; a force moves the base."
    )

    def named(self) -> Iterator[tuple[DescribedPart, str, tuple[str | int, ...]]]:
        """Yield the base link, the fixed joints, and those of the wheels."""
        yield from super().named()
        for n, joint in enumerate(self.drive.joints):
            yield "joint", joint, ("drive", "joints", n)


#: Fields of both examples, a cart that is part of crowdbot.
_CART = {
    "file": "builtin:robots/cart.urdf",
    "disc": {"radius": 0.25, "height": 0.5},
    "casters": {"front": {"x": 0.18, "radius": 0.03}, "rear": {"x": -0.18, "radius": 0.03}},
    "max_speed": 0.8,
    "max_yaw_rate": 2.0,
    "max_acceleration": 1.0,
    "max_yaw_acceleration": 3.0,
}
_JOINTS = ("left_wheel_joint", "right_wheel_joint")

URDF = Component(
    spec=UrdfSpec,
    summary="any robot on two driven wheels, from its URDF",
    examples=(
        {
            **_CART,
            "drive": {"left": _JOINTS[0], "right": _JOINTS[1], "radius": 0.08, "effort": 4.0},
        },
    ),
)
URDF_HOLONOMIC = Component(
    spec=HolonomicUrdfSpec,
    build="crowdbot.plugins.robots.urdf_build:build_holonomic",
    summary="any robot that also goes sideways, from its URDF",
    examples=(
        {
            **_CART,
            "drive": {
                "joints": list(_JOINTS),
                "radius": 0.08,
                "max_force": 40.0,
                "max_torque": 8.0,
            },
        },
    ),
)
