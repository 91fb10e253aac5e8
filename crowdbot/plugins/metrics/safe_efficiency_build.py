"""Scoring of the primary score."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from crowdbot.plugin import (
    References,
    Score,
    ScoreFactory,
    Trajectories,
    travel_time,
    truncate_at_arrival,
)
from crowdbot.plugin.for_metrics import (
    at_fault,
    driven_aside,
    person_contacts,
    robot_of,
)
from crowdbot.plugins.metrics.common_reference_build import shortest_time
from crowdbot.plugins.metrics.fault_build import fault_rule
from crowdbot.plugins.metrics.safe_efficiency import SAFE_EFFICIENCY, SafeEfficiencySpec
from crowdbot.plugins.metrics.walls_build import wall_contacts


@dataclass(frozen=True, slots=True)
class SafeEfficiency:
    """Scores ``safe_efficiency``. Needs a goal and the robot's top speed; no reference run."""

    spec: SafeEfficiencySpec

    def score(self, run: Trajectories, refs: References) -> Sequence[Score]:
        """Score 0 without arrival or with a contact at fault, else shortest time over time taken.

        Each person driven aside and each contact with a wall takes off a share.
        """
        del refs
        factory, spec = ScoreFactory(SAFE_EFFICIENCY), self.spec
        shortest = shortest_time(factory, run)
        if isinstance(shortest, list):
            return shortest
        run = truncate_at_arrival(run)
        found = person_contacts(run, spec.jump_speed, spec.contact_tol, spec.release_gap)
        faults = int(at_fault(run, found, fault_rule(spec), spec.jump_speed).sum())
        taken = travel_time(run, robot_of(run))
        aside = np.isfinite(driven_aside(
            run, push=spec.forced_push, headway=spec.forced_headway, reach=spec.evasion_reach,
            jump_speed=spec.jump_speed,
        )).sum()  # fmt: skip
        walls = wall_contacts(run, spec.contact_tol, spec.release_gap, spec.jump_speed)
        extras = {
            "contacts_at_fault": float(faults), "driven_aside": float(aside),
            "wall_contacts": float(walls), "shortest_time": shortest, "time": taken,
        }  # fmt: skip
        if shortest <= spec.zero_tol:
            return factory.all_undefined("zero_denominator")
        if faults or robot_of(run).goal_time is None:
            return [factory.ok("corrected", 0.0, extras)]
        share = spec.forced_factor ** int(aside) * spec.wall_factor**walls
        return [factory.ok("corrected", share * shortest / max(taken, shortest), extras)]
