"""Kinds of people: how a crowd is mixed, and how each kind differs. Sources: `USUAL_BODIES`."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any, Literal

from annotated_types import Gt
from pydantic import Discriminator, Field, Tag

from crowdbot.dsl.spec.default import default
from crowdbot.dsl.spec.parameters import LengthSample, MassSample, SpeedChoice
from crowdbot.dsl.spec.quantities import NonNegativeLength, PositiveLength, PositiveMass, Quantity
from crowdbot.dsl.spec.spec import Spec
from crowdbot.dsl.spec.unions import AnyOf

#: Appearance of a person for sensors.
AppearanceName = Literal["adult", "child", "elderly", "wheelchair_user", "stroller", "suitcase"]
#: Draws from a normal distribution farther than this many standard deviations are drawn again.
WIDEST = 2.5


class LengthDistribution(Spec):
    """Lengths: a normal distribution, truncated at 2.5 standard deviations."""

    mean: PositiveLength = Field(description="Mean, m.")
    std: NonNegativeLength = Field(description="Standard deviation, m.")


class MassDistribution(Spec):
    """Masses: a normal distribution, truncated at 2.5 standard deviations."""

    mean: PositiveMass = Field(description="Mean, kg.")
    std: Annotated[float, Gt(0), Quantity("mass")] = Field(description="Standard deviation, kg.")


def _tag(value: Any) -> str:
    normal = isinstance(value, LengthDistribution | MassDistribution) or (
        isinstance(value, dict) and bool({"mean", "std"} & value.keys())
    )
    return "<normal>" if normal else "<uniform>"


LengthChoice = Annotated[
    Annotated[LengthSample, Tag("<uniform>")] | Annotated[LengthDistribution, Tag("<normal>")],
    Discriminator(_tag),
    AnyOf(),
]
MassChoice = Annotated[
    Annotated[MassSample, Tag("<uniform>")] | Annotated[MassDistribution, Tag("<normal>")],
    Discriminator(_tag),
    AnyOf(),
]


class PeopleKind(Spec):
    """One kind of people in a mixture; missing fields have the defaults of its look."""

    look: AppearanceName = default("adult", "What sensors see, and usual numbers.")
    share: Annotated[float, Gt(0)] = default(1.0, "Share of the people, on any scale.")
    radius: LengthChoice | None = default(None, "Radius of the disc, m.")
    height: LengthChoice | None = default(None, "Height, m.")
    leg_length: LengthChoice | None = default(
        None, "From the floor to the hip, m; without it 0.53 of the height."
    )
    mass: MassChoice | None = default(None, "Mass in the physics, kg.")
    speed: SpeedChoice | None = default(
        None, "Preferred speed, m/s; without it what others draw times the look's pace."
    )


@dataclass(frozen=True, slots=True)
class UsualBody:
    """Default body of people of one appearance; None: that of `crowd.body`.

    Attributes:
        height, mass: mean and standard deviation, m and kg.
        radius: radius of the contact disc, m.
        pace: preferred speed as a multiple of others' samples.
    """

    height: tuple[float, float]
    mass: tuple[float, float] | None
    radius: float | None
    pace: float


#: Sources: docs/reference/people.md.
USUAL_BODIES: dict[AppearanceName, UsualBody] = {
    "adult": UsualBody((1.70, 0.09), (75.0, 13.0), None, 1.0),
    "child": UsualBody((1.27, 0.06), (25.5, 4.0), 0.20, 1.0),
    "elderly": UsualBody((1.64, 0.08), (71.0, 12.0), None, 0.8),
    "wheelchair_user": UsualBody((1.30, 0.05), (92.0, 14.0), 0.40, 0.6),
    "stroller": UsualBody((1.70, 0.09), (75.0, 13.0), None, 0.9),
    "suitcase": UsualBody((1.70, 0.09), (75.0, 13.0), None, 0.95),
}
