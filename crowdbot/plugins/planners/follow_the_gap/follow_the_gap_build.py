"""Follow the gap: steer between the widest gap's middle and the goal.

Sezer, Gokasan, "A novel obstacle avoidance algorithm: follow the gap method", Robotics and
Autonomous Systems 60(9), 2012.

Obstacles are discs, enlarged by the robot; between them, and between them and the border of the
view, are gaps. The robot steers to a mean of the widest gap's middle and the goal; the gap weighs
the more the nearer the nearest obstacle.
"""

from __future__ import annotations

import math

import numpy as np

from crowdbot.plugin import Array, Observation
from crowdbot.plugins.planners.follow_the_gap.follow_the_gap import FollowTheGapSpec
from crowdbot.plugins.planners.shared.driver_build import VelocityPlanner
from crowdbot.plugins.planners.shared.surroundings_build import PlannerScene

#: The robot drives at full speed where nothing is nearer than this ahead, m.
_SLOWS = 1.0
#: Narrower gaps do not count, rad.
_NARROW = 0.1


class FollowTheGap(VelocityPlanner):
    """The follow-the-gap planner, without memory."""

    def __init__(self, spec: FollowTheGapSpec) -> None:
        super().__init__(spec)
        self._spec = spec

    def forget(self) -> None:
        """Do nothing, since there is no memory."""

    def velocity(self, obs: Observation, scene: PlannerScene, wish: Array) -> tuple[float, float]:
        """Return the velocity towards the gap and the goal, m/s; zero without a gap."""
        spec = self._spec
        goal = math.atan2(wish[1], wish[0])
        bearing, half, gap = self._shadows(scene, goal)
        if not len(bearing):
            return float(wish[0]), float(wish[1])
        found = widest_gap(bearing - half, bearing + half, spec.view)
        obs.log("follow_the_gap/nearest", min(float(gap.min()), 100.0))
        if found is None:
            return 0.0, 0.0
        weight = spec.gap_weight / max(float(gap.min()), 0.05)
        # angles are relative to the goal, whose own is 0
        aside = weight * 0.5 * (found[0] + found[1]) / (weight + 1.0)
        ahead = np.abs(bearing - aside) < half
        room = float(gap[ahead].min(initial=_SLOWS))
        speed = float(np.hypot(*wish)) * min(1.0, max(0.0, room) / _SLOWS)
        return speed * math.cos(goal + aside), speed * math.sin(goal + aside)

    def _shadows(self, scene: PlannerScene, goal: float) -> tuple[Array, Array, Array]:
        """Return the bearings from the goal's direction, half widths (rad) and gaps (m)."""
        spec = self._spec
        discs = scene.discs
        x, y = discs[:, 0] - scene.pose.x, discs[:, 1] - scene.pose.y
        away, clear = np.hypot(x, y), self.radius + spec.safety + discs[:, 2]
        near = away - clear < spec.reach
        away, clear = away[near], clear[near]
        off = np.arctan2(y[near], x[near]) - goal
        off -= 2.0 * np.pi * np.round(off / (2.0 * np.pi))
        half = np.arcsin(np.minimum(1.0, clear / np.maximum(away, 1e-9)))
        seen = np.abs(off) < spec.view + half
        return off[seen], half[seen], np.maximum(away - clear, 0.0)[seen]


def widest_gap(right: Array, left: Array, view: float) -> tuple[float, float] | None:
    """Return the right and left end of the widest gap, rad; None if there is none.

    Args:
        right, left: (N,) ends of what is blocked, rad.
        view: gaps end at this angle to either side, rad.
    """
    order = np.argsort(right, kind="stable")
    ends = np.maximum.accumulate(np.concatenate([[-view], left[order]]))
    starts = np.concatenate([right[order], [view]])
    wide = np.minimum(starts, view) - ends
    best = int(np.argmax(wide))
    return None if wide[best] < _NARROW else (float(ends[best]), float(min(starts[best], view)))


build = FollowTheGap
