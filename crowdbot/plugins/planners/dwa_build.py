"""DWA: see, choose a direction, choose a velocity."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Mapping
from dataclasses import replace

import numpy as np

import crowdbot.plugins.planners.dwa_rollout_build as rollout
from crowdbot.core.support.immutable import immutable
from crowdbot.plugin import (
    Array,
    Command,
    LidarPoints,
    Observation,
    Pose,
    Reading,
    RobotLimits,
    SensorInfo,
    Task,
)
from crowdbot.plugins.planners.dwa import DwaSpec
from crowdbot.plugins.planners.dwa_evaluate_build import evaluate
from crowdbot.plugins.planners.dwa_map_build import AIM, remembered, way_out
from crowdbot.plugins.planners.dwa_points_build import (
    apart,
    apparent_velocities,
    choose_direction,
    nearest_per_sector,
    walkers,
)
from crowdbot.plugins.planners.goal_seek_build import bearing, braking_speed
from crowdbot.plugins.planners.heading_by_walls_build import HeadingByWalls, compile_heading
from crowdbot.plugins.planners.lidar_views_build import LidarViews
from crowdbot.plugins.planners.manoeuvring_build import Manoeuvring
from crowdbot.plugins.planners.people_build import carry, people_and_points, with_discs
from crowdbot.plugins.planners.robot_outline_build import core_of, disc_radius, swept_half_width

_SECTORS = 240
#: Points farther away play no part, m.
_REACH = 6.0
#: Apparent motion below this is sampling noise, m/s.
_STILL = 0.3
_ARRIVED = 0.1
#: A direction must be wider than the margin by this, m; that of a robot with an outline, which is
#: as wide only if it heads there, by this.
_LEEWAY, _OUTLINED_LEEWAY = 0.05, 0.01
#: The map is renewed so often while it is needed, s.
_MAP_PERIOD = 0.5
#: People in that map have this share of their radius.
_MAPPED = 0.5
#: Legs of a person who walks are so near to the middle, m.
_LEGS = 0.4
#: Somebody who walks within this distance is what the robot waits for, m.
_NEARBY = 4.0
#: Who is faster walks (m/s); so long (s) and such a share of those nearby make it a flow.
_WALKS, _SETTLES, _MOST = 0.5, 1.0, 0.4
#: Share of that time that does not count as time without progress.
_WAITING = 0.8
#: Speed and duration of the way back out of a dead end: m/s, s.
_REVERSE, _ESCAPE = -0.2, 2.0


class Dwa:
    """Remembers old scans, its last choice, since when it makes no way, and then a small map."""

    def __init__(self, spec: DwaSpec) -> None:
        self._spec = spec
        self._lidars = LidarPoints({})
        self._limits: RobotLimits | None = None
        self._core, _ = core_of(spec.robot_radius, None)
        self._half_width = disc_radius(spec.robot_radius, None)
        self._sideways = False
        self._manoeuvring: Manoeuvring | None = None
        self._p: Array = np.zeros(rollout.PARAMETERS)
        self._forget()

    def _forget(self) -> None:
        self._scans: deque[tuple[float, Array, Array]] = deque(maxlen=64)
        self._map: Array = np.empty((0, 2))
        nothing = np.empty((0, 2))
        self._around: tuple[Array, Array, Array] = nothing, nothing, nothing
        self._stands, self._walkers = np.empty((0, 2)), np.empty((0, 4))
        self._walking, self._flow = False, 0.0
        self._heading_by_walls = HeadingByWalls()
        self._mapped_at = -math.inf
        if self._manoeuvring is not None:
            self._manoeuvring.forget()
        self._way: float | None = None
        self._last = (0.0, 0.0, 0.0)
        self._heading: float | None = None
        self._time: float | None = None
        self._moved_at: tuple[float, float, float] | None = None
        self._escape_until = -math.inf
        self._nearest: tuple[float, float] | None = None
        self._lost = False

    def reset(
        self, task: Task, limits: RobotLimits, sensors: Mapping[str, SensorInfo], seed: int
    ) -> None:
        """Take the limits and mounts; compile what is not compiled yet."""
        del seed
        self._forget()
        self._limits = limits
        self._lidars = LidarPoints(sensors)
        self._half_width = swept_half_width(self._spec.robot_radius, task.robot)
        self._core, rounding = core_of(self._spec.robot_radius, task.robot)
        self._sideways = limits.vy_max > 0.0
        self._p = _parameters(self._spec, limits, rounding)
        self._p[rollout.REACH] = disc_radius(self._spec.robot_radius, task.robot)
        long = len(self._core) > 0 and not self._sideways  # it does not fit in every heading
        person = self._spec.person_radius
        views = LidarViews(sensors)
        made = Manoeuvring(self._core, self._p, limits, views, person, _REACH) if long else None
        self._manoeuvring = made
        self._warm_up(task, sensors)
        self._forget()

    def _warm_up(self, task: Task, sensors: Mapping[str, SensorInfo]) -> None:
        """Two steps in a made-up world, so that no step of the run waits for a compiler."""
        way_out(np.ones((1, 2)), 0.0, 0.0, 9.0, 0.0, 99.0)  # no way at all is soon found
        apart(np.ones((1, 2)), np.ones((1, 2)), _LEGS)
        nearest_per_sector(with_discs(np.ones((1, 2)), np.ones((1, 2)), 0.1), _SECTORS, _REACH)
        compile_heading()
        for t in (0.0, self._spec.look_back):
            readings = {
                n: Reading(t, immutable(np.full(s.shape, 1.0 + t))) for n, s in sensors.items()
            }
            self.step(
                Observation(
                    t=t,
                    pose=Pose(0.0, 0.0, 0.0),
                    twist=(0.0, 0.0),
                    goal=(9.0, 0.0),
                    goal_zone=task.goal_zone,
                    readings=readings,
                )
            )

    def step(self, obs: Observation) -> Command:
        """The next command; zero at the goal."""
        assert self._limits is not None
        seen = self._lidars(obs.readings, obs.t, obs.twist, obs.vy)
        pose = self._heading_by_walls.pose(obs.pose, seen)
        distance, goal = bearing(pose, obs.goal)
        period = 1.0 / 16.0 if self._time is None else max(1e-3, obs.t - self._time)
        self._time = obs.t
        self._p[rollout.PERIOD] = period
        if distance <= _ARRIVED:
            return Command(0.0, 0.0)
        points, velocities = self._see(obs.t, pose, seen)
        self._wait(period)
        escaping = self._is_stuck(obs.t, pose)
        room = distance
        self._lost = self._is_lost(distance)
        if self._manoeuvring is not None and (self._lost or escaping or self._manoeuvring):
            self._lost = True
            seen_now = replace(obs, pose=pose)
            found = self._manoeuvring.command(seen_now, self._stands, self._walkers)
            if found is not None:
                self._last = found
                return Command(*found)
            beside = self._manoeuvring.beside(pose)
            points = np.concatenate([points, beside])
            velocities = np.concatenate([velocities, np.zeros_like(beside)])
        if self._lost:
            goal, room = self._way_out(obs, pose, goal, distance)
        else:
            self._map, self._way = np.empty((0, 2)), None
            if self._manoeuvring is not None:
                self._manoeuvring.forget()
        direction, free = self._choose(pose, goal, room, points, velocities, escaping)
        top = min(
            self._spec.speed * self._limits.v_max, braking_speed(distance, self._limits.a_max)
        )
        if self._sideways:
            candidates, facing = self._window_aside(obs, direction, goal, top), goal
        else:
            candidates, facing = self._window(obs.twist, direction, top, escaping), direction
        now = (*obs.twist, obs.vy)
        index, _ = evaluate(
            points,
            velocities,
            self._p,
            self._core,
            now,
            candidates,
            direction,
            facing,
            self._last,
        )
        chosen = candidates[index].tolist() if index >= 0 else [0.0, 0.0]
        self._last = (chosen[0], chosen[1], chosen[2] if len(chosen) > 2 else 0.0)
        obs.log("dwa/direction", direction)
        obs.log("dwa/free_time", free)
        return Command(*self._last)

    def _see(self, t: float, pose: Pose, seen: Array) -> tuple[Array, Array]:
        """Thinned points and their velocities (K, 2), base frame."""
        radius = self._spec.person_radius
        people, rest, points = people_and_points(seen, _REACH, radius, _SECTORS)
        velocities, going = np.zeros(points.shape), np.zeros(people.shape)
        self._around = rest, people, going
        self._stands, self._walkers = seen, np.empty((0, 4))
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
                self._stand_apart(rest, people, going)
                if self._manoeuvring is not None:
                    walk = np.hypot(going[:, 0], going[:, 1]) > 0.0
                    self._stands = seen[apart(seen, people[walk], _LEGS)]
                    self._walkers = np.column_stack([people, going])[walk]
        self._scans.append((t, now, middles))
        return points, velocities

    def _stand_apart(self, rest: Array, people: Array, going: Array) -> None:
        """Note whether those nearby walk; while they do, keep for the map only what stands.

        Legs that are paired now one way, now another, seem to move: one step proves nothing.
        """
        near, walk = walkers(people, going, _NEARBY, _WALKS)
        share = walk / near if near else self._flow
        self._flow += min(1.0, float(self._p[rollout.PERIOD]) / _SETTLES) * (share - self._flow)
        self._walking = self._flow > _MOST
        if self._walking:
            self._around = rest, people, going

    def _choose(
        self,
        pose: Pose,
        goal: float,
        room: float,
        points: Array,
        velocities: Array,
        escaping: bool,
    ) -> tuple[float, float]:
        assert self._limits is not None
        spec = self._spec
        speed = spec.speed * self._limits.v_max
        leeway = _OUTLINED_LEEWAY if len(self._core) else _LEEWAY
        previous = goal if self._heading is None else self._heading - pose.yaw
        direction, free = choose_direction(
            points,
            velocities,
            goal,
            previous,
            speed,
            self._half_width + spec.margin + (leeway if self._way is None else 0.0),
            min(spec.look_ahead, room / speed + 0.1),
            0.2 if escaping else 1.0,
            spec.swerve if self._walking and not escaping else math.pi,
            spec.hold if self._walking else 0.5 * spec.hold,
        )
        self._heading = direction + pose.yaw
        return direction, free

    def _window(
        self, twist: tuple[float, float], direction: float, top: float, escaping: bool
    ) -> Array:
        """(C, 2) target velocities that the robot reaches within the window."""
        assert self._limits is not None
        spec, limits = self._spec, self._limits
        v, w = twist
        dv, dw = limits.a_max * spec.window, limits.alpha_max * spec.window
        bottom = max(limits.v_min, _REVERSE) if escaping else 0.0
        low = min(max(v - dv, bottom), top)
        high = max(min(v + dv, top), low)
        left, right = max(w - dw, -limits.w_max), min(w + dw, limits.w_max)
        wish = max(left, min(right, 1.5 * direction_error(direction)))
        return rollout.candidates(low, high, spec.speeds, left, right, spec.yaw_rates, wish)

    def _window_aside(self, obs: Observation, direction: float, goal: float, top: float) -> Array:
        """(C, 3) target velocities of a robot that goes sideways and looks to the goal."""
        assert self._limits is not None
        spec, limits, w = self._spec, self._limits, obs.twist[1]
        dw = limits.alpha_max * spec.window
        left, right = max(w - dw, -limits.w_max), min(w + dw, limits.w_max)
        wish, still = (max(left, min(right, r)) for r in (1.5 * direction_error(goal), 0.0))
        now, change = (obs.twist[0], obs.vy), limits.a_max * spec.window
        rates = np.array([wish, still, left, right])
        return rollout.candidates_aside(now, change, top, spec.speeds, direction, rates)

    def _wait(self, period: float) -> None:
        """Let time without progress count less while somebody walks nearby, who will be gone."""
        if not self._walking:
            return
        if self._moved_at is not None:
            x, y, since = self._moved_at
            self._moved_at = (x, y, since + _WAITING * period)
        if self._nearest is not None:
            self._nearest = (self._nearest[0], self._nearest[1] + _WAITING * period)

    def _is_lost(self, distance: float) -> bool:
        """Whether the robot has come no nearer to the goal for long: it needs a map."""
        now = 0.0 if self._time is None else self._time
        # A manoeuvre is not over where the robot comes nearer, but where it is through.
        long = self._lost and self._manoeuvring is not None
        gain = 2.0 * float(self._p[rollout.REACH]) if long else 0.3
        if self._nearest is None or distance < self._nearest[0] - gain:
            self._nearest = (distance, now)
        return now - self._nearest[1] > 2.0 * self._spec.patience

    def _way_out(
        self, obs: Observation, pose: Pose, goal: float, distance: float
    ) -> tuple[float, float]:
        """Bearing and length of the first stretch past everything that stands around.

        Those of the goal if there is no way.
        """
        x, y, yaw = pose
        if obs.t - self._mapped_at >= _MAP_PERIOD:
            self._mapped_at = obs.t
            c, s = math.cos(yaw), math.sin(yaw)
            # Of one who stands sideways one leg is seen, and the disc is too near: no way would
            # be left in a map that remembers discs at their full size.
            rest, people, going = self._around
            walk = np.hypot(going[:, 0], going[:, 1]) > 0.0
            rest = rest[apart(rest, people[walk], _LEGS)]
            discs = with_discs(rest, people[~walk], _MAPPED * self._spec.person_radius)
            points = nearest_per_sector(discs, _SECTORS, _REACH)
            seen = points @ np.array([[c, s], [-s, c]]) + (x, y)
            self._map = remembered(self._map, seen, x, y, _REACH)
            for room in (self._spec.margin + 0.02, *([0.01] if len(self._core) else [])):
                found, way = way_out(self._map, x, y, *obs.goal, self._half_width + room)
                self._way = way if found else None
                if found:
                    break
        return (goal, distance) if self._way is None else (self._way - yaw, min(AIM, distance))

    def _is_stuck(self, t: float, pose: Pose) -> bool:
        x, y, _ = pose
        if self._moved_at is None or math.dist(self._moved_at[:2], (x, y)) > 0.15:
            self._moved_at = (x, y, t)
        elif t - self._moved_at[2] > self._spec.patience:
            self._escape_until = t + _ESCAPE
            self._moved_at = (x, y, t)
        return t < self._escape_until


def direction_error(direction: float) -> float:
    """A bearing in [-pi, pi]."""
    return math.remainder(direction, 2.0 * math.pi)


def _parameters(spec: DwaSpec, limits: RobotLimits, radius: float) -> Array:
    p = np.zeros(rollout.PARAMETERS)
    p[rollout.A_MAX], p[rollout.ALPHA_MAX] = limits.a_max, limits.alpha_max
    p[rollout.V_MAX], p[rollout.W_MAX] = limits.v_max, limits.w_max
    p[rollout.HORIZON], p[rollout.TURN_TIME] = spec.horizon, spec.turn_time
    p[rollout.RADIUS], p[rollout.MARGIN] = radius, spec.margin
    p[rollout.COMFORT], p[rollout.GROWTH] = spec.comfort, spec.margin_growth
    p[rollout.PROGRESS], p[rollout.HEADING] = spec.progress, spec.heading
    p[rollout.CLEARANCE], p[rollout.IMPACT] = spec.clearance, spec.impact
    p[rollout.SMOOTHNESS] = spec.smoothness
    return p


def build(spec: DwaSpec) -> Dwa:
    """A planner from its spec."""
    return Dwa(spec)
