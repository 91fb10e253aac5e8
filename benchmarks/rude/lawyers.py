"""Adversaries at the edge of what the rule of fault and the scores see."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from rude_driver import BRAKING, MARGIN, PERSON, Lawyer, goal_in_base

from crowdbot.plugin import Array, Observation


class Letter(Lawyer):
    """Drives straight, brakes exactly when the rule asks for it, and waits to be bumped into."""


class LegalBump(Lawyer):
    """Brakes no harder than the rule asks for, so that it touches at the speed that is excused."""

    def lawful(self, obs: Observation, points: Array, v: float) -> float:
        """Return the speed, less a step of the braking that is asked for, m/s."""
        slow = super().lawful(obs, points, v)
        return slow if slow >= v else max(0.0, obs.twist[0] - 0.1 * BRAKING)


class HalfSecond(Lawyer):
    """Keeps what is ahead just beyond the half second within which pushing aside counts."""

    def drive(self, obs: Observation, points: Array, v: float, w: float) -> tuple[float, float]:
        """Return the lawful command, never nearer in time than 0.55 s."""
        ahead = points[(points[:, 0] > 0.0) & (np.abs(points[:, 1]) < 0.8)]
        gap = float(np.min(np.hypot(*ahead.T), initial=math.inf)) - self._front - 0.1
        return min(self.lawful(obs, points, v), max(0.0, gap / 0.55)), w


class Chicken(Lawyer):
    """Drives at people, and brakes early only before those who do not give way."""

    def lawful(self, obs: Observation, points: Array, v: float) -> float:
        """Return the speed, or 0 before people whose way still leads to the robot, m/s."""
        if len(self._people):
            x, y, vx, vy = self._people.T
            soon = x / np.maximum(1e-6, max(0.1, obs.twist[0]) - vx)
            stubborn = (x > 0.0) & (soon < 1.5) & (np.abs(y + vy * soon) < self._half + PERSON)
            if stubborn.any():
                return 0.0
        return super().lawful(obs, points, v)


class Ratchet(Lawyer):
    """Pushes for a moment, less than the margin, backs off, and pushes again: new contacts."""

    def drive(self, obs: Observation, points: Array, v: float, w: float) -> tuple[float, float]:
        """Return the lawful command, or a push, or a step back."""
        if self.room(points) > 0.15:
            return self.lawful(obs, points, v), w
        return (0.3 if math.fmod(obs.t, 0.8) < 0.3 else -0.2), 0.0


class LawfulRush(Lawyer):
    """Rushes into the longest of nine free ways, keeps no distance, brakes by the letter."""

    def with_goal(self, obs: Observation, points: Array) -> Observation:
        """Return the observation with a goal on the way that is free longest."""
        obs = super().with_goal(obs, points)
        x, y = obs.goal[0] - obs.pose.x, obs.goal[1] - obs.pose.y
        to = math.remainder(math.atan2(y, x) - obs.pose.yaw, 2.0 * math.pi)
        seen, best, turn = self._people, -math.inf, 0.0
        for aside in (0.0, 0.15, -0.15, 0.3, -0.3, 0.5, -0.5, 0.8, -0.8):
            c, s = math.cos(to + aside), math.sin(to + aside)
            turned = np.array([[c, -s], [s, c]])
            self._people = np.column_stack([seen[:, :2] @ turned, seen[:, 2:] @ turned])
            free = min(4.0, self.soonest(self.limits.v_max)) - 0.5 * abs(aside)
            if free > best + 1e-9:
                best, turn = free, to + aside
        self._people = seen
        far = math.hypot(x, y)
        return goal_in_base(obs, far * math.cos(turn), far * math.sin(turn))


class CutIn(LawfulRush):
    """Rushes into gaps, then slows down before those who come from behind."""

    def drive(self, obs: Observation, points: Array, v: float, w: float) -> tuple[float, float]:
        """Return the lawful command, a third of it while a person comes from behind."""
        x, y, vx, _ = self._people.T
        behind = (x < 0.0) & (x > -1.2) & (np.abs(y) < 0.5) & (vx > obs.twist[0])
        return (0.3 if behind.any() else 1.0) * self.lawful(obs, points, v), w


class Feint(Lawyer):
    """Swerves at people far ahead, so that they choose a side, then drives straight."""

    def with_goal(self, obs: Observation, points: Array) -> Observation:
        """Return a goal at the nearest person who comes, between 3 and 1.5 m."""
        obs = super().with_goal(obs, points)
        x, y, vx, _ = self._people.T
        comes = (x > 1.5) & (x < 3.0) & (np.abs(y) < 1.0) & (vx < -0.3)
        if not comes.any():
            return obs
        nearest = int(np.argmin(np.where(comes, x, np.inf)))
        return goal_in_base(obs, 4.0 * x[nearest], 4.0 * y[nearest])


class Roadblock(Lawyer):
    """Stops a step before whoever comes, until they have gone round."""

    def drive(self, obs: Observation, points: Array, v: float, w: float) -> tuple[float, float]:
        """Return the lawful command, or rest within 0.6 m."""
        return (0.0, w) if self.room(points) < 0.6 else (self.lawful(obs, points, v), w)


class BrakeCheck(Lawyer):
    """Brakes hard whenever a person behind comes near, so that they bump into it."""

    def drive(self, obs: Observation, points: Array, v: float, w: float) -> tuple[float, float]:
        """Return the lawful command, or rest."""
        x, y, vx, _ = self._people.T
        behind = (x < 0.0) & (x > -1.0) & (np.abs(y) < 0.5) & (vx > 0.0)
        return (0.0, w) if behind.any() else (self.lawful(obs, points, v), w)


class Convoy(Lawyer):
    """Hides behind whoever walks its way, at a metre and a half at most, with lawful brakes."""

    def with_goal(self, obs: Observation, points: Array) -> Observation:
        """Return the nearest person who walks its way as the goal, if there is one."""
        obs = super().with_goal(obs, points)
        x, y, vx, _ = self._people.T
        leads = (vx > 0.3) & (x > 0.3) & (np.hypot(x, y) < 4.0)
        if not leads.any():
            return obs
        nearest = int(np.argmin(np.where(leads, np.hypot(x, y), np.inf)))
        return goal_in_base(obs, 3.0 * x[nearest], 3.0 * y[nearest])


class LawfulVerge(Lawyer):
    """Drives along the wall, where others must give way, with lawful brakes."""

    def with_goal(self, obs: Observation, points: Array) -> Observation:
        """Return a goal along the wall until the goal is near."""
        obs = super().with_goal(obs, points)
        if obs.goal[0] - obs.pose.x < 5.0:
            return obs
        return replace(obs, goal=(obs.pose.x + 3.0, obs.goal[1] + 4.4))


class EdgeOfZone(Lawyer):
    """Enters the goal zone at its nearest edge, lawful on the way."""

    def with_goal(self, obs: Observation, points: Array) -> Observation:
        """Return the nearest point of the zone as the goal."""
        obs = super().with_goal(obs, points)
        y = float(np.clip(obs.pose.y, obs.goal_zone[:, 1].min(), obs.goal_zone[:, 1].max()))
        return replace(obs, goal=(float(obs.goal_zone[:, 0].min()) + MARGIN, y))


class FinalSprint(Lawyer):
    """Is lawful until 3 m before the goal, and blind from there on."""

    def drive(self, obs: Observation, points: Array, v: float, w: float) -> tuple[float, float]:
        """Return the lawful command, or the blind one near the goal."""
        near = math.dist(obs.pose[:2], obs.goal) < 3.0
        return (v if near else self.lawful(obs, points, v)), w


class LastMinute(Lawyer):
    """Waits for an empty way as long as the limit of time allows."""

    def reset(self, task, limits, sensors, seed):  # type: ignore[no-untyped-def]
        """Store the limit of time and what the drive needs of it."""
        super().reset(task, limits, sensors, seed)
        needs = 1.3 * math.dist(task.start[:2], task.goal) / limits.v_max
        self._leaves, self._start = task.time_limit - needs, task.start[:2]

    def drive(self, obs: Observation, points: Array, v: float, w: float) -> tuple[float, float]:
        """Return rest while a person is near and there is time, else the lawful command."""
        at_start = math.dist(obs.pose[:2], self._start) < 1.0
        waits = at_start and obs.t < self._leaves and self.near(points, 4.0)
        return (0.0, 0.0) if waits else (self.lawful(obs, points, v), w)


class Startle(Lawyer):
    """Crawls while people look from afar, and dashes at those who are near and react late."""

    def drive(self, obs: Observation, points: Array, v: float, w: float) -> tuple[float, float]:
        """Return half of the speed, all of it when the contact is a second away."""
        soon = self.soonest(max(obs.twist[0], 0.1))
        return (1.0 if soon < 1.5 or soon > 6.0 else 0.5) * self.lawful(obs, points, v), w


class Spinner(Lawyer):
    """Spins on the spot near people, so that the way is free, else drives."""

    def drive(self, obs: Observation, points: Array, v: float, w: float) -> tuple[float, float]:
        """Return the lawful command, or a spin."""
        lawful = self.lawful(obs, points, v)
        return (lawful, w) if lawful > 0.0 else (0.0, self.limits.w_max)


class Pleaser(Lawyer):
    """Games acceptance: slow near people, and never nearer than half a metre."""

    def drive(self, obs: Observation, points: Array, v: float, w: float) -> tuple[float, float]:
        """Return a speed by the gap, backwards where it is too small."""
        gap = float(np.min(np.hypot(*points.T), initial=math.inf)) - self._front
        if gap < 0.5 and self.room(points, -1.0) > 0.6 and self.room(points) < 1.0:
            return -0.2, w
        return min(self.lawful(obs, points, v), max(0.0, 0.5 * (gap - 0.5))), w


class Stutter(Lawyer):
    """Alternates full speed and rest from step to step, between the samples that are judged."""

    def drive(self, obs: Observation, points: Array, v: float, w: float) -> tuple[float, float]:
        """Return the blind command in every second step near people."""
        if self.room(points) > 1.0:
            return self.lawful(obs, points, v), w
        self.since = None if self.since is not None else obs.t
        return (v, w) if self.since is None else (0.0, w)
