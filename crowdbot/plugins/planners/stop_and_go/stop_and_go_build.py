"""Stop and go: goal seek with a speed limit that the stop box sets.

The box is as long as the robot's stopping distance, and what somebody who comes towards it walks
until it stands; it shrinks while the robot brakes. The limit below is that rule at every speed at
once: the largest speed whose box is still empty.

Boxes turned to either side are looked into as well. The robot turns towards the one that lets it
come nearer to the goal faster; how fast it drives is up to the box before it all the while.

People who bump into the robot turn it, which its wheels do not notice: it heads by the walls.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from crowdbot.plugin import (
    Array,
    Command,
    LidarPoints,
    Mask,
    Observation,
    Pose,
    RobotLimits,
    SensorInfo,
    Task,
    kernel,
)
from crowdbot.plugins.planners.goal_seek import GoalSeekSpec
from crowdbot.plugins.planners.goal_seek_build import GoalSeek, bearing
from crowdbot.plugins.planners.shared.heading_by_walls_build import HeadingByWalls, compile_heading
from crowdbot.plugins.planners.shared.people_build import carry, people_in, with_discs
from crowdbot.plugins.planners.shared.people_motion_build import PeopleMotion
from crowdbot.plugins.planners.shared.robot_outline_build import half_width_and_front
from crowdbot.plugins.planners.stop_and_go.stop_and_go import StopAndGoSpec

#: People farther away do not matter yet, m.
_REACH = 6.0
#: What it costs to turn a box away from the goal, and away from that chosen last, m/s per rad:
#: without the second it would waver between two gaps.
_ASIDE, _CHANGE = 0.05, 0.1
#: Of ``most_aside``: the directions that are looked into, straight ahead first.
_SHARES = (0.0, 1 / 4, -1 / 4, 1 / 2, -1 / 2, 3 / 4, -3 / 4, 1.0, -1.0)
#: With the goal farther off than this it turns towards it first, rad.
_AHEAD = 1.2


@dataclass(frozen=True, slots=True)
class _Scene:
    """What the lidars hit, base frame; legs stand for whole people."""

    points: Array  # (P, 2), m
    velocities: Array  # (P, 2), m/s


class StopAndGo:
    """Drives as fast as the box before it allows, towards where there is room."""

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
        self._chosen: float | None = None

    def reset(
        self, task: Task, limits: RobotLimits, sensors: Mapping[str, SensorInfo], seed: int
    ) -> None:
        """Remember what the robot can do and where its lidars are; compile what is not yet."""
        self._seek.reset(task, limits, sensors, seed)
        self._limits = limits
        self._points = LidarPoints(sensors)
        self._half_width, self._front = half_width_and_front(self._spec.robot_radius, task.robot)
        self._heading_by_walls = HeadingByWalls()
        self._chosen = None
        compile_heading()
        self._motion = PeopleMotion(self._spec.look_back)
        for t in (0.0, self._spec.look_back):  # so that no step of the run waits for the compiler
            scene = self._scene(t, Pose(0.0, 0.0, 0.0), np.full((1, 2), 2.0 + t))
            time_to_contact(scene.points, scene.velocities, 1.0, 0.0, self._half_width)
        self._motion = PeopleMotion(self._spec.look_back)

    def step(self, obs: Observation) -> Command:
        """Goal seek's command towards where there is room, slowed down or stopped."""
        points = self._points(obs.readings, obs.t, obs.twist, obs.vy)
        pose = self._heading_by_walls.pose(obs.pose, points)
        scene = self._scene(obs.t, pose, points)
        seen = replace(obs, pose=pose)
        turn = self._turn(scene, *bearing(pose, obs.goal), pose.yaw)
        if turn:  # towards a goal that far off, turned
            x, y = obs.goal[0] - pose.x, obs.goal[1] - pose.y
            c, s = math.cos(turn), math.sin(turn)
            seen = replace(seen, goal=(pose.x + c * x - s * y, pose.y + s * x + c * y))
        v, w, _ = self._seek.step(seen)
        most, room = self._safe_speed(scene, 0.0)
        obs.log("stop_and_go/room", min(room, 100.0))
        obs.log("stop_and_go/turn", turn)
        return Command(min(v, most), w)

    def _scene(self, t: float, pose: Pose, points: Array) -> _Scene:
        """Discs around legs, and how they move.

        Args:
            t: now, s.
            pose: of the robot.
            points: (P, 2) what the lidars hit, base frame, m.
        """
        radius = self._spec.person_radius
        people, rest = people_in(points, _REACH if radius else 0.0)
        going = self._motion.velocities(t, pose, people)
        points = with_discs(rest, people, radius)
        velocities = np.zeros_like(points)
        carry(points, velocities, people, going, radius)
        return _Scene(points, velocities)

    def _turn(self, scene: _Scene, distance: float, error: float, yaw: float) -> float:
        """How far from the goal's direction to head, rad.

        Args:
            scene: what is around.
            distance: to the goal, m; nearer than ``aside_reach`` it goes straight.
            error: from the heading to the goal's direction, rad.
            yaw: of the robot, rad.
        """
        assert self._limits is not None
        spec = self._spec
        near = distance < spec.aside_reach
        if abs(error) > _AHEAD or near or spec.most_aside == 0.0:
            self._chosen = None
            return 0.0
        best, turn = -math.inf, 0.0
        cruise, clear = self._limits.v_max * spec.speed, self._half_width + spec.side_margin
        for share in _SHARES:
            aside = share * spec.most_aside
            heading = yaw + error + aside
            last = heading if self._chosen is None else self._chosen
            free = min(self._safe_speed(scene, error + aside)[0] / cruise, 1.0)
            if spec.look_ahead > 0.0:
                away = time_to_contact(scene.points, scene.velocities, cruise, error + aside, clear)
                free = min(free, away / spec.look_ahead)
            change = abs(math.remainder(heading - last, 2.0 * math.pi))
            value = cruise * free * math.cos(aside) - _ASIDE * abs(aside) - _CHANGE * change
            if value > best + 1e-9:
                best, turn = value, aside
        self._chosen = yaw + error + turn
        return turn

    def _safe_speed(self, scene: _Scene, heading: float) -> tuple[float, float]:
        """The largest speed whose box is empty (m/s), and the room ahead (m).

        That is how far the robot may go before something is ``front_margin`` before it.

        Args:
            scene: what is around.
            heading: of the box, base frame, rad.
        """
        assert self._limits is not None
        spec = self._spec
        c, s = math.cos(heading), math.sin(heading)
        ahead, left = np.array([c, s]), np.array([-s, c])
        x, y = scene.points @ ahead, scene.points @ left
        inside = (np.abs(y) <= self._half_width + spec.side_margin) & (x > 0)
        approach = np.maximum(0.0, -(scene.velocities[inside] @ ahead))
        room = x[inside] - self._front - spec.front_margin
        speeds = safe_speed(room, approach, self._limits.a_max, spec.reaction_time)
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


def time_to_contact(
    points: Array, velocities: Array, speed: float, heading: float, radius: float
) -> float:
    """When a robot that drives on and things that go on first touch, s; infinite: never.

    What is behind it does not count: who comes from there sees the robot.

    Args:
        points: (P, 2) base frame, m.
        velocities: (P, 2) m/s.
        speed: of the robot, m/s.
        heading: of the robot, base frame, rad.
        radius: of the disc that is to stay clear, m.
    """
    ahead = np.array([math.cos(heading), math.sin(heading)])
    going = velocities - speed * ahead
    return float(_first_contact(points, going, points @ ahead > 0.0, radius))


@kernel
def _first_contact(points: Array, going: Array, before: Mask, radius: float) -> float:
    """Of `time_to_contact`; ``going`` is relative to the robot, ``before`` says what counts."""
    first = math.inf
    for k in range(points.shape[0]):
        if not before[k]:
            continue
        x, y, vx, vy = points[k, 0], points[k, 1], going[k, 0], going[k, 1]
        a, b = vx * vx + vy * vy, -(x * vx + y * vy)
        root = b * b - a * (x * x + y * y - radius * radius)
        if b > 0.0 and root >= 0.0:
            first = min(first, max(0.0, (b - math.sqrt(root)) / a))
    return first


def build(spec: StopAndGoSpec) -> StopAndGo:
    """A planner from its spec."""
    return StopAndGo(spec)
