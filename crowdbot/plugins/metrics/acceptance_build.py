"""Scoring of acceptance: a prediction of people's opinion of a drive."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from crowdbot.plugin import Array, References, Score, Trajectories, duration, truncate_at_arrival
from crowdbot.plugin.for_metrics import (
    MOST,
    demanded_evasion,
    encounter,
    person_contacts,
    robot_approach,
    robot_velocities,
)
from crowdbot.plugins.metrics.acceptance import AcceptanceSpec
from crowdbot.plugins.metrics.common_reference_build import missed_goal
from crowdbot.plugins.metrics.declared_build import DeclaredMetric, UndefinedError
from crowdbot.plugins.metrics.walls_build import wall_contacts

#: Rating of the distance d (m) between the centres of a robot and the nearest person, of 100:
#: 56 + 38 ln d, fitted to SocNav1 (9 280 ratings by 12 people, CC BY 4.0).
_AT_ONE_METRE, _BY_FACTOR, _NEAREST = 56.0, 38.0, 0.05
#: Gaps that people mind, m: at any speed, and at speed.
_CLOSE, _AT_SPEED = 0.25, 0.5
#: A robot that comes nearer more slowly forces no one to evade, m/s.
_CREEPS = 0.05


class Acceptance(DeclaredMetric[AcceptanceSpec]):
    """Scores ``acceptance``: exp(-sum of weighted faults of the drive).

    Each fault can only lower it; without a goal, arrival does not count.
    """

    def _scores(self, run: Trajectories, _: References) -> Sequence[Score]:
        spec = self.spec
        if run.robot is None:
            raise UndefinedError("invalid_no_robot")
        missed = missed_goal(run)
        arrived = run.robot.goal_time
        if arrived is None or arrived > run.t[0]:  # else it starts in its goal, and drives on
            run = truncate_at_arrival(run)
        gap = encounter(run, spec.jump_speed).gap
        if not np.isfinite(gap).any():
            raise UndefinedError("no_agents")
        if duration(run.t) <= 0:
            raise UndefinedError("too_few_samples")
        found = person_contacts(run, spec.jump_speed, spec.contact_tol, spec.release_gap)
        faults = {
            "not_arrived": float(missed),
            "touched": float(len(found.time) > 0),
            "wall": float(wall_contacts(run, spec.contact_tol, spec.release_gap,
                                        spec.jump_speed) > 0),
            "near": 1.0 - self._rating(run),
            "crowding": _share_of_time(run.t, _nearest(gap) < _CLOSE),
            "fast": self._fast(run, gap),
            "forcing": self._forcing(run),
        }  # fmt: skip
        cost = sum(getattr(spec, name) * amount for name, amount in faults.items())
        return [self.factory.ok("corrected", math.exp(-cost), faults)]

    def _rating(self, run: Trajectories) -> float:
        """Return the rating of the smallest distance between centres, 0 to 1."""
        pair = encounter(run, self.spec.jump_speed)
        distance = np.hypot(pair.px, pair.py)
        least = max(_NEAREST, float(np.nanmin(distance)))
        return min(1.0, max(0.0, (_AT_ONE_METRE + _BY_FACTOR * math.log(least)) / 100.0))

    def _fast(self, run: Trajectories, gap: Array) -> float:
        """Return the largest product of speed and missing room, m²/s."""
        speed = np.nan_to_num(np.hypot(*robot_velocities(run, self.spec.jump_speed)))
        missing = np.maximum(0.0, _AT_SPEED - _nearest(gap))
        return float((speed * np.minimum(missing, _AT_SPEED)).max())

    def _forcing(self, run: Trajectories) -> float:
        """Return the largest evasion demanded while the robot comes nearer, in units of `MOST`."""
        spec = self.spec
        need = demanded_evasion(run, spec.demand_time, spec.demand_room, spec.jump_speed)
        comes = robot_approach(run, spec.jump_speed) > _CREEPS
        return float(np.max(need * comes, initial=0.0)) / MOST


def _nearest(gap: Array) -> Array:
    """Return (N,) the gap to the nearest person, m; inf without people."""
    return np.asarray(np.where(np.isfinite(gap), gap, np.inf).min(axis=1, initial=np.inf))


def _share_of_time(t: Array, true: NDArray[np.bool_]) -> float:
    """Return the share of time of a condition at the samples."""
    weight = np.diff(t)
    both = (true[1:].astype(np.float64) + true[:-1]) / 2.0
    return float(weight @ both / weight.sum())
