"""Detect a robot that pushes without moving, remember the place, and drive away from it.

A barrier that no lidar sees, such as a kerb or a raised gate, stops the robot while its wheels slip
or stall. Four signs show this: the scan stays the same although the wheels roll, the wheels hardly
roll although they are commanded to, the IMU measures a jolt that no command causes, or a bumper is
pressed. Barriers that a lidar sees are ignored here: avoiding those is the planner's own task.
"""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from crowdbot.plugin import Array, Command, Mask, Observation, Pose, RobotBody, SensorInfo, kernel
from crowdbot.plugins.planners.shared.robot_outline_build import disc_radius

#: The wheels roll this far between two scans that are compared (m), in this time at most (s).
_ROLLED, _PATIENCE = 0.35, 3.0
#: About this number of points of the earlier scan are compared.
_SAMPLE, _REACH = 150, 10.0
#: A point counts for the hypothesis that it fits better by this plus a share of its distance, m.
_CLEAR, _CLEAR_SHARE = 0.06, 0.02
#: Least number of points that say that the robot stands, per point that says that it moves.
_STILL, _MOST = 12, 3
#: The least number of them on surfaces wider than people, who may walk beside the robot; m.
_STILL_WIDE, _WIDE = 8, 1.0
#: Neighbouring points nearer than this plus a share of their distance are of one surface, m.
_GAP, _GAP_SHARE = 0.1, 0.03
#: Commanded way (m) on which stalled wheels roll no farther than the second number.
_COMMANDED, _STALLED = 0.5, 0.05
#: A jolt: horizontal specific force above any command's, m/s^2; how long it counts, s.
_JOLT, _JOLTED = 6.0, 2.0
#: Time for which a bumper is pressed before it counts, s.
_PRESSED = 0.25
#: A lidar point nearer to the front than this explains why the robot stands, m.
_SEEN = 0.12
#: Speed (m/s), way (m) and longest time (s) of backing off; room behind for it, m.
_BACK, _WAY_BACK, _BACK_TIME, _ROOM = 0.2, 0.4, 5.0, 0.1
#: The remembered place lies this far before the outline, with points at this distance, m.
_AHEAD, _SPACING = 0.03, 0.05
#: Places nearer than this belong to one barrier: each doubles the width of the next, m.
_SAME, _WIDEST = 1.5, 1.6
#: Places are forgotten once the robot has stayed within this radius (m) for this time (s).
_STAYED, _FORGET = 0.2, 10.0
_NOTHING = np.empty((0, 2))


class Stuck:
    """Monitors a robot, and remembers the places where it pushed without moving.

    Args:
        spec_radius: radius of the robot from the planner's spec, m, or None.
        body: of the robot.
        sensors: description of each sensor that the planner gets.
        slips: False if poses are the truth, which slipping wheels do not change.

    Attributes:
        places: (K, 2) remembered barriers, in the frame of the corrected pose, m.
        count: how often the robot was found to push.
    """

    def __init__(
        self,
        spec_radius: float | None = None,
        body: RobotBody | None = None,
        sensors: Mapping[str, SensorInfo] | None = None,
        *,
        slips: bool = True,
    ) -> None:
        radius = disc_radius(spec_radius, body)
        known = body is not None and spec_radius is None
        self._front, self._back = (body.front, body.back) if known and body else (radius, radius)
        self._half_width = body.half_width if known and body else radius
        self._felt = _Felt(sensors or {})
        self.places, self.count = _NOTHING, 0
        self._centres: list[tuple[float, float]] = []
        self._slips, self._slip = slips, (0.0, 0.0)
        self._commanded = 0.0
        self._back_from: tuple[float, Pose, float] | None = None
        self._start: tuple[Observation, Pose, Array, Mask] | None = None
        self._held: Pose | None = None
        self._stays: tuple[float, Pose] | None = None

    def see(self, obs: Observation, pose: Pose, points: Array) -> tuple[Pose, Array]:
        """Return the pose without slip, and the points with the remembered places.

        Args:
            obs: of this step.
            pose: by odometry, perhaps with the heading of walls; a frame at rest.
            points: (P, 2) lidar points, base frame, m.

        Returns:
            the pose; (Q, 2) base frame, m. Both are unchanged where nothing was pushed.
        """
        if self.count:
            pose = Pose(pose.x + self._slip[0], pose.y + self._slip[1], pose.yaw)
        self._felt.note(obs)
        if self._back_from is None:
            pose = self._watch(obs, pose, points)
        elif obs.twist[0] * self._back_from[2] <= 0.0:  # wheels that slow down slip on
            pose = self._hold(pose, self._back_from[1])
        if not len(self.places) or self._forgets(obs.t, pose):
            return pose, points
        return pose, self._with_places(pose, points)

    def _forgets(self, t: float, pose: Pose) -> bool:
        """Forget the places of a robot that stays among them: they may be wider than what is there.

        Where it pushed is not forgotten: the next barrier there is as wide.
        """
        since = self._stays
        if since is None or math.hypot(pose.x - since[1].x, pose.y - since[1].y) > _STAYED:
            self._stays = (t, pose)
        elif t - since[0] > _FORGET:
            self.places, self._stays = _NOTHING, None
            return True
        return False

    def way_back(self, obs: Observation, pose: Pose, points: Array) -> Command | None:
        """Return the command that drives away from a barrier; None without one.

        Args:
            obs: of this step.
            pose, points: from `see`.
        """
        if self._back_from is None:
            return None
        since, place, way = self._back_from
        gone = math.hypot(pose.x - place.x, pose.y - place.y)
        free = self._front if way > 0.0 else self._back
        if (
            gone >= _WAY_BACK
            or obs.t - since >= _BACK_TIME
            or self._blocked(points, way, free + _ROOM)
        ):
            self._back_from = self._start = None
            return None
        obs.log("stuck/backing_off", 1.0)
        return Command(way * _BACK, 0.0)

    def _with_places(self, pose: Pose, points: Array) -> Array:
        c, s = math.cos(pose.yaw), math.sin(pose.yaw)
        there = (self.places - (pose.x, pose.y)) @ np.array([[c, -s], [s, c]])
        away = np.hypot(there[:, 0], there[:, 1])
        inside = away < min(self._front, self._half_width)  # the robot is there: nothing else is
        self.places = self.places[~inside]
        return np.concatenate([points, there[~inside & (away < _REACH)]])

    def _hold(self, pose: Pose, held: Pose) -> Pose:
        """Return the pose of a robot that slips at an obstacle; backing off starts from there."""
        assert self._back_from is not None
        if self._slips:
            self._slip = (self._slip[0] + held.x - pose.x, self._slip[1] + held.y - pose.y)
        self._back_from = (self._back_from[0], held, self._back_from[2])
        return Pose(held.x, held.y, pose.yaw) if self._slips else pose

    def commanded(self, command: Command, period: float) -> Command:
        """Store a command that holds for a period (s), and return it."""
        self._commanded += command.v * period
        return command

    def _watch(self, obs: Observation, pose: Pose, points: Array) -> Pose:
        """Compare wheel odometry with the scan; return the pose without slip."""
        if self._start is None:
            return self._restart(obs, pose, points)
        then, at, before, wide = self._start
        ahead, aside = _moved(then.pose, obs.pose)
        rolled = math.hypot(ahead, aside)
        pressed = self._felt.pressed_for(obs.t) >= _PRESSED and abs(obs.twist[0]) > 0.0
        stalls = abs(self._commanded) >= _COMMANDED and rolled <= _STALLED
        if rolled < _ROLLED and not stalls and not pressed:
            if obs.t - then.t > _PATIENCE:
                self._held = None
                return self._restart(obs, pose, points)
            return pose
        way = math.copysign(1.0, ahead if rolled > _STALLED else self._commanded or 1.0)
        clear = not self._blocked(points, way, (self._front if way > 0.0 else self._back) + _SEEN)
        stands = stalls or pressed
        if clear and not stands:
            still, moves, fixed = _votes(
                before, wide, points, ahead, aside,
                math.remainder(pose.yaw - at.yaw, 2.0 * math.pi),
            )  # fmt: skip
            stands = still >= _STILL and still >= _MOST * moves and fixed >= _STILL_WIDE
        if not (clear and stands):
            self._held = None
            return self._restart(obs, pose, points)
        first = self._held is None
        self._held = self._held or at
        if first and not (stalls or pressed or self._felt.jolted(obs.t)):
            return self._restart(obs, pose, points)  # a second comparison has to agree
        return self._remember(obs, pose, self._held, way)

    def _restart(self, obs: Observation, pose: Pose, points: Array) -> Pose:
        stride = max(1, len(points) // _SAMPLE)
        wide = np.zeros(len(points), np.bool_)
        _mark_wide(points, wide)
        self._start = obs, pose, points[::stride].copy(), wide[::stride].copy()
        self._commanded = 0.0
        return pose

    def _remember(self, obs: Observation, pose: Pose, held: Pose, way: float) -> Pose:
        """Remember a barrier before the robot, which stands where it was held."""
        self._back_from, self._start, self._held = (obs.t, held, -way), None, None
        pose = self._hold(pose, held)
        self.count += 1
        obs.log("stuck/pushes", float(self.count))
        c, s = math.cos(pose.yaw), math.sin(pose.yaw)
        far = way * ((self._front if way > 0.0 else self._back) + _AHEAD)
        centre = (pose.x + c * far, pose.y + s * far)
        met = sum(math.dist(centre, other) < _SAME for other in self._centres)
        half = min(_WIDEST, 2.0 * self._half_width * 2.0**met)
        self._centres.append(centre)
        along = np.arange(-half, half + 0.5 * _SPACING, _SPACING)
        self.places = np.concatenate([self.places, centre + along[:, None] * (-s, c)])
        return pose

    def _blocked(self, points: Array, way: float, far: float) -> bool:
        """Return True if a point lies before the robot in a direction, nearer than far (m)."""
        ahead = way * points[:, 0]
        return bool(np.any((ahead > 0.0) & (ahead < far) & (abs(points[:, 1]) < self._half_width)))


class _Felt:
    """Remembers jolts of IMUs and since when bumpers are pressed."""

    def __init__(self, sensors: Mapping[str, SensorInfo]) -> None:
        self._imus = [n for n, s in sensors.items() if s.category == "imu" and s.shape == (6,)]
        self._bumpers = [n for n, s in sensors.items() if s.category == "bumper"]
        self._jolt, self._since = -math.inf, math.inf

    def note(self, obs: Observation) -> None:
        for name in self._imus:
            if name in obs.readings and np.hypot(*obs.readings[name].values[3:5]) > _JOLT:
                self._jolt = obs.t
        pressed = any(
            np.any(obs.readings[n].values > 0.0) for n in self._bumpers if n in obs.readings
        )
        self._since = min(self._since, obs.t) if pressed else math.inf

    def jolted(self, t: float) -> bool:
        return t - self._jolt < _JOLTED

    def pressed_for(self, t: float) -> float:
        return t - self._since


def _moved(then: Pose, now: Pose) -> tuple[float, float]:
    """Return the displacement from one pose to another in the frame of the first, m."""
    c, s = math.cos(then.yaw), math.sin(then.yaw)
    dx, dy = now.x - then.x, now.y - then.y
    return c * dx + s * dy, c * dy - s * dx


@kernel
def _mark_wide(points: Array, wide: Mask) -> None:
    """Mark the points (P, 2), in the order of beams, of surfaces wider than people."""
    first, count = 0, points.shape[0]
    for i in range(1, count + 1):
        if i < count:
            dx, dy = points[i, 0] - points[i - 1, 0], points[i, 1] - points[i - 1, 1]
            gap = _GAP + _GAP_SHARE * math.sqrt(points[i, 0] ** 2 + points[i, 1] ** 2)
            if dx * dx + dy * dy < gap * gap:
                continue
        dx, dy = points[i - 1, 0] - points[first, 0], points[i - 1, 1] - points[first, 1]
        if dx * dx + dy * dy > _WIDE * _WIDE:
            for k in range(first, i):
                wide[k] = True
        first = i


@kernel
def _votes(
    before: Array, wide: Mask, now: Array, ahead: float, aside: float, turn: float
) -> tuple[int, int, int]:
    """Count points of an earlier scan that fit only a standing, or only a moving robot.

    Args:
        before: (K, 2) base frame of then, m.
        wide: (K,) True for points of surfaces wider than people.
        now: (P, 2) base frame of now, m.
        ahead, aside: way of the robot since as the wheels rolled, base frame of then, m.
        turn: of the robot since, rad.

    Returns:
        number of points that fit only if it stands, and only if it moved; of the former those of
        wide surfaces.
    """
    c, s = math.cos(turn), math.sin(turn)
    still = moves = fixed = 0
    for k in range(before.shape[0]):
        x, y = before[k, 0], before[k, 1]
        away = math.sqrt(x * x + y * y)
        if away > _REACH:
            continue
        sx, sy = c * x + s * y, c * y - s * x
        x, y = x - ahead, y - aside
        mx, my = c * x + s * y, c * y - s * x
        stood = moved = math.inf
        for i in range(now.shape[0]):
            stood = min(stood, (now[i, 0] - sx) ** 2 + (now[i, 1] - sy) ** 2)
            moved = min(moved, (now[i, 0] - mx) ** 2 + (now[i, 1] - my) ** 2)
        clear = _CLEAR + _CLEAR_SHARE * away
        stood, moved = math.sqrt(stood), math.sqrt(moved)
        if stood + clear < moved:
            still += stood < clear
            fixed += wide[k] and stood < clear
        elif moved + clear < stood:
            moves += moved < clear
    return still, moves, fixed


def compile_stuck() -> None:
    """Compile kernels that are not compiled yet."""
    wide = np.zeros(1, np.bool_)
    _mark_wide(np.ones((1, 2)), wide)
    _votes(np.ones((1, 2)), wide, np.ones((1, 2)), 0.1, 0.0, 0.0)
