"""Stop and go: goal seek with a speed limit that the stop box sets.

The box is as long as the robot's stopping distance, and what somebody who comes towards it walks
until it stands; it shrinks while the robot brakes. The limit below is that rule at every speed at
once: the largest speed whose box is still empty. Who walks out of the way to the side only has to
be out before the robot is there: waiting until the box is empty, it stands a third of its time in
two dense streams.

People who bump into the robot turn it, which its wheels do not notice: it heads by the walls.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from crowdbot.core.interfaces import (
    Array,
    Command,
    LidarPoints,
    Observation,
    Pose,
    RobotLimits,
    SensorInfo,
    Task,
)
from crowdbot.plugins.planners.goal_seek import GoalSeekSpec
from crowdbot.plugins.planners.goal_seek_build import GoalSeek
from crowdbot.plugins.planners.heading_by_walls_build import HeadingByWalls, compile_heading
from crowdbot.plugins.planners.people_build import carry, people_in, with_discs
from crowdbot.plugins.planners.people_motion_build import PeopleMotion
from crowdbot.plugins.planners.robot_outline_build import half_width_and_front
from crowdbot.plugins.planners.stop_and_go import StopAndGoSpec

#: People farther away do not matter yet, m.
_REACH = 4.0
#: So far ahead somebody is believed to walk on as now, s.
_FORESIGHT = 2.0


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
        self._heading_by_walls = HeadingByWalls()
        self._motion = PeopleMotion(spec.look_back)
        self._half_width, self._front = half_width_and_front(spec.robot_radius, None)

    def reset(
        self, task: Task, limits: RobotLimits, sensors: Mapping[str, SensorInfo], seed: int
    ) -> None:
        """Remember what the robot can do and where its lidars are; compile what is not yet."""
        self._seek.reset(task, limits, sensors, seed)
        self._limits = limits
        self._points = LidarPoints(sensors)
        self._half_width, self._front = half_width_and_front(self._spec.robot_radius, task.robot)
        self._heading_by_walls = HeadingByWalls()
        compile_heading()
        self._motion = PeopleMotion(self._spec.look_back)
        for t in (0.0, self._spec.look_back):  # so that no step of the run waits for the compiler
            self._safe_speed(t, Pose(0.0, 0.0, 0.0), np.full((1, 2), 2.0 + t))
        self._motion = PeopleMotion(self._spec.look_back)

    def step(self, obs: Observation) -> Command:
        """Goal seek's command, slowed down or stopped."""
        points = self._points(obs.readings, obs.t, obs.twist, obs.vy)
        pose = self._heading_by_walls.pose(obs.pose, points)
        v, w, _ = self._seek.step(replace(obs, pose=pose))
        most, room = self._safe_speed(obs.t, pose, points)
        obs.log("stop_and_go/room", min(room, 100.0))
        return Command(min(v, most), w)

    def _safe_speed(self, t: float, pose: Pose, points: Array) -> tuple[float, float]:
        """The largest speed whose box is empty (m/s), and the room ahead (m).

        That is how far the robot may go before something is ``front_margin`` before it.

        Args:
            t: now, s.
            pose: of the robot.
            points: (P, 2) what the lidars hit, base frame, m; legs stand for whole people.
        """
        assert self._limits is not None
        spec = self._spec
        people, rest = people_in(points, _REACH if spec.person_radius else 0.0)
        going = self._motion.velocities(t, pose, people)
        points = with_discs(rest, people, spec.person_radius)
        velocities = np.zeros_like(points)
        carry(points, velocities, people, going, spec.person_radius)
        half = self._half_width + spec.side_margin
        inside = (np.abs(points[:, 1]) <= half) & (points[:, 0] > 0)
        approach = np.maximum(0.0, -velocities[inside, 0])
        room = points[inside, 0] - self._front - spec.front_margin
        speeds = safe_speed(room, approach, self._limits.a_max, spec.reaction_time)
        if spec.leaving_margin is not None:
            out = time_out(points[inside, 1], velocities[inside, 1], half) + spec.leaving_margin
            speeds = np.maximum(speeds, passing_speed(room, approach, out))
        return float(speeds.min(initial=math.inf)), float(room.min(initial=math.inf))


def safe_speed(room: Array, approach: Array, deceleration: float, reaction_time: float) -> Array:
    """The largest v at which the robot comes to rest before things that approach; 0 without room.

    With the time T = reaction_time + v / deceleration until it stands, that is the v with
    v * reaction_time + v^2 / (2 * deceleration) + approach * T <= room.

    Args:
        room: (K,) m.
        approach: (K,) speeds towards the robot, m/s.
        deceleration: m/s^2.
        reaction_time: s.
    """
    lag = deceleration * reaction_time + approach
    left = np.maximum(0.0, room - approach * reaction_time)
    return np.asarray(np.sqrt(lag * lag + 2.0 * deceleration * left) - lag)


def time_out(y: Array, sideways: Array, half_width: float) -> Array:
    """When things that walk sideways are out of a lane around the x axis, s; inf if never.

    Args:
        y: (K,) where they are in the lane, m.
        sideways: (K,) their speeds along y, m/s.
        half_width: of the lane, m.
    """
    left = half_width - np.sign(sideways) * y
    moving = sideways != 0.0
    return np.where(moving, left / np.where(moving, np.abs(sideways), 1.0), math.inf)


def passing_speed(room: Array, approach: Array, out: Array) -> Array:
    """The largest v at which the robot is not there before things have gone; 0 without room.

    That is the v with v * out + approach * out <= room.

    Args:
        room: (K,) m.
        approach: (K,) speeds towards the robot, m/s.
        out: (K,) when they are out of its way, s; later than is foreseen counts as never.
    """
    foreseen = np.minimum(out, _FORESIGHT)
    return np.where(out <= _FORESIGHT, np.maximum(0.0, room / foreseen - approach), 0.0)


def build(spec: StopAndGoSpec) -> StopAndGo:
    """A planner from its spec."""
    return StopAndGo(spec)
