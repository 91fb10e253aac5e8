"""Dead ends: a robot without progress backs off, plans a path on a map, or manoeuvres."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from crowdbot.plugin import Array, Observation, Pose
from crowdbot.plugins.planners.dwa.dead_ends.manoeuvring_build import Manoeuvring
from crowdbot.plugins.planners.dwa.dwa import DwaSpec
from crowdbot.plugins.planners.dwa.scene_build import LEGS, REACH, SECTORS, PerceivedScene
from crowdbot.plugins.planners.shared.local_map_build import AIM, remembered, way_out
from crowdbot.plugins.planners.shared.people_build import with_discs
from crowdbot.plugins.planners.shared.points_build import apart, nearest_per_sector

#: Period at which the map is renewed while it is needed, s.
_MAP_PERIOD = 0.5
#: People in that map have this share of their radius.
_MAPPED = 0.5
#: Share of the time in which people walk that does not count as time without progress.
_WAITING = 0.8
#: Duration of the way back out of a dead end, s.
_ESCAPE = 2.0
#: Time after a barrier barred the way in which waiting for people does not help, s.
_BARRED = 20.0
_NOTHING = np.empty((0, 2))


class Detour(NamedTuple):
    """Changes to one step that lead out of a dead end.

    Attributes:
        goal, room: bearing (rad) and distance (m) of the goal or, on the map, of the next stretch.
        escaping: True if the robot backs off.
        mapped: True if `goal` is the next stretch of a path on the map.
        beside: (K, 2) further points that stand beside the robot, base frame, m.
        command: v, w and vy of a manoeuvre, which replaces any other choice.
    """

    goal: float
    room: float
    escaping: bool
    mapped: bool = False
    beside: Array = _NOTHING
    command: tuple[float, float, float] | None = None


class DeadEnds:
    """Detects missing progress, and then builds a small map.

    Args:
        spec: of the planner.
        half_width: of the robot, m.
        reach: radius of the disc that holds it, m.
        outlined: True if its outline is a polygon or capsule.
        manoeuvring: of a long robot, which does not fit in every heading.
    """

    def __init__(
        self,
        spec: DwaSpec,
        half_width: float,
        reach: float,
        *,
        outlined: bool,
        manoeuvring: Manoeuvring | None,
    ) -> None:
        self._spec, self._half_width, self._reach = spec, half_width, reach
        self._rooms = (spec.margin + 0.02, *([0.01] if outlined else []))
        self._manoeuvring = manoeuvring
        self._map, self._mapped_at = _NOTHING, -math.inf
        self._way: float | None = None
        self._moved_at: tuple[float, float, float] | None = None
        self._escape_until = -math.inf
        self._nearest: tuple[float, float] | None = None
        self._lost, self._barred_until = False, -math.inf
        if manoeuvring is not None:
            manoeuvring.forget()

    def detour(
        self, obs: Observation, pose: Pose, goal: float, distance: float, scene: PerceivedScene,
        period: float,
    ) -> Detour:  # fmt: skip
        """Return the changes to this step that lead out of a dead end.

        Args:
            obs: of this step.
            pose: of the robot.
            goal, distance: bearing (rad) and distance (m) of the goal.
            scene: around the robot.
            period: since the last step, s.
        """
        if scene.walking and obs.t >= self._barred_until:
            self._wait(period)
        escaping = self._is_stuck(obs.t, pose)
        self._lost = self._is_lost(obs.t, distance)
        beside = _NOTHING
        if self._manoeuvring is not None and (self._lost or escaping or self._manoeuvring):
            self._lost = True
            seen_now = replace(obs, pose=pose)
            found = self._manoeuvring.command(seen_now, scene.stands, scene.walkers)
            if found is not None:
                return Detour(goal, distance, escaping, command=found)
            beside = self._manoeuvring.beside(pose)
        if not self._lost:
            self._map, self._way = _NOTHING, None
            if self._manoeuvring is not None:
                self._manoeuvring.forget()
            return Detour(goal, distance, escaping)
        self._renew_map(obs, pose, scene)
        if self._way is None:
            return Detour(goal, distance, escaping, beside=beside)
        room = min(AIM, distance)
        return Detour(self._way - pose.yaw, room, escaping, mapped=True, beside=beside)

    def lose_way(self, t: float, distance: float) -> None:
        """Search for another path at once, since the straight one is blocked.

        Args:
            t: now, s.
            distance: of the goal, m.
        """
        self._moved_at, self._barred_until = None, t + _BARRED
        self._nearest = (distance, t - 2.0 * self._spec.patience - _MAP_PERIOD)

    def _wait(self, period: float) -> None:
        """Count time without progress more slowly while people walk nearby: they will move on."""
        if self._moved_at is not None:
            x, y, since = self._moved_at
            self._moved_at = (x, y, since + _WAITING * period)
        if self._nearest is not None:
            self._nearest = (self._nearest[0], self._nearest[1] + _WAITING * period)

    def _is_stuck(self, t: float, pose: Pose) -> bool:
        x, y, _ = pose
        if self._moved_at is None or math.dist(self._moved_at[:2], (x, y)) > 0.15:
            self._moved_at = (x, y, t)
        elif t - self._moved_at[2] > self._spec.patience:
            self._escape_until = t + _ESCAPE
            self._moved_at = (x, y, t)
        return t < self._escape_until

    def _is_lost(self, t: float, distance: float) -> bool:
        """Return True if the robot has come no nearer to the goal for long: it needs a map."""
        # A manoeuvre is not over where the robot comes nearer, but where it is through.
        long = self._lost and self._manoeuvring is not None
        gain = 2.0 * self._reach if long else 0.3
        if self._nearest is None or distance < self._nearest[0] - gain:
            self._nearest = (distance, t)
        return t - self._nearest[1] > 2.0 * self._spec.patience

    def _renew_map(self, obs: Observation, pose: Pose, scene: PerceivedScene) -> None:
        """Find the first stretch of a way past everything that stands around."""
        x, y, yaw = pose
        if obs.t - self._mapped_at < _MAP_PERIOD:
            return
        self._mapped_at = obs.t
        c, s = math.cos(yaw), math.sin(yaw)
        # A person who stands sideways shows one leg, and the disc is too near: no way would
        # be left in a map that remembers discs at their full size.
        rest, people, going = scene.around
        walk = np.hypot(going[:, 0], going[:, 1]) > 0.0
        rest = rest[apart(rest, people[walk], LEGS)]
        discs = with_discs(rest, people[~walk], _MAPPED * self._spec.person_radius)
        points = nearest_per_sector(discs, SECTORS, REACH)
        seen = points @ np.array([[c, s], [-s, c]]) + (x, y)
        self._map = remembered(self._map, seen, x, y, REACH)
        for room in self._rooms:
            found, way = way_out(self._map, x, y, *obs.goal, self._half_width + room)
            self._way = way if found else None
            if found:
                break


def compile_map() -> None:
    """Compile the functions that `DeadEnds` calls, so that no step waits for it."""
    way_out(np.ones((1, 2)), 0.0, 0.0, 9.0, 0.0, 99.0)  # no way at all is soon found
    apart(np.ones((1, 2)), np.ones((1, 2)), LEGS)
    nearest_per_sector(with_discs(np.ones((1, 2)), np.ones((1, 2)), 0.1), SECTORS, REACH)
