"""Stop and go: goal seek with a speed limit that the stop box sets.

The box is as long as the robot's stopping distance, which shrinks while the robot brakes. The
limit below is that rule at every speed at once: the largest speed whose box is still empty.
"""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from crowdbot.core.interfaces import (
    Array,
    Command,
    LidarPoints,
    Observation,
    RobotLimits,
    SensorInfo,
    Task,
)
from crowdbot.plugins.planners.goal_seek import GoalSeekSpec
from crowdbot.plugins.planners.goal_seek_build import GoalSeek
from crowdbot.plugins.planners.people_build import people_in, with_discs
from crowdbot.plugins.planners.robot_outline_build import half_width_and_front
from crowdbot.plugins.planners.stop_and_go import StopAndGoSpec

#: People farther away do not matter yet, m.
_REACH = 4.0


class StopAndGo:
    """Never steers around anything."""

    def __init__(self, spec: StopAndGoSpec) -> None:
        self._spec = spec
        self._seek = GoalSeek(
            GoalSeekSpec(
                speed=spec.speed,
                heading_gain=spec.heading_gain,
                turn_in_place=spec.turn_in_place,
            )
        )
        self._points = LidarPoints({})
        self._limits: RobotLimits | None = None
        self._half_width, self._front = half_width_and_front(spec.robot_radius, None)

    def reset(
        self, task: Task, limits: RobotLimits, sensors: Mapping[str, SensorInfo], seed: int
    ) -> None:
        """Remember what the robot can do and where its lidars are; compile what is not yet."""
        self._seek.reset(task, limits, sensors, seed)
        self._limits = limits
        self._points = LidarPoints(sensors)
        self._half_width, self._front = half_width_and_front(self._spec.robot_radius, task.robot)
        self._room_ahead(np.ones((1, 2)))  # so that no step of the run waits for the compiler

    def step(self, obs: Observation) -> Command:
        """Goal seek's command, slowed down or stopped."""
        assert self._limits is not None
        v, w, _ = self._seek.step(obs)
        points = self._points(obs.readings, obs.t, obs.twist)
        room = self._room_ahead(points)
        obs.log("stop_and_go/room", min(room, 100.0))
        return Command(min(v, safe_speed(room, self._limits.a_max, self._spec.reaction_time)), w)

    def _room_ahead(self, points: Array) -> float:
        """How far the robot may go before something is ``front_margin`` before it, m.

        Args:
            points: (P, 2) what the lidars hit, base frame, m; legs stand for whole people.
        """
        spec = self._spec
        people, rest = people_in(points, _REACH if spec.person_radius else 0.0)
        points = with_discs(rest, people, spec.person_radius)
        beside = np.abs(points[:, 1]) <= self._half_width + spec.side_margin
        ahead = points[beside & (points[:, 0] > 0.0), 0]
        nearest = float(ahead.min()) if len(ahead) else math.inf
        return nearest - self._front - spec.front_margin


def safe_speed(room: float, deceleration: float, reaction_time: float) -> float:
    """The largest v with v * reaction_time + v^2 / (2 * deceleration) <= room; 0 without room."""
    if room <= 0.0:
        return 0.0
    lag = deceleration * reaction_time
    return math.sqrt(lag * lag + 2.0 * deceleration * room) - lag


def build(spec: StopAndGoSpec) -> StopAndGo:
    """A planner from its spec."""
    return StopAndGo(spec)
