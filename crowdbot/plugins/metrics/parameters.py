"""Shared parameters of metrics, each with one meaning and one default.

The default is part of the type: ``jump_speed: JumpSpeed`` in a spec is 10 m/s by default.
"""

from __future__ import annotations

import math
from typing import Annotated

from annotated_types import Ge, Le
from pydantic import Field

from crowdbot.plugin import (
    NonNegativeDuration,
    NonNegativeLength,
    NonNegativeSpeed,
    PositiveAcceleration,
    PositiveAngle,
    PositiveDuration,
    PositiveLength,
    PositiveSpeed,
    Quantity,
)

_Number = Annotated[float, Ge(0)]

ZeroTol = Annotated[
    _Number, Field(default=1e-9, description="A denominator up to this counts as zero, SI.")
]
LengthTol = Annotated[
    NonNegativeLength, Field(default=1e-6, description="A distance up to this counts as zero, m.")
]
JerkZeroTol = Annotated[
    _Number, Field(default=1e-6, description="Jerk up to this counts as zero, SI.")
]
JerkWeight = Annotated[
    _Number, Field(default=1.0, description="Weight of turning against driving, m/(s rad).")
]
SamplingTol = Annotated[
    _Number,
    Field(
        default=0.01, description="Two runs whose time steps differ by more, relatively, mismatch."
    ),
]
JumpSpeed = Annotated[
    PositiveSpeed,
    Field(default=10.0, description="A faster step is a teleport where none are recorded, m/s."),
]
NeighbourRadius = Annotated[
    PositiveLength,
    Field(default=3.0, description="Neighbours are no farther, centre to centre, m."),
]
EvasionReach = Annotated[
    PositiveLength,
    Field(default=2.0, description="People farther off, centre to centre, do not evade, m."),
]
RiskHorizon = Annotated[
    PositiveDuration, Field(default=5.0, description="Contacts farther ahead carry no risk, s.")
]
ContactTol = Annotated[
    NonNegativeLength, Field(default=1e-9, description="Surfaces this close touch, m.")
]
RelSpeedTol = Annotated[
    NonNegativeSpeed,
    Field(default=1e-6, description="Slower relative motion counts as none, m/s."),
]
ReleaseGap = Annotated[
    NonNegativeLength,
    Field(default=0.05, description="A contact ends when the surfaces are farther apart, m."),
]
ProximityFloor = Annotated[
    PositiveLength,
    Field(default=0.1, description="Nearer counts as this near, centre to centre, m."),
]
HeadingMinSpeed = Annotated[
    NonNegativeSpeed, Field(default=0.1, description="Slower bodies have no heading.")
]
OvertakeLateral = Annotated[
    PositiveLength,
    Field(default=3.0, description="People who pass farther to the side do not overtake, m."),
]
OvertakeAngle = Annotated[
    PositiveAngle,
    Field(
        default=math.pi / 4,
        description="People whose direction differs by more are not overtaken, rad.",
    ),
]
OvertakeEps = Annotated[
    NonNegativeLength,
    Field(default=1e-6, description="Less ahead or behind counts as side by side, m."),
]
Intimate = Annotated[
    NonNegativeLength, Field(default=0.45, description="Outer edge of the intimate zone, m.")
]
Personal = Annotated[
    NonNegativeLength, Field(default=1.2, description="Outer edge of the personal zone, m.")
]
Social = Annotated[
    NonNegativeLength, Field(default=3.6, description="Outer edge of the social zone, m.")
]
Compliance = Annotated[
    NonNegativeLength, Field(default=0.5, description="A larger gap complies, m.")
]
SamplePeriod = Annotated[
    PositiveDuration, Field(default=0.15, description="Period at which commands are compared, s.")
]
StillSpeed = Annotated[
    NonNegativeSpeed, Field(default=1e-3, description="A slower robot does not drive, m/s.")
]
StillTurn = Annotated[
    float,
    Ge(0),
    Quantity("angular speed"),
    Field(default=1e-2, description="A slower robot does not turn, rad/s."),
]
StallSpeed = Annotated[
    NonNegativeSpeed, Field(default=0.05, description="A slower robot has stalled, m/s.")
]
ProgressWindow = Annotated[
    PositiveDuration, Field(default=5.0, description="Length of a window, s.")
]
ProgressDistance = Annotated[
    PositiveLength, Field(default=0.1, description="Coming nearer by less is not progress, m.")
]
AwaySpeed = Annotated[
    NonNegativeSpeed,
    Field(default=0.05, description="The goal recedes when it does so faster, m/s."),
]
FaultSpeed = Annotated[
    NonNegativeSpeed,
    Field(default=0.05, description="A robot that comes nearer more slowly is not at fault, m/s."),
]
FaultReaction = Annotated[
    NonNegativeDuration,
    Field(
        default=0.3, description="The robot may go on this long once a contact is foreseeable, s."
    ),
]
FaultBraking = Annotated[
    PositiveAcceleration,
    Field(default=1.0, description="It must brake with this deceleration then, m/s²."),
]
FaultMargin = Annotated[
    NonNegativeLength,
    Field(default=0.1, description="People who are going to pass closer may be touched, m."),
]
ForcedPush = Annotated[
    _Number,
    Field(default=0.25, description="People pushed by more, per mass, are driven aside, J/kg."),
]
ForcedFactor = Annotated[
    float,
    Ge(0),
    Le(1),
    Field(default=0.5, description="Share of the score that is left for each person driven aside."),
]
WallFactor = Annotated[
    float,
    Ge(0),
    Le(1),
    Field(default=0.5, description="Share of the score that is left for each contact with a wall."),
]
ForcedHeadway = Annotated[
    PositiveDuration,
    Field(
        default=0.5, description="People who, standing, would be reached sooner are forced away, s."
    ),
]
TimeGap = Annotated[
    PositiveDuration,
    Field(default=1.0, description="People who, standing, would be reached sooner are crowded, s."),
]
DemandTime = Annotated[
    PositiveDuration,
    Field(default=2.0, description="Longest time before the smallest gap that people evade in, s."),
]
UsualAcceleration = Annotated[
    PositiveAcceleration,
    Field(default=0.5, description="People accelerate this much anyway; only more counts, m/s²."),
]
DemandRoom = Annotated[
    NonNegativeLength,
    Field(default=0.5, description="Gap that people have to get beside the robot, m."),
]
Room = Annotated[
    PositiveLength, Field(default=0.75, description="A person with this gap has room, m.")
]
LeastWay = Annotated[
    PositiveLength, Field(default=1.0, description="Less way counts as this much, m.")
]
SameStart = Annotated[
    NonNegativeLength,
    Field(default=0.1, description="People farther from where they would be are left out, m."),
]
AfterMeeting = Annotated[
    NonNegativeDuration,
    Field(default=2.0, description="A meeting ends this long after the robot is out of reach, s."),
]
MuchDisplacement = Annotated[
    NonNegativeLength, Field(default=0.5, description="People displaced by more are counted, m.")
]
MuchDelay = Annotated[
    NonNegativeDuration, Field(default=0.5, description="People delayed by more are counted, s.")
]
DtwThreshold = Annotated[
    PositiveLength,
    Field(default=1.0, description="Paths this far apart on average score 1/e, m."),
]
DtwSpacing = Annotated[
    PositiveLength, Field(default=0.25, description="Distance of points on both paths, m.")
]
