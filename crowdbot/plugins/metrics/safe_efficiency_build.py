"""Scoring of the primary score."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from crowdbot.plugin import References, Score, Trajectories, travel_time, truncate_at_arrival
from crowdbot.plugin.for_metrics import at_fault, driven_aside, person_contacts, robot_of
from crowdbot.plugins.metrics.common_reference_build import shortest_time
from crowdbot.plugins.metrics.declared_build import DeclaredMetric, UndefinedError
from crowdbot.plugins.metrics.fault_build import fault_rule
from crowdbot.plugins.metrics.safe_efficiency import SafeEfficiencySpec
from crowdbot.plugins.metrics.walls_build import wall_contacts

#: People regain their velocity within this time after they have bounced off others, s.
_REBOUND = 1.0


class SafeEfficiency(DeclaredMetric[SafeEfficiencySpec]):
    """Scores ``safe_efficiency``: shortest time over time taken; 0 without arrival.

    0 after a contact at fault; each person driven aside and each contact with a wall takes off a
    share. Needs a goal and the robot's top speed.
    """

    def _scores(self, run: Trajectories, _: References) -> Sequence[Score]:
        spec = self.spec
        shortest = shortest_time(run)
        run = truncate_at_arrival(run)
        found = person_contacts(run, spec.jump_speed, spec.contact_tol, spec.release_gap)
        faults = int(at_fault(run, found, fault_rule(spec), spec.jump_speed).sum())
        taken = travel_time(run, robot_of(run))
        aside, by_robot = (self._aside(run, rebound) for rebound in (0.0, _REBOUND))
        walls = wall_contacts(run, spec.contact_tol, spec.release_gap, spec.jump_speed)
        extras = {
            "contacts_at_fault": float(faults), "driven_aside": float(aside),
            "driven_aside_by_robot": float(by_robot), "wall_contacts": float(walls),
            "shortest_time": shortest, "time": taken,
        }  # fmt: skip
        if shortest <= spec.zero_tol:
            raise UndefinedError("zero_denominator")
        if faults or robot_of(run).goal_time is None:
            return [self.factory.ok("corrected", 0.0, extras), self.factory.ok("by_robot", 0.0)]
        share = spec.wall_factor**walls * shortest / max(taken, shortest)
        return [
            self.factory.ok("corrected", spec.forced_factor**aside * share, extras),
            self.factory.ok("by_robot", spec.forced_factor**by_robot * share),
        ]

    def _aside(self, run: Trajectories, rebound: float) -> int:
        """Return how many people are driven aside; see `driven_aside`."""
        spec = self.spec
        return int(np.isfinite(driven_aside(
            run, push=spec.forced_push, headway=spec.forced_headway, reach=spec.evasion_reach,
            jump_speed=spec.jump_speed, rebound=rebound,
        )).sum())  # fmt: skip
