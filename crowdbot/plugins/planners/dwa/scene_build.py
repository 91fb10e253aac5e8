"""Perception of dwa: lidar points with velocities from earlier scans, and people."""

from __future__ import annotations

import math
from collections import deque

import numpy as np

from crowdbot.plugin import Array, Pose
from crowdbot.plugins.planners.dwa.dwa import DwaSpec
from crowdbot.plugins.planners.shared.people_build import carry, people_and_points
from crowdbot.plugins.planners.shared.points_build import apart, apparent_velocities, walkers

SECTORS = 240
#: Points farther away play no part, m.
REACH = 6.0
#: Legs of a person who walks are so near to the middle, m.
LEGS = 0.4
#: Apparent motion below this is sampling noise, m/s.
_STILL = 0.3
#: The robot waits for people who walk within this distance, m.
_NEARBY = 4.0
#: Least speed of a walker (m/s); time (s) and share of walkers nearby that make a flow.
_WALKS, _SETTLES, _MOST = 0.5, 1.0, 0.4


class PerceivedScene:
    """Remembers earlier scans, and whether the people nearby walk.

    Args:
        spec: of the planner.
        splits: True if `stands` and `walkers` are separated, which manoeuvres need.

    Attributes:
        around: other points (K, 2), people (N, 2) and their velocities (N, 2), base frame; while
            people walk only what stands is kept current.
        stands: (K, 2) points without the legs of people who walk, base frame, m.
        walkers: (N, 4) places and velocities of people who walk, base frame.
        walking: True if most people nearby walk.
    """

    def __init__(self, spec: DwaSpec, *, splits: bool) -> None:
        self._spec, self._splits = spec, splits
        self._scans: deque[tuple[float, Array, Array]] = deque(maxlen=64)
        nothing = np.empty((0, 2))
        self.around: tuple[Array, Array, Array] = nothing, nothing, nothing
        self.stands, self.walkers = np.empty((0, 2)), np.empty((0, 4))
        self.walking, self._flow = False, 0.0

    def see(self, t: float, pose: Pose, seen: Array, period: float) -> tuple[Array, Array]:
        """Return thinned points and their velocities (K, 2), base frame.

        Args:
            t: now, s.
            pose: of the robot.
            seen: (P, 2) points that its lidars hit, base frame, m.
            period: since the last step, s.
        """
        radius = self._spec.person_radius
        people, rest, points = people_and_points(seen, REACH, radius, SECTORS)
        velocities, going = np.zeros(points.shape), np.zeros(people.shape)
        self.around = rest, people, going
        self.stands, self.walkers = seen, np.empty((0, 4))
        c, s = math.cos(pose.yaw), math.sin(pose.yaw)
        to_world, here = np.array([[c, s], [-s, c]]), np.array([pose.x, pose.y])  # of row vectors
        now, middles = points.dot(to_world), people.dot(to_world)
        now += here
        middles += here
        while len(self._scans) > 1 and self._scans[1][0] <= t - self._spec.look_back:
            self._scans.popleft()
        if self._scans and self._spec.look_back > 0.0:
            then, before, others = self._scans[0]
            dt, fastest = t - then, self._spec.max_obstacle_speed
            if dt >= 0.5 * self._spec.look_back:
                moves = apparent_velocities(now, before, middles, others, dt, _STILL, fastest)
                velocities, going = (m.dot(to_world.T) for m in moves)
                carry(points, velocities, people, going, radius)
                self._note_flow(rest, people, going, period)
                if self._splits:
                    self._split(seen, people, going)
        self._scans.append((t, now, middles))
        return points, velocities

    def _note_flow(self, rest: Array, people: Array, going: Array, period: float) -> None:
        """Update `walking`; while people walk, keep for the map only what stands.

        Legs that are paired now one way, now another, seem to move: one step proves nothing.
        """
        near, walk = walkers(people, going, _NEARBY, _WALKS)
        share = walk / near if near else self._flow
        self._flow += min(1.0, period / _SETTLES) * (share - self._flow)
        self.walking = self._flow > _MOST
        if self.walking:
            self.around = rest, people, going

    def _split(self, seen: Array, people: Array, going: Array) -> None:
        walk = np.hypot(going[:, 0], going[:, 1]) > 0.0
        self.stands = seen[apart(seen, people[walk], LEGS)]
        self.walkers = np.column_stack([people, going])[walk]
