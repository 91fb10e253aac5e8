"""Stop and go: goal seek with a speed limit that the stop box sets.

The box is as long as the robot's stopping distance plus the distance that an approaching person
walks until it stands; it shrinks while the robot brakes. The limit below applies that rule to all
speeds at once: the largest speed whose box is still empty.

Boxes turned to either side are checked too. The robot turns towards the one with the fastest
progress to the goal; its speed always depends on the box in front of it.

When people bump into the robot, it turns without its wheels noticing: its heading comes from the
walls.
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

#: People farther away are ignored, m.
_REACH = 6.0
#: Cost of turning a box away from the goal, and away from the last choice, m/s per rad; the second
#: prevents wavering between two gaps.
_ASIDE, _CHANGE = 0.05, 0.1
#: Shares of ``most_aside``: the directions that are checked, straight ahead first.
_SHARES = (0.0, 1 / 4, -1 / 4, 1 / 2, -1 / 2, 3 / 4, -3 / 4, 1.0, -1.0)
#: If the goal's bearing is larger than this, the robot first turns towards it, rad.
_AHEAD = 1.2


@dataclass(frozen=True, slots=True)
class _Scene:
    """Lidar points in the base frame, with discs of people in place of legs."""

    points: Array  # (P, 2), m
    velocities: Array  # (P, 2), m/s


class StopAndGo:
    """Drives as fast as its box allows, towards free space."""

    _limits: RobotLimits  # from `reset` on

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
        self._heading_by_walls = HeadingByWalls()
        self._motion = PeopleMotion(spec.look_back)
        self._half_width, self._front = half_width_and_front(spec.robot_radius, None)
        self._chosen: float | None = None

    def reset(
        self, task: Task, limits: RobotLimits, sensors: Mapping[str, SensorInfo], seed: int
    ) -> None:
        """Store the robot's limits and lidar mounts; compile kernels that are not compiled yet."""
        self._seek.reset(task, limits, sensors, seed)
        self._limits = limits
        self._points = LidarPoints(sensors)
        self._half_width, self._front = half_width_and_front(self._spec.robot_radius, task.robot)
        self._heading_by_walls = HeadingByWalls()
        self._chosen = None
        compile_heading()
        self._motion = PeopleMotion(self._spec.look_back)
        for t in (0.0, self._spec.look_back):  # so that no step of the run waits for compilation
            scene = self._scene(t, Pose(0.0, 0.0, 0.0), np.full((1, 2), 2.0 + t))
            time_to_contact(scene.points, scene.velocities, 1.0, 0.0, self._half_width)
        self._motion = PeopleMotion(self._spec.look_back)

    def step(self, obs: Observation) -> Command:
        """Return goal seek's command towards free space, slowed down or stopped."""
        points = self._points(obs.readings, obs.t, obs.twist, obs.vy)
        pose = self._heading_by_walls.pose(obs.pose, points)
        scene = self._scene(obs.t, pose, points)
        seen = replace(obs, pose=pose)
        turn = self._turn(scene, *bearing(pose, obs.goal), pose.yaw)
        if turn:  # towards a goal at a large angle, turned
            x, y = obs.goal[0] - pose.x, obs.goal[1] - pose.y
            c, s = math.cos(turn), math.sin(turn)
            seen = replace(seen, goal=(pose.x + c * x - s * y, pose.y + s * x + c * y))
        v, w, _ = self._seek.step(seen)
        most, room = self._safe_speed(scene, 0.0)
        obs.draw("box", lambda: self._box(obs.twist[0]))
        obs.log("stop_and_go/room", min(room, 100.0))
        obs.log("stop_and_go/turn", turn)
        return Command(min(v, most), w)

    def _box(self, v: float) -> Array:
        """Return the corners (5, 2), closed, of the box that has to be empty at a speed, m."""
        spec = self._spec
        stopping = abs(v) * (spec.reaction_time + 0.5 * abs(v) / self._limits.a_max)
        long, half = self._front + spec.front_margin + stopping, self._half_width + spec.side_margin
        return np.array([[0.0, half], [long, half], [long, -half], [0.0, -half], [0.0, half]])

    def _scene(self, t: float, pose: Pose, points: Array) -> _Scene:
        """Return discs around legs, and their motion.

        Args:
            t: current time, s.
            pose: the robot's pose.
            points: (P, 2) lidar points, base frame, m.
        """
        radius = self._spec.person_radius
        people, rest = people_in(points, _REACH if radius else 0.0)
        going = self._motion.velocities(t, pose, people)
        points = with_discs(rest, people, radius)
        velocities = np.zeros_like(points)
        carry(points, velocities, people, going, radius)
        return _Scene(points, velocities)

    def _turn(self, scene: _Scene, distance: float, error: float, yaw: float) -> float:
        """Return the angle from the goal's direction to head for, rad.

        Args:
            scene: the surroundings.
            distance: distance to the goal, m; below ``aside_reach`` it goes straight.
            error: angle from the heading to the goal's direction, rad.
            yaw: the robot's yaw, rad.
        """
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
        """Return the largest speed whose box is empty (m/s), and the room ahead (m).

        That is how far the robot may go before something is ``front_margin`` before it.

        Args:
            scene: the surroundings.
            heading: heading of the box, base frame, rad.
        """
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
    """Return the largest v at which the robot stops before approaching things; 0 without room.

    With the time T = reaction_time + v / deceleration until it stands, this is the largest v with v
    * reaction_time + v^2 / (2 * deceleration) + approach * T <= room.

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
    """Return the time until a moving robot and moving points first touch, s; inf if never.

    Points behind it are ignored: people coming from there see the robot.

    Args:
        points: (P, 2) base frame, m.
        velocities: (P, 2) m/s.
        speed: the robot's speed, m/s.
        heading: the robot's heading, base frame, rad.
        radius: radius of the disc that must stay clear, m.
    """
    ahead = np.array([math.cos(heading), math.sin(heading)])
    going = velocities - speed * ahead
    return float(_first_contact(points, going, points @ ahead > 0.0, radius))


@kernel
def _first_contact(points: Array, going: Array, before: Mask, radius: float) -> float:
    """Compute `time_to_contact`.

    ``going`` is relative to the robot, ``before`` selects the points.
    """
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


build = StopAndGo
