"""Scoring of contacts with people."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

import crowdbot.plugins.metrics.collision as specs
from crowdbot.plugin import Array, References, Score, Trajectories, duration, path_length
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
from crowdbot.plugins.metrics.declared_build import RobotMetric
from crowdbot.plugins.metrics.parameters import ContactMetricSpec

#: Tolerance of the fault rule, m/s and m²/s, so that rounding does not decide.
TOLERANCE = 1e-9


class CollisionCount(RobotMetric[specs.CollisionCountSpec]):
    """Scores ``collision_count``: all contacts, however short.

    ``literal``: sequences of samples in contact.
    """

    def _scores(self, run: Trajectories, _: References) -> Sequence[Score]:
        found = events(run, self.spec)
        first = {"first_time": float(found.time[0])} if len(found.time) else {}
        pair = encounter(run, self.spec.jump_speed)
        return [
            self.factory.ok("literal", contact_runs(pair, self.spec.contact_tol)),
            self.factory.ok("corrected", len(found), first),
        ]


class CollisionSeverity(RobotMetric[specs.CollisionSeveritySpec]):
    """Scores ``collision_severity``: the energy of contacts, just before each.

    ``literal``: of each sample in contact. Contacts of unknown speed or with an unknown person
    count as 0.
    """

    def _scores(self, run: Trajectories, _: References) -> Sequence[Score]:
        vx, vy = relative_velocity(run, self.spec.jump_speed)
        square = vx**2 + vy**2
        square = np.where(np.isfinite(square), square, 0.0)
        found = events(run, self.spec)
        known = np.isfinite(found.speed) & (found.agent >= 0)
        speed, agent = found.speed[known], found.agent[known]
        half_sum, reduced = self._masses(run)
        touch = touching(encounter(run, self.spec.jump_speed), self.spec.contact_tol)
        return [
            self.factory.ok("literal", (np.where(touch, square, 0.0) * half_sum).sum()),
            self.factory.ok("per_event", half_sum[agent] @ speed**2),
            self.factory.ok("corrected", 0.5 * reduced[agent] @ speed**2),
            self.factory.ok("impulse", reduced[agent] @ speed),
        ]

    def _masses(self, run: Trajectories) -> tuple[Array, Array]:
        """Return the mean and the reduced mass of the robot with each person (M,), (M,), kg."""
        one, other = robot_of(run).mass, people(run).mass
        total = one + other
        reduced = np.divide(one * other, total, out=np.zeros(len(other)), where=total > 0)
        return total / 2.0, reduced


class CollisionRate(RobotMetric[specs.CollisionRateSpec]):
    """Scores ``collision_rate``: contacts per second, and per metre that the robot drove."""

    def _scores(self, run: Trajectories, _: References) -> Sequence[Score]:
        count = len(events(run, self.spec))
        length = path_length(run.t, robot_of(run), self.spec.jump_speed)
        return [
            self.factory.ratio("per_time", count, duration(run.t), self.spec.zero_tol),
            self.factory.ratio("per_length", count, length, self.spec.zero_tol),
        ]


class CollisionsAtFault(RobotMetric[specs.CollisionsAtFaultSpec]):
    """Scores ``collisions_at_fault``: contacts by fault of the robot and of the person.

    It is the robot's if it is faster and the person is in front of it, else the person's.
    """

    def _scores(self, run: Trajectories, _: References) -> Sequence[Score]:
        found = events(run, self.spec)
        pair = encounter(run, self.spec.jump_speed)
        rx, ry = robot_velocities(run, self.spec.jump_speed)
        known = found.agent >= 0
        k, i = found.sample[known], found.agent[known]
        lead = np.hypot(rx, ry)[k] - people_speeds(run, self.spec.jump_speed)[k, i]
        before = pair.px[k, i] * rx[k] + pair.py[k, i] * ry[k] > TOLERANCE
        robot = int(((lead > TOLERANCE) & before).sum())
        return [self.factory.ok("robot", robot), self.factory.ok("person", len(found) - robot)]


def events(run: Trajectories, spec: ContactMetricSpec) -> PersonContacts:
    """Return contacts with people up to the arrival.

    Taken from the contact table if there is one, else from the motion.
    """
    return person_contacts(run, spec.jump_speed, spec.contact_tol, spec.release_gap)
