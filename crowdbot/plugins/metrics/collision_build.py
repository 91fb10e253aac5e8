"""Scoring of contacts with people."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from crowdbot.plugin import (
    Array,
    References,
    Score,
    ScoreFactory,
    Trajectories,
    duration,
    path_length,
    truncate_at_arrival,
)
from crowdbot.plugin.for_metrics import (
    PersonContacts,
    contact_runs,
    encounter,
    people,
    people_speeds,
    person_contacts,
    relative_velocity,
    robot_of,
    robot_velocities,
    touching,
)
from crowdbot.plugins.metrics.collision import (
    COLLISION_COUNT,
    COLLISION_RATE,
    COLLISION_SEVERITY,
    COLLISIONS_AT_FAULT,
    CollisionCountSpec,
    CollisionRateSpec,
    CollisionsAtFaultSpec,
    CollisionSeveritySpec,
)
from crowdbot.plugins.metrics.task import SuccessNoCollisionSpec

#: Tolerance of the fault rule, m/s and m²/s, so that rounding does not decide.
TOLERANCE = 1e-9

_Spec = (
    CollisionCountSpec
    | CollisionSeveritySpec
    | CollisionRateSpec
    | CollisionsAtFaultSpec
    | SuccessNoCollisionSpec
)


@dataclass(frozen=True, slots=True)
class CollisionCount:
    """Scores ``collision_count``. Needs no reference run."""

    spec: CollisionCountSpec

    def score(self, run: Trajectories, refs: References) -> Sequence[Score]:
        """Score ``literal``: runs of samples in contact.

        ``corrected``: all contacts, however short.
        """
        del refs
        factory = ScoreFactory(COLLISION_COUNT)
        if run.robot is None:
            return factory.all_undefined("invalid_no_robot")
        run = truncate_at_arrival(run)
        found = events(run, self.spec)
        first = {"first_time": float(found.time[0])} if len(found.time) else {}
        pair = encounter(run, self.spec.jump_speed)
        return [
            factory.ok("literal", contact_runs(pair, self.spec.contact_tol)),
            factory.ok("corrected", len(found), first),
        ]


@dataclass(frozen=True, slots=True)
class CollisionSeverity:
    """Scores ``collision_severity``. Needs no reference run.

    Contacts of unknown speed or with an unknown person count as 0.
    """

    spec: CollisionSeveritySpec

    def score(self, run: Trajectories, refs: References) -> Sequence[Score]:
        """Score ``literal``: each sample in contact.

        The other variants: each contact, just before it.
        """
        del refs
        factory = ScoreFactory(COLLISION_SEVERITY)
        if run.robot is None:
            return factory.all_undefined("invalid_no_robot")
        run = truncate_at_arrival(run)
        vx, vy = relative_velocity(run, self.spec.jump_speed)
        square = vx**2 + vy**2
        square = np.where(np.isfinite(square), square, 0.0)
        found = events(run, self.spec)
        known = np.isfinite(found.speed) & (found.agent >= 0)
        speed, who = found.speed[known], found.agent[known]
        half_sum, reduced = self._masses(run)
        touch = touching(encounter(run, self.spec.jump_speed), self.spec.contact_tol)
        return [
            factory.ok("literal", (np.where(touch, square, 0.0) * half_sum).sum()),
            factory.ok("per_event", half_sum[who] @ speed**2),
            factory.ok("corrected", 0.5 * reduced[who] @ speed**2),
            factory.ok("impulse", reduced[who] @ speed),
        ]

    def _masses(self, run: Trajectories) -> tuple[Array, Array]:
        """Return the mean and the reduced mass of the robot with each person (M,), (M,), kg."""
        one, other = robot_of(run).mass, people(run).mass
        total = one + other
        reduced = np.divide(one * other, total, out=np.zeros(len(other)), where=total > 0)
        return total / 2.0, reduced


@dataclass(frozen=True, slots=True)
class CollisionRate:
    """Scores ``collision_rate``. Needs no reference run."""

    spec: CollisionRateSpec

    def score(self, run: Trajectories, refs: References) -> Sequence[Score]:
        """Score contacts per second, and per metre that the robot drove."""
        del refs
        factory = ScoreFactory(COLLISION_RATE)
        if run.robot is None:
            return factory.all_undefined("invalid_no_robot")
        run = truncate_at_arrival(run)
        count = len(events(run, self.spec))
        length = path_length(run.t, robot_of(run), self.spec.jump_speed)
        return [
            factory.ratio("per_time", count, duration(run.t), self.spec.zero_tol),
            factory.ratio("per_length", count, length, self.spec.zero_tol),
        ]


@dataclass(frozen=True, slots=True)
class CollisionsAtFault:
    """Scores ``collisions_at_fault``. Needs no reference run."""

    spec: CollisionsAtFaultSpec

    def score(self, run: Trajectories, refs: References) -> Sequence[Score]:
        """Score contacts by fault.

        The robot's if it is faster and the person is in front of it, else the person's.
        """
        del refs
        factory = ScoreFactory(COLLISIONS_AT_FAULT)
        if run.robot is None:
            return factory.all_undefined("invalid_no_robot")
        run = truncate_at_arrival(run)
        found = events(run, self.spec)
        pair = encounter(run, self.spec.jump_speed)
        rx, ry = robot_velocities(run, self.spec.jump_speed)
        known = found.agent >= 0
        k, i = found.sample[known], found.agent[known]
        lead = np.hypot(rx, ry)[k] - people_speeds(run, self.spec.jump_speed)[k, i]
        before = pair.px[k, i] * rx[k] + pair.py[k, i] * ry[k] > TOLERANCE
        robot = int(((lead > TOLERANCE) & before).sum())
        return [factory.ok("robot", robot), factory.ok("person", len(found) - robot)]


def events(run: Trajectories, spec: _Spec) -> PersonContacts:
    """Return contacts with people up to the arrival.

    Taken from the contact table if there is one, else from the motion.
    """
    return person_contacts(run, spec.jump_speed, spec.contact_tol, spec.release_gap)
