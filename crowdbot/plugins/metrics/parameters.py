"""Parameters that several metrics share; each has one meaning everywhere."""

from __future__ import annotations

from typing import Annotated

from annotated_types import Ge
from pydantic import Field

from crowdbot.dsl.quantities import (
    NonNegativeLength,
    NonNegativeSpeed,
    PositiveAngle,
    PositiveDuration,
    PositiveLength,
    PositiveSpeed,
    Quantity,
)

_Number = Annotated[float, Ge(0)]

ZeroTol = Annotated[_Number, Field(description="A denominator up to this counts as zero, SI.")]
LengthTol = Annotated[
    NonNegativeLength, Field(description="A distance up to this counts as zero, m.")
]
JerkZeroTol = Annotated[_Number, Field(description="Jerk up to this counts as zero, SI.")]
JerkWeight = Annotated[_Number, Field(description="Weight of turning against driving, m/(s rad).")]
SamplingTol = Annotated[
    _Number, Field(description="Two runs whose time steps differ by more, relatively, mismatch.")
]
JumpSpeed = Annotated[
    PositiveSpeed,
    Field(description="A faster step is a teleport where none are recorded, m/s."),
]
NeighbourRadius = Annotated[
    PositiveLength, Field(description="Neighbours are no farther, centre to centre, m.")
]
RiskHorizon = Annotated[
    PositiveDuration, Field(description="Contacts farther ahead carry no risk, s.")
]
ContactTol = Annotated[NonNegativeLength, Field(description="Surfaces this close touch, m.")]
RelSpeedTol = Annotated[
    NonNegativeSpeed, Field(description="Slower relative motion counts as none, m/s.")
]
ReleaseGap = Annotated[
    NonNegativeLength,
    Field(description="A contact ends when the surfaces are farther apart, m."),
]
ProximityFloor = Annotated[
    PositiveLength, Field(description="Nearer counts as this near, centre to centre, m.")
]
HeadingMinSpeed = Annotated[NonNegativeSpeed, Field(description="Slower bodies have no heading.")]
OvertakeLateral = Annotated[
    PositiveLength, Field(description="Who passes farther to the side does not overtake, m.")
]
OvertakeAngle = Annotated[
    PositiveAngle, Field(description="Who walks another way by more is not overtaken, rad.")
]
OvertakeEps = Annotated[
    NonNegativeLength, Field(description="Less ahead or behind counts as side by side, m.")
]
Intimate = Annotated[NonNegativeLength, Field(description="Outer edge of the intimate zone, m.")]
Personal = Annotated[NonNegativeLength, Field(description="Outer edge of the personal zone, m.")]
Social = Annotated[NonNegativeLength, Field(description="Outer edge of the social zone, m.")]
Compliance = Annotated[NonNegativeLength, Field(description="A larger gap complies, m.")]
SamplePeriod = Annotated[PositiveDuration, Field(description="Commands are looked at so often, s.")]
StillSpeed = Annotated[NonNegativeSpeed, Field(description="A slower robot does not drive, m/s.")]
StillTurn = Annotated[
    float,
    Ge(0),
    Quantity("angular speed"),
    Field(description="A slower robot does not turn, rad/s."),
]
StallSpeed = Annotated[NonNegativeSpeed, Field(description="A slower robot has stalled, m/s.")]
ProgressWindow = Annotated[PositiveDuration, Field(description="Length of a window, s.")]
ProgressDistance = Annotated[
    PositiveLength, Field(description="Coming nearer by less is no progress, m.")
]
