"""Scoring of how far the robot advances on people who have little room."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from crowdbot.plugin import References, Score, Trajectories, truncate_at_arrival
from crowdbot.plugin.for_metrics import DISTANCE_TOLERANCE, encounter, evasion, people, share_below
from crowdbot.plugins.metrics.common_reference_build import rate_and_way
from crowdbot.plugins.metrics.declared_build import DeclaredMetric, UndefinedError
from crowdbot.plugins.metrics.intrusion import IntrusionSpec


class Intrusion(DeclaredMetric[IntrusionSpec]):
    """Scores ``intrusion``: advances on people with little room or little time left.

    Per progress, per person, and in total.
    """

    def _scores(self, run: Trajectories, _: References) -> Sequence[Score]:
        spec = self.spec
        if run.robot is None:
            raise UndefinedError("invalid_no_robot")
        if not people(run).x.size:
            raise UndefinedError("no_agents")
        run = truncate_at_arrival(run)
        found = evasion(run, spec.evasion_reach, spec.jump_speed)
        met = float(found.met.sum())
        if not met:
            raise UndefinedError("no_neighbours")
        gap = encounter(run, spec.jump_speed).gap
        room = (gap[1:] + gap[:-1]) / 2.0
        close = found.near & (room < spec.compliance - DISTANCE_TOLERANCE)
        way = float(found.dt @ (found.approach * close).sum(axis=1))
        extras = {"people_met": met}
        short = share_below(run, spec.time_gap, spec.jump_speed)
        hurried = float(found.dt @ (found.approach * short).sum(axis=1))
        lacking = np.clip(1.0 - room / spec.room, 0.0, 1.0)
        lacking = np.where(found.near & np.isfinite(room), lacking, 0.0)
        narrow = float(found.dt @ (found.approach * lacking).sum(axis=1))
        rate, over = rate_and_way(self.factory, run, narrow, spec.least_way)
        return [
            rate,
            rate_and_way(self.factory, run, hurried, spec.least_way, "hurried")[0],
            self.factory.ok("corrected", way / met, extras),
            self.factory.ok("total", way, extras),
            over,
        ]
