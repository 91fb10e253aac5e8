"""Shared parameters of metrics, each with one meaning and one default.

The default is part of the type: ``jump_speed: JumpSpeed`` in a spec is 10 m/s by default.
"""

from __future__ import annotations

import math
from typing import Annotated

from annotated_types import Ge, Le

from crowdbot.plugin import (
    MetricSpec,
    NonNegativeDuration,
    NonNegativeLength,
    NonNegativeSpeed,
    PositiveAcceleration,
    PositiveAngle,
    PositiveDuration,
    PositiveLength,
    PositiveSpeed,
    Quantity,
    default,
)

_Number = Annotated[float, Ge(0)]

ZeroTol = Annotated[_Number, default(1e-9, "A denominator up to this counts as zero, SI.")]
LengthTol = Annotated[NonNegativeLength, default(1e-6, "A distance up to this counts as zero, m.")]
JerkZeroTol = Annotated[_Number, default(1e-6, "Jerk up to this counts as zero, SI.")]
JerkWeight = Annotated[_Number, default(1.0, "Weight of turning against driving, m/(s rad).")]
SamplingTol = Annotated[
    _Number,
    default(0.01, "Two runs whose time steps differ by more, relatively, mismatch."),
]
JumpSpeed = Annotated[
    PositiveSpeed,
    default(10.0, "A faster step is a teleport where none are recorded, m/s."),
]
NeighbourRadius = Annotated[
    PositiveLength,
    default(3.0, "Neighbours are no farther, centre to centre, m."),
]
EvasionReach = Annotated[
    PositiveLength,
    default(2.0, "People farther off, centre to centre, do not evade, m."),
]
RiskHorizon = Annotated[PositiveDuration, default(5.0, "Contacts farther ahead carry no risk, s.")]
ContactTol = Annotated[NonNegativeLength, default(1e-9, "Surfaces this close touch, m.")]
RelSpeedTol = Annotated[
    NonNegativeSpeed,
    default(1e-6, "Slower relative motion counts as none, m/s."),
]
ReleaseGap = Annotated[
    NonNegativeLength,
    default(0.05, "A contact ends when the surfaces are farther apart, m."),
]
ProximityFloor = Annotated[
    PositiveLength,
    default(0.1, "Nearer counts as this near, centre to centre, m."),
]
HeadingMinSpeed = Annotated[NonNegativeSpeed, default(0.1, "Slower bodies have no heading.")]
OvertakeLateral = Annotated[
    PositiveLength,
    default(3.0, "People who pass farther to the side do not overtake, m."),
]
OvertakeAngle = Annotated[
    PositiveAngle,
    default(math.pi / 4, "People whose direction differs by more are not overtaken, rad."),
]
OvertakeEps = Annotated[
    NonNegativeLength,
    default(1e-6, "Less ahead or behind counts as side by side, m."),
]
Intimate = Annotated[NonNegativeLength, default(0.45, "Outer edge of the intimate zone, m.")]
Personal = Annotated[NonNegativeLength, default(1.2, "Outer edge of the personal zone, m.")]
Social = Annotated[NonNegativeLength, default(3.6, "Outer edge of the social zone, m.")]
Compliance = Annotated[NonNegativeLength, default(0.5, "A larger gap complies, m.")]
SamplePeriod = Annotated[
    PositiveDuration, default(0.15, "Period at which commands are compared, s.")
]
StillSpeed = Annotated[NonNegativeSpeed, default(1e-3, "A slower robot does not drive, m/s.")]
StillTurn = Annotated[
    float,
    Ge(0),
    Quantity("angular speed"),
    default(1e-2, "A slower robot does not turn, rad/s."),
]
StallSpeed = Annotated[NonNegativeSpeed, default(0.05, "A slower robot has stalled, m/s.")]
ProgressWindow = Annotated[PositiveDuration, default(5.0, "Length of a window, s.")]
ProgressDistance = Annotated[
    PositiveLength, default(0.1, "Coming nearer by less is not progress, m.")
]
AwaySpeed = Annotated[
    NonNegativeSpeed,
    default(0.05, "The goal recedes when it does so faster, m/s."),
]
FaultSpeed = Annotated[
    NonNegativeSpeed,
    default(0.05, "A robot that comes nearer more slowly is not at fault, m/s."),
]
FaultReaction = Annotated[
    NonNegativeDuration,
    default(0.3, "The robot may go on this long once a contact is foreseeable, s."),
]
FaultBraking = Annotated[
    PositiveAcceleration,
    default(1.0, "It must brake with this deceleration then, m/s²."),
]
FaultMargin = Annotated[
    NonNegativeLength,
    default(0.1, "People who are going to pass closer may be touched, m."),
]
ForcedPush = Annotated[
    _Number,
    default(0.25, "People pushed by more, per mass, are driven aside, J/kg."),
]
ForcedFactor = Annotated[
    float,
    Ge(0),
    Le(1),
    default(0.5, "Share of the score that is left for each person driven aside."),
]
WallFactor = Annotated[
    float,
    Ge(0),
    Le(1),
    default(0.5, "Share of the score that is left for each contact with a wall."),
]
ForcedHeadway = Annotated[
    PositiveDuration,
    default(0.5, "People who, standing, would be reached sooner are forced away, s."),
]
TimeGap = Annotated[
    PositiveDuration,
    default(1.0, "People who, standing, would be reached sooner are crowded, s."),
]
DemandTime = Annotated[
    PositiveDuration,
    default(2.0, "Longest time before the smallest gap that people evade in, s."),
]
UsualAcceleration = Annotated[
    PositiveAcceleration,
    default(0.5, "People accelerate this much anyway; only more counts, m/s²."),
]
DemandRoom = Annotated[
    NonNegativeLength,
    default(0.5, "Gap that people have to get beside the robot, m."),
]
Room = Annotated[PositiveLength, default(0.75, "A person with this gap has room, m.")]
LeastWay = Annotated[PositiveLength, default(1.0, "Less way counts as this much, m.")]
SameStart = Annotated[
    NonNegativeLength,
    default(0.1, "People farther from where they would be are left out, m."),
]
AfterMeeting = Annotated[
    NonNegativeDuration,
    default(2.0, "A meeting ends this long after the robot is out of reach, s."),
]
MuchDisplacement = Annotated[
    NonNegativeLength, default(0.5, "People displaced by more are counted, m.")
]
MuchDelay = Annotated[NonNegativeDuration, default(0.5, "People delayed by more are counted, s.")]
DtwThreshold = Annotated[
    PositiveLength,
    default(1.0, "Paths this far apart on average score 1/e, m."),
]
DtwSpacing = Annotated[PositiveLength, default(0.25, "Distance of points on both paths, m.")]


class ContactMetricSpec(MetricSpec):
    """Abstract metric of contacts."""

    contact_tol: ContactTol
    release_gap: ReleaseGap
    jump_speed: JumpSpeed


class HorizonMetricSpec(MetricSpec):
    """Abstract metric of contacts that are foreseen within a horizon."""

    risk_horizon: RiskHorizon
    contact_tol: ContactTol
    rel_speed_tol: RelSpeedTol
    jump_speed: JumpSpeed
