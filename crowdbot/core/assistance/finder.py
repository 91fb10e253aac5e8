"""Person finders: estimate where a robot's person is, by lidar tracking or from a device."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from crowdbot.core.assistance.target import Target
from crowdbot.core.sensing.points import LidarPoints
from crowdbot.core.sensing.tracking.people_tracker import PeopleTracker, Tracks
from crowdbot.core.types.arrays import Array, Mask
from crowdbot.core.types.motion import Pose
from crowdbot.core.types.sensor import Reading, SensorInfo

#: Period in which a device tells the pose of its wearer, s, and the error of its velocity, m/s.
TOLD_EVERY, _SPEED_ERROR = 0.25, 0.1
#: A track is taken for the person this far from where the person should be, m; and more by this
#: part of the way that the person may have gone since, up to a limit.
_GATE, _PART, _FARTHEST = 0.6, 0.5, 2.5
#: A person who was last seen this fast is expected to walk on for this long, m/s and s.
_WALKS, _WALKS_ON = 0.2, 2.0
#: A track whose velocity differs by more from that of the person is another person's, m/s; and
#: how much of the velocity of the person is that of the track in each step.
_OTHER, _NEW = 0.7, 0.1
#: People face where they walk when faster than this, m/s.
_TURNS = 0.3


@dataclass(slots=True)
class KnownPerson:
    """Knowledge of one person, in the frame of odometry.

    Attributes:
        track: number of its track; -1: none.
        seen: when it was last seen, s.
        moved: True once its velocity is known.
    """

    x: float
    y: float
    heading: float
    vx: float = 0.0
    vy: float = 0.0
    track: int = -1
    seen: float = 0.0
    moved: bool = False

    def at(self, t: float) -> tuple[float, float]:
        """Return the extrapolated pose at a time: constant velocity for a short while."""
        ahead = min(max(0.0, t - self.seen), _WALKS_ON)
        if math.hypot(self.vx, self.vy) < _WALKS:
            ahead = 0.0
        return self.x + self.vx * ahead, self.y + self.vy * ahead


@dataclass(frozen=True, slots=True, kw_only=True)
class PersonSight:
    """Input of a person finder in one step.

    Attributes:
        t: s.
        pose, twist, vy: by odometry, as in `Observation`.
        readings: of all lidars.
        relative: (M, 5) x, y, facing, vx, vy of the people in the robot's base frame, NaN where
            absent: what a device measures, before its errors.
    """

    t: float
    pose: Pose
    twist: tuple[float, float]
    vy: float
    readings: Mapping[str, Reading]
    relative: Array


@dataclass
class PersonFinder:
    """Base of finders: knows only each person's pose at the start.

    Args:
        target: the person or group.
        rng: random generator of pose errors.
    """

    target: Target
    rng: np.random.Generator
    members: list[KnownPerson] = field(init=False)

    def __post_init__(self) -> None:
        t = self.target
        self.members = [
            KnownPerson(x, y, h)
            for x, y, h in self._with_errors(np.column_stack([t.x, t.y, t.heading])).tolist()
        ]

    def update(self, sight: PersonSight) -> None:
        """Update the estimate with the data of one step."""

    def _with_errors(self, poses: Array) -> Array:
        """Return poses (M, 3), m and rad, with random errors added."""
        goal = self.target.goal
        deviation = [goal.position_error, goal.position_error, goal.heading_error]
        noisy: Array = poses + self.rng.normal(size=poses.shape) * deviation
        return noisy


class ToldFinder(PersonFinder):
    """Finder that gets each person's pose relative to the robot from a device, at a low rate."""

    def update(self, sight: PersonSight) -> None:
        """Read the device, if its next reading is due."""
        if (sight.t / TOLD_EVERY) % 1.0 != 0.0:
            return
        poses = self._with_errors(sight.relative[:, :3])
        speeds = sight.relative[:, 3:] + _SPEED_ERROR * self.rng.normal(size=(len(poses), 2))
        c, s = math.cos(sight.pose.yaw), math.sin(sight.pose.yaw)
        states = zip(self.members, poses.tolist(), speeds.tolist(), strict=True)
        for member, (x, y, heading), (vx, vy) in states:
            if math.isnan(x):
                continue
            member.x, member.y = sight.pose.x + c * x - s * y, sight.pose.y + s * x + c * y
            member.heading = math.remainder(heading + sight.pose.yaw, 2.0 * math.pi)
            member.vx, member.vy, member.seen = c * vx - s * vy, s * vx + c * vy, sight.t


class TrackingFinder(PersonFinder):
    """Finder that tracks each person with the robot's lidars, from the pose at the start."""

    def __init__(
        self, target: Target, rng: np.random.Generator, lidars: Mapping[str, SensorInfo]
    ) -> None:
        super().__init__(target, rng)
        self._points, self._tracker = LidarPoints(lidars), PeopleTracker()

    def update(self, sight: PersonSight) -> None:
        """Match each person to the nearest lidar track around its last or extrapolated position."""
        points = self._points(sight.readings, sight.t, sight.twist, sight.vy)
        tracks = self._tracker.update(sight.t, sight.pose, points)
        rows = {int(number): row for row, number in enumerate(tracks.id)}
        for member in self.members:  # one who passes by takes tracks along
            if member.track in rows and _differs(member, sight.t, tracks)[rows[member.track]]:
                member.track = -1
        taken = {m.track for m in self.members if m.track in rows}
        for member in self.members:
            if member.track not in rows:
                member.track = _nearest(member, sight.t, tracks, taken)
                taken.add(member.track)
            if member.track in rows:
                _follow(member, sight.t, tracks, rows[member.track])


def _nearest(member: KnownPerson, t: float, tracks: Tracks, taken: set[int]) -> int:
    """Return the number of the track that matches a person; -1: none is near enough."""
    x, y = member.at(t)
    walks = math.hypot(member.vx, member.vy) >= _WALKS
    gone = _PART * math.hypot(member.vx, member.vy) * (t - member.seen) if walks else 0.0
    gate = min(_FARTHEST, _GATE + gone)
    away = np.hypot(tracks.position[:, 0] - x, tracks.position[:, 1] - y)
    free = ~np.isin(tracks.id, list(taken)) & (away <= gate) & ~_differs(member, t, tracks)
    return int(tracks.id[np.argmin(np.where(free, away, np.inf))]) if free.any() else -1


def _differs(member: KnownPerson, t: float, tracks: Tracks) -> Mask:
    """Return True for tracks (N,) that are too fast or too slow to be a person.

    The longer the person is unseen, the more its velocity may have changed.
    """
    if not member.moved:
        return np.zeros(len(tracks.id), np.bool_)
    off = tracks.velocity - [member.vx, member.vy]
    return np.asarray(np.hypot(off[:, 0], off[:, 1]) > _OTHER * (1.0 + t - member.seen))


def _follow(member: KnownPerson, t: float, tracks: Tracks, row: int) -> None:
    """Update a person's position, velocity and heading from a track."""
    (member.x, member.y), (vx, vy) = tracks.position[row].tolist(), tracks.velocity[row].tolist()
    new = _NEW if member.moved else 1.0
    member.vx += new * (vx - member.vx)
    member.vy += new * (vy - member.vy)
    member.moved = True
    member.seen = t - float(tracks.unseen[row])
    if math.hypot(member.vx, member.vy) > _TURNS:
        member.heading = math.atan2(member.vy, member.vx)
