"""A planner for goals that are people: drives to its place beside the person, and turns to it."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from crowdbot.plugin import (
    Array,
    Command,
    LidarPoints,
    Observation,
    PersonEstimate,
    RobotLimits,
    SensorInfo,
    Task,
)

ROOM = 0.6  # m, between the person and a way around
AHEAD = 0.5  # s, for which the person is expected to walk on
LOOKS = 1.0  # s, after which one who did not walk is taken to stand
STEPS = 0.6  # m, that one who stands may seem to move
MOST = 0.03  # m, that one who stands moves in a step


class Companion:
    """Goes around the person, not past it, and keeps away from what its lidars see."""

    needs = ("lidar",)

    def reset(
        self, task: Task, limits: RobotLimits, sensors: Mapping[str, SensorInfo], seed: int
    ) -> None:
        if task.person is None or task.robot is None:
            raise ValueError("Companion is for tasks about people")
        self.person, self.body = task.person, task.robot
        self.limits, self.points = limits, LidarPoints(sensors)
        self.seen: list[PersonEstimate] = []
        self.since, self.stands = 0.0, False

    def step(self, obs: Observation) -> Command:
        person, pose = obs.person, obs.pose
        assert person is not None  # as the task is about a person
        at, goal = np.array([pose.x, pose.y]), np.array(obs.goal)
        if self.person.kind == "approach":
            person = self.remembered(obs, person)
            goal = self.front(at, person)
        who = np.array([person.x, person.y])
        aim = self.around(at, who, goal)
        walk = np.array([person.vx, person.vy]) if self.person.kind != "lead" else np.zeros(2)
        way = aim + AHEAD * walk - at
        c, s = math.cos(pose.yaw), math.sin(pose.yaw)
        way = np.array([c * way[0] + s * way[1], c * way[1] - s * way[0]])
        distance = math.hypot(*way)
        speed = min(self.limits.v_max, distance, self.free(obs, way / max(distance, 1e-9)))
        v, vy = speed * way / max(distance, 1e-9)
        turn = math.remainder(self.heading(at, who, person, goal) - pose.yaw, 2.0 * math.pi)
        if self.body.drive != "holonomic":
            bearing = math.atan2(way[1], way[0])
            turn = bearing if distance > 0.4 else turn
            v, vy = speed * max(0.0, math.cos(bearing)), 0.0
        return Command(v, 2.0 * turn, vy)

    def remembered(self, obs: Observation, person: PersonEstimate) -> PersonEstimate:
        """Return the person; one who stood at first is not taken for a passer-by who walks off."""
        if not self.stands:
            if not self.seen:
                self.seen, self.since = [], obs.t
            self.seen.append(person)
            first = self.seen[0]
            moved = math.hypot(person.x - first.x, person.y - first.y)
            if moved > STEPS:
                self.seen, self.since = [], obs.t
            self.stands = bool(self.seen) and obs.t - self.since >= LOOKS
            return person
        self.seen[-1] = self.looked_at(obs, self.seen[-1])
        return self.seen[-1]

    def looked_at(self, obs: Observation, person: PersonEstimate) -> PersonEstimate:
        """Return one who stands where the lidars see a body there; it moves slowly at most."""
        c, s = math.cos(obs.pose.yaw), math.sin(obs.pose.yaw)
        points = self.points(obs.readings, obs.t, obs.twist, obs.vy)
        seen = points @ np.array([[c, s], [-s, c]]) + (obs.pose.x, obs.pose.y)
        who = np.array([person.x, person.y])
        near = seen[np.hypot(*(seen - who).T) < self.person.radius + 0.5]
        if len(near) < 3:
            return person
        middle = near.mean(axis=0)
        out = middle - (obs.pose.x, obs.pose.y)
        off = middle + 0.2 * out / max(math.hypot(*out), 1e-9) - who
        who = who + off * min(1.0, MOST / max(math.hypot(*off), 1e-9))
        return replace(person, x=float(who[0]), y=float(who[1]))

    def front(self, at: Array, person: PersonEstimate) -> Array:
        """Return the place before the person; of one without a front, on the robot's side."""
        ahead = person.heading
        if math.isnan(ahead):
            ahead = math.atan2(at[1] - person.y, at[0] - person.x)
        away = self.person.radius + self.person.distance + self.body.front
        return np.array([person.x + away * math.cos(ahead), person.y + away * math.sin(ahead)])

    def around(self, at: Array, who: Array, goal: Array) -> Array:
        """Return the goal, or a point beside the person if the person is in the way."""
        away = self.person.radius + self.body.radius + ROOM
        way = goal - at
        along = np.clip(np.dot(who - at, way) / max(np.dot(way, way), 1e-9), 0.0, 1.0)
        nearest = at + along * way
        gap = math.dist(nearest, who)
        if gap >= away or along in (0.0, 1.0):
            return goal
        aside = (nearest - who) / gap if gap > 0.05 else np.array([-way[1], way[0]])
        return who + 1.2 * away * aside / math.hypot(*aside)

    def heading(self, at: Array, who: Array, person: PersonEstimate, goal: Array) -> float:
        """Return where to look: to the person, or where both go."""
        kind = self.person.kind
        if kind == "lead":
            return (
                math.atan2(goal[1] - at[1], goal[0] - at[0]) if math.dist(goal, at) > 0.2 else 0.0
            )
        if kind == "accompany" and math.dist(goal, at) < 1.0 and not math.isnan(person.heading):
            return person.heading
        return math.atan2(who[1] - at[1], who[0] - at[0])

    def free(self, obs: Observation, way: Array) -> float:
        """Return the speed at which the robot can stop before the next thing on its way, m/s."""
        points = self.points(obs.readings, obs.t, obs.twist, obs.vy)
        along, across = points @ way, np.abs(points @ np.array([-way[1], way[0]]))
        radius = self.body.radius
        ahead = along[(along > 0.0) & (across < radius + 0.15)] - radius - 0.15
        room = max(0.0, float(ahead.min(initial=9.0)))
        return math.sqrt(self.limits.a_max * room)
