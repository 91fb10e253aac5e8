"""The adversaries: variants of one blind driver that looks some way ahead."""

from __future__ import annotations

import hashlib
import math
from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from crowdbot.plugin import (
    Array,
    Command,
    LidarPoints,
    Observation,
    RobotLimits,
    SensorInfo,
    Task,
)
from crowdbot.plugins.planners.adversaries import adversaries as specs
from crowdbot.plugins.planners.goal_seek import GoalSeekSpec
from crowdbot.plugins.planners.goal_seek_build import GoalSeek
from crowdbot.plugins.planners.shared.robot_outline_build import half_width_and_front
from crowdbot.plugins.planners.stop_and_go.stop_and_go import StopAndGoSpec
from crowdbot.plugins.planners.stop_and_go.stop_and_go_build import StopAndGo
from crowdbot.plugins.planners.wall_hug import WallHugSpec
from crowdbot.plugins.planners.wall_hug_build import WallHug

#: Reaction and braking that the rule of fault expects, s and m/s².
_REACTION, _BRAKING = 0.3, 1.0
#: Bodies of people are wider than the legs that a lidar sees, m.
_BODY = 0.15


class Bully:
    """Adversary that heads for the goal and brakes as late as the rule of fault allows."""

    def __init__(self, spec: object = None, seek: GoalSeek | WallHug | None = None) -> None:
        del spec
        self._seek = seek or GoalSeek(GoalSeekSpec())

    def reset(
        self, task: Task, limits: RobotLimits, sensors: Mapping[str, SensorInfo], seed: int
    ) -> None:
        """Store the robot's limits, outline and lidars."""
        self._seek.reset(task, limits, sensors, seed)
        self.limits, self._points = limits, LidarPoints(sensors)
        self._half, self._front = half_width_and_front(None, task.robot)
        self.since: float | None = None  # time of an event that the adversary remembers, s

    def step(self, obs: Observation) -> Command:
        """Return the adversary's command."""
        points = self._points(obs.readings, obs.t, obs.twist, obs.vy)
        v, w, _ = self._seek.step(self.with_goal(obs, points))
        return Command(*self.drive(obs, points, v, w))

    def with_goal(self, obs: Observation, points: Array) -> Observation:
        """Return the observation with another goal to head for."""
        del points
        return obs

    def drive(self, obs: Observation, points: Array, v: float, w: float) -> tuple[float, float]:
        """Return the blind command as changed by the adversary; here it brakes late."""
        del obs
        return self.late(self.room(points), v), w

    def room(self, points: Array, sign: float = 1.0) -> float:
        """Return the free distance straight ahead (``sign`` -1: behind), m."""
        x, y = sign * points[:, 0], points[:, 1]
        inside = (np.abs(y) <= self._half + _BODY) & (x > 0.0)
        return float(np.min(x[inside], initial=math.inf)) - self._front - _BODY

    def late(self, room: float, v: float) -> float:
        """Return the largest speed from which braking is still in time, m/s."""
        reach = _REACTION * v + v * v / (2.0 * _BRAKING)
        return v if room > reach else min(v, math.sqrt(2.0 * _BRAKING * max(0.0, room - 0.02)))

    def near(self, points: Array, reach: float) -> bool:
        """Return True if something is within a distance of the robot's front half, m."""
        ahead = points[points[:, 0] > 0.0]
        return bool((np.hypot(*ahead.T) < self._front + reach).any())


class Shield(Bully):
    """Adversary that follows closely behind the nearest thing ahead, walls excepted."""

    def with_goal(self, obs: Observation, points: Array) -> Observation:
        """Return the observation with the nearest point in a narrow cone as goal, if any."""
        distance, angle = np.hypot(*points.T), np.arctan2(points[:, 1], points[:, 0])
        seen = (np.abs(angle) < 0.4) & (distance < 2.5)
        if not seen.any():
            return obs
        x, y = points[seen][np.argmin(distance[seen])]
        c, s = math.cos(obs.pose.yaw), math.sin(obs.pose.yaw)
        there = obs.pose.x + 3.0 * (c * x - s * y), obs.pose.y + 3.0 * (s * x + c * y)
        return replace(obs, goal=there)


class Strobe(Bully):
    """Adversary that drives for a second and rests for half a second."""

    def drive(self, obs: Observation, points: Array, v: float, w: float) -> tuple[float, float]:
        """Return the command that brakes late, or zero."""
        moves = math.fmod(obs.t, 1.5) < 1.0
        return (self.late(self.room(points), v), w) if moves else (0.0, w)


class Curtsey(Bully):
    """Adversary that brakes for half a second near someone, then drives on for three."""

    def drive(self, obs: Observation, points: Array, v: float, w: float) -> tuple[float, float]:
        """Return a short braking, then the command that brakes late."""
        if self.since is None or obs.t > self.since + 3.5:
            self.since = obs.t if self.room(points) < 1.2 else None
        bows = self.since is not None and obs.t < self.since + 0.5
        return (0.3 * v, w) if bows else (self.late(self.room(points), v), w)


class LaneWaiter(Bully):
    """Adversary that waits for a free lane of 3 m, then drives 2 s without looking."""

    def drive(self, obs: Observation, points: Array, v: float, w: float) -> tuple[float, float]:
        """Return the blind command within a dash, else zero."""
        room = self.room(points)
        if room > 3.0:
            self.since = obs.t
        dashes = self.since is not None and obs.t < self.since + 2.0
        return (self.late(room, v), w) if dashes else (0.0, w)


class Creep(Bully):
    """Adversary that drives on at 0.045 m/s where others would stop."""

    def drive(self, obs: Observation, points: Array, v: float, w: float) -> tuple[float, float]:
        """Return the command that brakes late, at least 0.045 m/s."""
        del obs
        return max(min(v, 0.045), self.late(self.room(points), v)), w


class Reverse(Bully):
    """Adversary that turns its back to the goal and drives backwards."""

    def with_goal(self, obs: Observation, points: Array) -> Observation:
        """Return the observation with the heading reversed."""
        del points
        return replace(obs, pose=obs.pose._replace(yaw=obs.pose.yaw + math.pi))

    def drive(self, obs: Observation, points: Array, v: float, w: float) -> tuple[float, float]:
        """Return the command that brakes late, for driving backwards."""
        del obs
        return -self.late(self.room(points, -1.0), v), w


class Weave(Bully):
    """Adversary that swings by 0.6 rad to either side, every 4 s."""

    def with_goal(self, obs: Observation, points: Array) -> Observation:
        """Return the observation with a goal beside the real one."""
        del points
        x, y = obs.goal[0] - obs.pose.x, obs.goal[1] - obs.pose.y
        if math.hypot(x, y) < 2.0:
            return obs
        swing = 0.6 * math.sin(0.5 * math.pi * obs.t)
        c, s = math.cos(swing), math.sin(swing)
        return replace(obs, goal=(obs.pose.x + c * x - s * y, obs.pose.y + s * x + c * y))


class Park(Bully):
    """Adversary that does not move."""

    def drive(self, obs: Observation, points: Array, v: float, w: float) -> tuple[float, float]:
        """Return zero."""
        del obs, points, v, w
        return 0.0, 0.0


class Quitter(Bully):
    """Adversary that stops for good at the first encounter."""

    def drive(self, obs: Observation, points: Array, v: float, w: float) -> tuple[float, float]:
        """Return the command that brakes late until something is near ahead, then zero."""
        if self.since is None and self.room(points) < 1.5:
            self.since = obs.t
        return (v, w) if self.since is None else (0.0, 0.0)


class GapRush(Bully):
    """Adversary that heads for the longest free of seven directions."""

    def with_goal(self, obs: Observation, points: Array) -> Observation:
        """Return the observation with a goal in that direction."""
        x, y = obs.goal[0] - obs.pose.x, obs.goal[1] - obs.pose.y
        best, turn = -math.inf, 0.0
        error = math.remainder(math.atan2(y, x) - obs.pose.yaw, 2.0 * math.pi)
        for aside in (0.0, 0.25, -0.25, 0.5, -0.5, 0.75, -0.75):
            c, s = math.cos(error + aside), math.sin(error + aside)
            turned = np.column_stack([points @ (c, s), points @ (-s, c)])
            free = min(3.0, self.room(turned)) - 0.3 * abs(aside)
            if free > best + 1e-9:
                best, turn = free, aside
        c, s = math.cos(turn), math.sin(turn)
        return replace(obs, goal=(obs.pose.x + c * x - s * y, obs.pose.y + s * x + c * y))


class LateStart(Bully):
    """Adversary that waits until nothing was within 4 m ahead for 3 s, at most 40 s."""

    def drive(self, obs: Observation, points: Array, v: float, w: float) -> tuple[float, float]:
        """Return zero at the start, then the blind command."""
        if self.since is None or (obs.t < self.since + 3.0 and self.near(points, 4.0)):
            self.since = obs.t
        goes = obs.t >= min(self.since + 3.0, 40.0)
        self.since = -math.inf if goes else self.since
        return (v, w) if goes else (0.0, 0.0)


class DrawReplay(Bully):
    """Adversary that recognises a crowd by the first scan, and starts after its best delay."""

    def __init__(self, spec: specs.DrawReplaySpec) -> None:
        super().__init__()
        self._memory, self._delay = spec.memory, -1.0

    def drive(self, obs: Observation, points: Array, v: float, w: float) -> tuple[float, float]:
        """Return zero, then the blind command; unknown crowds have no delay."""
        if self._delay < 0.0:
            mark = fingerprint(points)
            obs.log("draw_replay/known", float(mark in self._memory))
            self._delay = self._memory.get(mark, 0.0)
        return (v, w) if obs.t >= self._delay else (0.0, 0.0)


def fingerprint(points: Array) -> str:
    """Return a hash of a scan, equal for equal crowds, with a resolution of 0.5 m."""
    cells = sorted({(round(2.0 * x), round(2.0 * y)) for x, y in points.tolist()})
    return hashlib.sha256(repr(cells).encode()).hexdigest()[:16]


class NeverAside(StopAndGo):
    """Adversary that stops for people as `stop_and_go` does, and never evades them."""

    def __init__(self, spec: specs.NeverAsideSpec) -> None:
        del spec
        super().__init__(StopAndGoSpec(most_aside=0.0))


class WallBully(Bully):
    """Bully that follows the wall."""

    def __init__(self, spec: specs.WallBullySpec) -> None:
        super().__init__(spec, WallHug(WallHugSpec()))
