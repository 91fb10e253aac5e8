"""Parameters of steering parts; units are those of `crowdbot.dsl.scenario.steering`."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class TimeGap:
    """Speed is at most (distance ahead - room) / time.

    Attributes:
        time, oncoming_time: to who walks along or stands, and to who comes towards one, s.
        room: distance between centres at which people stand, m.
        half_width: who is farther to the side does not count, m.
    """

    time: float = 1.0
    oncoming_time: float = 0.023
    room: float = 0.27
    half_width: float = 0.28


@dataclass(frozen=True, slots=True, kw_only=True)
class PersonalSpace:
    """A push away from where others are going to be.

    Attributes:
        strength: where discs are going to touch, straight ahead, m/s^2.
        reach: distance over which it falls to 1/e, m.
        anticipation: how far ahead, s.
        behind: share that is left straight behind.
    """

    strength: float = 1.13
    reach: float = 0.4
    anticipation: float = 0.5
    behind: float = 0.78


@dataclass(frozen=True, slots=True, kw_only=True)
class WallPush:
    """A push away from walls.

    Attributes:
        strength: where the disc touches, m/s^2.
        reach: distance over which it falls to 1/e, m.
    """

    strength: float = 3.3
    reach: float = 0.13


@dataclass(frozen=True, slots=True, kw_only=True)
class Wander:
    """A slow random acceleration.

    Attributes:
        deviation: standard deviation along each axis, m/s^2.
        time: in which its correlation falls to 1/e, s.
        key: of the counter-based draws.
    """

    deviation: float = 0.21
    time: float = 0.41
    key: int = 0


@dataclass(frozen=True, slots=True, kw_only=True)
class LaneKeeping:
    """A step aside from who comes, and behind who walks one's own way.

    Attributes:
        strength: largest acceleration to the side, m/s^2.
        reach: distance ahead over which others matter e times less, m.
        half_width: who is farther to the side does not count, m.
        follow: how much those who walk along count beside those who come.
    """

    strength: float = 1.0
    reach: float = 2.0
    half_width: float = 0.6
    follow: float = 1.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Steering:
    """The parts that a crowd has; None is off."""

    time_gap: TimeGap | None = None
    personal_space: PersonalSpace | None = None
    lanes: LaneKeeping | None = None
    wall_push: WallPush | None = None
    wander: Wander | None = None
