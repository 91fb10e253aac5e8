"""The primary score, computed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from crowdbot.core.interfaces import (
    References,
    Score,
    ScoreFactory,
    Trajectories,
    travel_time,
    truncate_at_arrival,
)
from crowdbot.core.trajectories.encounters import robot_of
from crowdbot.core.trajectories.person_contacts import person_contacts
from crowdbot.plugins.metrics.common_reference_build import shortest_time
from crowdbot.plugins.metrics.fault_build import TOLERANCE
from crowdbot.plugins.metrics.safe_efficiency import SAFE_EFFICIENCY, SafeEfficiencySpec


@dataclass(frozen=True, slots=True)
class SafeEfficiency:
    """Needs a goal and the fastest speed that the robot can go; no reference run."""

    spec: SafeEfficiencySpec

    def score(self, run: Trajectories, refs: References) -> Sequence[Score]:
        """0 without arrival, or with a contact at fault; else the shortest over the taken time."""
        del refs
        factory, spec = ScoreFactory(SAFE_EFFICIENCY), self.spec
        shortest = shortest_time(factory, run)
        if isinstance(shortest, list):
            return shortest
        run = truncate_at_arrival(run)
        found = person_contacts(run, spec.jump_speed, spec.contact_tol, spec.release_gap)
        faults = int(found.at_fault(spec.fault_speed + TOLERANCE).sum())
        taken = travel_time(run, robot_of(run))
        extras = {"contacts_at_fault": float(faults), "shortest_time": shortest, "time": taken}
        if shortest <= spec.zero_tol:
            return factory.all_undefined("zero_denominator")
        if faults or robot_of(run).goal_time is None:
            return [factory.ok("corrected", 0.0, extras)]
        return [factory.ok("corrected", shortest / max(taken, shortest), extras)]
