"""Synthetic users: each steers for the goal and around people, with one impairment."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, Literal

from annotated_types import Ge, Gt, Le
from pydantic import Field

from crowdbot.plugin import (
    Angle,
    Component,
    Length,
    NonNegativeDuration,
    NonNegativeLength,
    PositiveAngle,
    PositiveAngularSpeed,
    PositiveDuration,
    PositiveFrequency,
    PositiveLength,
    PositiveSpeed,
    SensorSpec,
    default,
)

#: A position x, y, m.
Goal = Annotated[tuple[Length, Length], Field(strict=False)]
Share = Annotated[float, Ge(0), Le(1)]
#: A user's longest delay; what the stick did meanwhile is remembered.
Delay = Annotated[NonNegativeDuration, Le(3.0)]

_BUILD = "crowdbot.plugins.sensors.users.users_build:build"


class UserSpec(SensorSpec):
    """Reading: v (m/s), w (rad/s), the velocity that a synthetic user commands.

    Direction by the steering dynamics of Fajen and Warren, speed by the gap ahead (Moussaïd).
    """

    rate: PositiveFrequency = default(16.0, "Readings per second, Hz.", le=128)
    goal: Goal | None = default(None, "Where the user wants to go, m; unset: the task's goal.")
    max_speed: PositiveSpeed | None = default(
        None, "Speed of the stick fully ahead, m/s; unset: the robot's."
    )
    max_yaw_rate: PositiveAngularSpeed | None = default(
        None, "Yaw rate of the stick fully aside, rad/s; unset: the robot's."
    )
    sight: NonNegativeLength = default(
        4.0, "People and walls nearer than this count, m; 0: it sees none."
    )
    gap_time: PositiveDuration = default(
        0.5, "It drives no faster than the gap ahead in this time, s."
    )
    slow_distance: PositiveLength = default(1.5, "Nearer to the goal it slows down, m.")
    noise: Share = default(0.0, "Standard deviation of the hand, a fraction of full deflection.")
    proportional_noise: Share = default(0.0, "The same, as a fraction of the deflection.")
    noise_time: PositiveDuration = default(0.3, "Correlation time of the hand's error, s.")
    delay: Delay = default(0.0, "From seeing to the stick's deflection, s.")
    bias: Angle = default(0.0, "All directions seem turned this far to the left, rad.")


class GoalDirectedUserSpec(UserSpec):
    """A user without faults, the yardstick for the others."""

    kind: Literal["goal_directed_user"] = "goal_directed_user"


class NoisyUserSpec(UserSpec):
    """A user with a shaky hand."""

    kind: Literal["noisy_user"] = "noisy_user"
    noise: Share = default(0.2, "Standard deviation of the hand, a fraction of full deflection.")
    proportional_noise: Share = default(0.2, "The same, as a fraction of the deflection.")


class DelayedUserSpec(UserSpec):
    """A user who reacts late, or drives over a connection with delay."""

    kind: Literal["delayed_user"] = "delayed_user"
    delay: Delay = default(0.6, "From seeing to the stick's deflection, s.")


class BiasedUserSpec(UserSpec):
    """A user whose sense of straight ahead is rotated, as in spatial neglect."""

    kind: Literal["biased_user"] = "biased_user"
    bias: Angle = default(0.2618, "All directions seem turned this far to the left, rad.")


class OneSwitchUserSpec(UserSpec):
    """A user with one switch, who selects from directions that are offered in turn.

    The directions are ahead, left, right; while the robot stands they are offered one after
    another, each for `scan_period`. A press selects the offered one, the next press stops the
    robot. The user turns for the goal, and waits for people.
    """

    kind: Literal["one_switch_user"] = "one_switch_user"
    scan_period: PositiveDuration = default(1.0, "Each mark is lit for this long, s.")
    reaction: PositiveDuration = default(0.65, "From the reason for a press to the press, mean, s.")
    reaction_spread: Share = default(
        0.2, "Standard deviation of the reaction, a fraction of its mean."
    )
    tolerance: PositiveAngle = default(0.2618, "The goal may be this far off the heading, rad.")
    deflection: Annotated[float, Gt(0), Le(1)] = default(
        0.5, "Deflection of the stick at each mark, as a fraction."
    )


class FatiguedUserSpec(UserSpec):
    """A tired user: shakier, later, and inattentive now and then.

    Tiredness rises as 1 - exp(-time / `tiring_time`); its effects are those at full tiredness.
    """

    kind: Literal["fatigued_user"] = "fatigued_user"
    time_on_task: NonNegativeDuration = default(
        1800.0, "Time for which it has driven when the run begins, s."
    )
    tiring_time: PositiveDuration = default(
        900.0, "After this time it has reached 63 % of its tiredness, s."
    )
    noise: Share = default(0.08, "Standard deviation of a rested hand, a fraction of full.")
    tired_noise: Annotated[float, Ge(1), Le(10)] = default(2.0, "Factor of the noise when tired.")
    delay: Delay = default(0.25, "Delay of the rested user, s.")
    tired_delay: Annotated[NonNegativeDuration, Le(3.0)] = default(
        0.25, "Additional delay when tired, s."
    )
    lapses: Annotated[float, Ge(0), Le(1)] = default(
        0.05, "Lapses per second when tired, 1/s: the stick stays as it is."
    )
    lapse_time: PositiveDuration = default(1.0, "Length of a lapse, s.")


#: Why some users' first reading is the same with and without people.
_LATE = {"check_sees_people": "acts on what was there some time ago, so not in its first reading"}


def _user(
    spec: type[UserSpec],
    summary: str,
    *more: dict[str, Any],
    exceptions: Mapping[str, str] | None = None,
) -> Component[Any]:
    return Component(
        spec=spec, build=_BUILD, summary=summary, examples=({}, *more), exceptions=exceptions or {}
    )


GOAL_DIRECTED_USER = _user(
    GoalDirectedUserSpec, "synthetic user: to the goal, past people", {"sight": 0.0}
)
NOISY_USER = _user(NoisyUserSpec, "synthetic user with a shaky hand")
DELAYED_USER = _user(
    DelayedUserSpec, "synthetic user who reacts late", {"delay": 1.0}, exceptions=_LATE
)
BIASED_USER = _user(BiasedUserSpec, "synthetic user whose straight ahead is aside")
ONE_SWITCH_USER = _user(OneSwitchUserSpec, "synthetic user with a single switch", exceptions=_LATE)
FATIGUED_USER = _user(
    FatiguedUserSpec, "synthetic user who tires: shaky, late, absent", exceptions=_LATE
)
