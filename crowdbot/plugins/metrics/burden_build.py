"""Scoring of the burden on people, from their motion near the robot."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from crowdbot.plugin import References, Score, ScoreFactory, Trajectories, truncate_at_arrival
from crowdbot.plugin.for_metrics import (
    Evasion,
    demanded_evasion,
    evasion,
    ghost_run,
    own_legs,
    people,
    robot_approach,
    share_below,
)
from crowdbot.plugins.metrics.burden import EvasiveAccelerationSpec, PushWorkSpec
from crowdbot.plugins.metrics.common_reference_build import rate_and_way
from crowdbot.plugins.metrics.declared_build import DeclaredMetric, UndefinedError

#: Share of the people met whose peak is not higher than the 95th percentile.
PERCENTILE = 0.95

_Spec = PushWorkSpec | EvasiveAccelerationSpec


class PushWork(DeclaredMetric[PushWorkSpec]):
    """Scores ``push_work``: push work per progress, per person met, and in total.

    ``excess``, less that of the run without a robot, needs ``crowd_alone`` at the same times.
    """

    def _scores(self, run: Trajectories, refs: References) -> Sequence[Score]:
        found = _near(run, self.spec)
        work, met = found.work(people(run).mass), float(found.met.sum())
        extras = {"people_met": met}
        rate, way = rate_and_way(self.factory, run, self._demanded(run), self.spec.least_way)
        return [
            rate,
            rate_and_way(self.factory, run, self._forced(run), self.spec.least_way, "forced")[0],
            self.factory.ok("corrected", work / met, extras),
            self.factory.ok("total", work, extras),
            _excess(self.factory, run, refs, self.spec, self._difference),
            way,
        ]

    def _forced(self, run: Trajectories) -> float:
        """Return the work on people whom the robot would reach if they stopped, J."""
        spec, run = self.spec, truncate_at_arrival(run)
        found = evasion(run, spec.evasion_reach, spec.jump_speed)
        share = share_below(run, spec.forced_headway, spec.jump_speed)
        return found.work(people(run).mass, share)

    def _demanded(self, run: Trajectories) -> float:
        """Return the work that people need against the robot to keep the demanded room, J.

        Only accelerations beyond the usual ones count.
        """
        spec, run = self.spec, truncate_at_arrival(run)
        need = demanded_evasion(run, spec.demand_time, spec.demand_room, spec.jump_speed)
        need = np.maximum(0.0, need - spec.usual_acceleration)
        power = need * robot_approach(run, spec.jump_speed)
        return float(np.diff(run.t) @ power @ people(run).mass)

    def _difference(self, run: Trajectories, ghost: Trajectories) -> float:
        return self._per_person(run) - self._per_person(ghost)

    def _per_person(self, run: Trajectories) -> float:
        found = evasion(run, self.spec.evasion_reach, self.spec.jump_speed)
        return found.work(people(run).mass) / max(float(found.met.sum()), 1.0)


class EvasiveAcceleration(DeclaredMetric[EvasiveAccelerationSpec]):
    """Scores ``evasive_acceleration``: percentile, maximum and mean square of people's peaks.

    ``excess``, less that of the run without a robot, needs ``crowd_alone`` at the same times.
    """

    def _scores(self, run: Trajectories, refs: References) -> Sequence[Score]:
        found = _near(run, self.spec)
        peaks = found.size.max(axis=0)[found.met]
        return [
            self._by_own_legs(run, found),
            self.factory.ok(
                "all", np.quantile(peaks, PERCENTILE), {"people_met": float(len(peaks))}
            ),
            self.factory.ok("peak", peaks.max()),
            self.factory.ok("rms", found.rms()),
            _excess(self.factory, run, refs, self.spec, self._difference),
        ]

    def _by_own_legs(self, run: Trajectories, found: Evasion) -> Score:
        """Score only people who are met without any contact, by their desired acceleration."""
        run = truncate_at_arrival(run)
        own = own_legs(run, self.spec.evasion_reach, self.spec.jump_speed)
        if not own.any():
            return self.factory.undefined("corrected", "no_neighbours")
        peaks = np.where(own, found.size, 0.0).max(axis=0)[own.any(axis=0)]
        extras = {"people_met": float(len(peaks))}
        return self.factory.ok("corrected", np.quantile(peaks, PERCENTILE), extras)

    def _difference(self, run: Trajectories, ghost: Trajectories) -> float:
        own, other = (
            evasion(r, self.spec.evasion_reach, self.spec.jump_speed).rms() for r in (run, ghost)
        )
        return float(np.sqrt(max(0.0, own**2 - other**2)))


def _near(run: Trajectories, spec: _Spec) -> Evasion:
    """Return the people near the robot until it arrives; raise `UndefinedError` without any."""
    if run.robot is None:
        raise UndefinedError("invalid_no_robot")
    if not people(run).x.size or not np.isfinite(people(run).x).any():
        raise UndefinedError("no_agents")
    found = evasion(truncate_at_arrival(run), spec.evasion_reach, spec.jump_speed)
    if not found.met.any():
        raise UndefinedError("no_neighbours")
    return found


def _excess(
    factory: ScoreFactory,
    run: Trajectories,
    refs: References,
    spec: _Spec,
    difference: Callable[[Trajectories, Trajectories], float],
) -> Score:
    """Score the run minus the same run with the robot as a ghost."""
    if refs.crowd_alone is None or refs.crowd_alone.agents is None:
        return factory.undefined("excess", "no_reference")
    both = ghost_run(truncate_at_arrival(run), refs.crowd_alone)
    if both is None:
        return factory.undefined("excess", "sampling_mismatch")
    if not evasion(both[0], spec.evasion_reach, spec.jump_speed).met.any():
        return factory.undefined("excess", "no_neighbours")
    return factory.ok("excess", difference(*both))
