"""Encounters: meetings of one person and one robot, predicted by walking straight on."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from crowdbot.core.geometry.footprint import Footprint
from crowdbot.core.realism.near_robots.clip import Clip, gap_at
from crowdbot.core.types.arrays import Array

#: Radius of a person's body, m, by which recorded and simulated gaps are measured.
BODY = 0.158
#: An encounter begins this long before the closest approach, or later, and ends after it, s.
BEFORE, LEAST_BEFORE, AFTER = 5.0, 1.0, 1.5
#: It begins when the person has this share of its usual walking speed.
_UP_TO_SPEED = 0.8
#: Time over which the initial velocity is taken, s.
_FIRST = 0.5
#: Slower people and robots are not in an encounter, m/s.
WALKS, DRIVES = 0.4, 0.15
#: The predicted gap of an encounter is below a share of the speed-dependent clearance, m.
_NEAR, _NEAR_VEHICLE, VEHICLE = 0.3, 1.0, 1.5
#: Least gap at the beginning, m.
_APART = 0.6
#: Directions of motion nearer than this to each other, or to opposite, are not crossing, rad.
_ALONG = math.radians(45.0)


@dataclass(frozen=True, slots=True, kw_only=True)
class RobotEncounter:
    """A person and a robot that would meet; SI units.

    Attributes:
        name, site: of the recording.
        t: (K,) times since the beginning.
        pose: (K, 3) x, y and heading of the robot.
        person: (K, 2) positions of the person.
        velocity: (2,) initial velocity of the person.
        closest: row of the closest approach.
        footprint: outline of the robot.
        robot_speed: mean speed of the robot until the closest approach.
        kind: ``front``, ``cross`` or ``behind``.
        predicted_gap: smallest gap if the person had walked straight on.
    """

    name: str
    site: str
    t: Array
    pose: Array
    person: Array
    velocity: Array
    closest: int
    footprint: Footprint
    robot_speed: float
    kind: str
    predicted_gap: float

    @property
    def straight(self) -> Array:
        """Return (K, 2) positions of a person who walks straight on, m."""
        return np.asarray(self.person[0] + self.t[:, np.newaxis] * self.velocity)

    def gap(self, person: Array) -> Array:
        """Return (K,) gaps between the surfaces of the robot and of a person, m."""
        return gap_at(self.pose, self.footprint, person[:, 0], person[:, 1]) - BODY


def encounters_of(clips: Sequence[Clip]) -> list[RobotEncounter]:
    """Return all encounters in clips, person by person."""
    encounters = []
    for clip in clips:
        for k in range(clip.people.shape[1]):
            one = _encounter(clip, k)
            if one is not None:
                encounters.append(one)
    return encounters


def _encounter(clip: Clip, k: int) -> RobotEncounter | None:
    person = clip.people[:, k]
    known = np.isfinite(person[:, 0])
    if np.count_nonzero(known) < 2.0 / clip.dt:
        return None
    away = np.where(known, clip.gap(np.arange(len(person)), person[:, 0], person[:, 1]), np.inf)
    closest = int(np.argmin(away))
    begin = _begin(clip, person, closest)
    if begin is None:
        return None
    missing = np.flatnonzero(~known[closest:])
    end = closest + (int(missing[0]) if len(missing) else len(person) - closest)
    end = min(end, closest + round(AFTER / clip.dt))
    return encounter(
        clip.name, clip.site, clip.t[begin:end] - clip.t[begin], clip.pose[begin:end],
        person[begin:end], closest - begin, clip.footprint,
    )  # fmt: skip


def encounter(
    name: str,
    site: str,
    t: Array,
    pose: Array,
    person: Array,
    closest: int,
    footprint: Footprint,
) -> RobotEncounter | None:
    """Return the encounter of a stretch, or None if person and robot would not meet."""
    dt = float(t[1] - t[0])
    first = round(_FIRST / dt)
    velocity = (person[first] - person[0]) / (first * dt)
    before = pose[: closest + 1]
    speed = float(np.hypot(*np.diff(before[:, :2], axis=0).T).sum() / (closest * dt))
    way = before[-1, :2] - before[0, :2]
    if speed < DRIVES or math.hypot(*velocity) < WALKS or math.hypot(*way) < 0.1:
        return None
    found = RobotEncounter(
        name=name, site=site, t=t, pose=pose, person=person, velocity=velocity, closest=closest,
        footprint=footprint, robot_speed=speed, kind=_kind(velocity, way),
        predicted_gap=math.inf,
    )  # fmt: skip
    gaps = found.gap(found.straight)
    predicted = float(gaps.min())
    if predicted >= (_NEAR_VEHICLE if speed > VEHICLE else _NEAR) or gaps[0] < _APART:
        return None
    return replace(found, predicted_gap=predicted)


def _begin(clip: Clip, person: Array, closest: int) -> int | None:
    """Return the first row, at most `BEFORE` before the closest, from which the person walks."""
    speed = np.hypot(*np.gradient(person, clip.dt, axis=0).T)
    walking = speed[speed > WALKS]
    if not len(walking):
        return None
    fast = max(WALKS, _UP_TO_SPEED * float(np.median(walking)))
    rows = range(max(0, closest - round(BEFORE / clip.dt)), closest - round(LEAST_BEFORE / clip.dt))
    for row in rows:
        if speed[row] >= fast and np.isfinite(person[row : closest + 1]).all():
            return row
    return None


def _kind(velocity: Array, way: Array) -> str:
    angle = abs(
        math.atan2(velocity[0] * way[1] - velocity[1] * way[0], float(np.dot(velocity, way)))
    )
    if angle < _ALONG:
        return "behind"
    return "front" if angle > math.pi - _ALONG else "cross"
