"""Kinematic control: the base moves on exact arcs, unaffected by forces; walls stop it.

Between two ticks v, vy and w are constant, so the path is an arc of a circle; for a robot that also
moves sideways it starts at an angle to its heading. Wheel angles assume rolling without slip, so
that odometry works as in the other modes.
"""

from __future__ import annotations

import math

import numpy as np
from pydrake.systems.framework import (
    Context,
    DiagramBuilder,
    DiscreteStateIndex,
    DiscreteValues,
)

from crowdbot.core.crowd.contact.robot_contact import extent_of
from crowdbot.core.geometry.footprint import footprint_of_model
from crowdbot.core.sim import ports
from crowdbot.core.sim.block import Block
from crowdbot.core.sim.contacts.outline_gap import is_clear, outline_gap
from crowdbot.core.sim.control.controlled import ControlledRobot, Push
from crowdbot.core.sim.weak_callback import NO_ATTRIBUTES
from crowdbot.core.support.compiling.compile import kernel
from crowdbot.core.types.arrays import Array
from crowdbot.core.types.environment import EnvironmentParts
from crowdbot.core.types.motion import Pose
from crowdbot.core.types.robot import DifferentialDrive, RobotModel, RobotState

_HALVINGS = 40  # limits an arc of 5 mm at a wall to less than a picometre
_TOUCHING = 1e-9  # m; overlap of a robot that touches a wall
_SKIN = 1e-6  # m; distance kept by corners, since a wall inside a polygon has distance 0
_ROUNDING = 1e-13  # m; must not stop a robot that drives along a wall
_SMALL = 0.03  # rad; turns of a tick for which a short series is exact
_UNSURE = 1e-13  # share of coordinates; larger than the rounding of distances


class KinematicBase(Block):
    """Input: v, w, vy. Output: `ports.ROBOT_STATE`, which is the whole state."""

    __slots__ = NO_ATTRIBUTES

    def __init__(self, parts: EnvironmentParts, robot: RobotModel, tick: float) -> None:
        super().__init__()
        self._tick = tick
        self._robot, self._body = robot, footprint_of_model(robot)
        self._wheel = _wheel_radius(robot)
        self._walls, self._pillars = obstacles(parts, robot.height)
        self._port = self.DeclareVectorInputPort(ports.DESIRED_STATE, 3)
        index = self.DeclareDiscreteState(ports.ROBOT_STATE_SIZE)
        self.DeclareStateOutputPort(ports.ROBOT_STATE, index)
        self._index = DiscreteStateIndex(index)
        self.DeclarePeriodicDiscreteUpdateEvent(tick, 0.0, self._update)

    def _update(self, context: Context, values: DiscreteValues) -> None:
        state = values.get_mutable_value(self._index)
        now = RobotState(*state.tolist())
        v, w, vy = self._port.Eval(context).tolist()
        speed, crab = (v, 0.0) if vy == 0.0 else (math.hypot(v, vy), math.atan2(vy, v))
        way = now.yaw + crab
        x, y, _ = arc(now.x, now.y, way, speed, w, self._tick)
        yaw = math.remainder(now.yaw + w * self._tick, 2.0 * math.pi)
        share = self._free(now.x, now.y, now.yaw, crab, speed, w)
        if share < 1.0:  # stopped by a wall; turning on the spot continues
            x, y, _ = arc(now.x, now.y, way, speed * share, w * share, self._tick)
            v, vy, speed = v * share, vy * share, speed * share
            if len(self._body.corners):  # as far as corners may move
                turned = now.yaw + w * share * self._tick
                rest = (1.0 - share) * w
                w = w * share + rest * self._free(x, y, turned, 0.0, 0.0, rest)
                yaw = math.remainder(now.yaw + w * self._tick, 2.0 * math.pi)
        across = 0.5 * self._robot.drive.track * w
        state[:] = RobotState(
            x=x,
            y=y,
            yaw=yaw,
            vx=speed * math.cos(yaw + crab),
            vy=speed * math.sin(yaw + crab),
            w=w,
            tilt=0.0,
            z=now.z,
            left_angle=now.left_angle + (v - across) * self._tick / self._wheel,
            right_angle=now.right_angle + (v + across) * self._tick / self._wheel,
            side_angle=now.side_angle + vy * self._tick / self._wheel,
        )

    def _free(self, x: float, y: float, yaw: float, crab: float, speed: float, w: float) -> float:
        body, radius = self._body, max(self._body.radius, _SKIN)
        return float(
            free_share(
                self._walls, self._pillars, body.corners, radius,
                x, y, yaw, crab, speed * self._tick, w * self._tick,
            )
        )  # fmt: skip

    def place(self, context: object, start: Pose) -> None:
        """Put the robot at rest at a pose."""
        mine = self.GetMyMutableContextFromRoot(context)
        mine.get_mutable_discrete_state_vector().get_mutable_value()[:] = RobotState(
            start.x, start.y, start.yaw, 0.0, 0.0, 0.0, 0.0, self._robot.base_height, 0.0, 0.0
        )


def _wheel_radius(robot: RobotModel) -> float:
    drive = robot.drive
    return drive.command_radius if isinstance(drive, DifferentialDrive) else drive.wheel_radius


def obstacles(parts: EnvironmentParts, height: float) -> tuple[Array, Array]:
    """Return walls (S, 4) and pillars (P, 3) for a robot of some height; solids by their sides."""
    tables = [parts.walls[parts.stops_robot & (parts.wall_heights[:, 0] < height)]]
    for outline, (bottom, _) in zip(parts.solids, parts.solid_heights, strict=True):
        if bottom < height:
            tables.append(np.concatenate([outline, np.roll(outline, -1, axis=0)], axis=1))
    low = parts.pillar_heights[:, 0] < height
    return np.concatenate(tables), np.ascontiguousarray(parts.pillars[low])


def arc(
    x: float, y: float, yaw: float, v: float, w: float, dt: float
) -> tuple[float, float, float]:
    """Return the exact pose after ``dt`` seconds at constant v and w; yaw within [-pi, pi]."""
    half = 0.5 * w * dt
    chord = v * dt * (math.sin(half) / half if half != 0.0 else 1.0)
    middle = yaw + half
    return (
        x + chord * math.cos(middle),
        y + chord * math.sin(middle),
        math.remainder(yaw + w * dt, 2.0 * math.pi),
    )


@kernel
def _is_clear_after(
    walls: Array, pillars: Array, outline: Array, extent: float,
    x: float, y: float, yaw: float, crab: float, way: float, turn: float, least: float,
) -> bool:  # fmt: skip
    """Return True if an arc of length ``way`` (m) that turns by ``turn`` (rad) leaves a gap.

    The robot moves in the direction ``yaw`` + ``crab`` and faces along ``yaw``.

    Args:
        least: the gap, m; the others as in `is_clear`.
    """
    half = 0.5 * turn
    chord = way * (math.sin(half) / half if half != 0.0 else 1.0)
    middle = yaw + crab + half
    x, y = x + chord * math.cos(middle), y + chord * math.sin(middle)
    c, s = 1.0, 0.0
    if outline.shape[0] > 0:
        c, s = math.cos(yaw + turn), math.sin(yaw + turn)
    return is_clear(walls, pillars, outline, extent, x, y, c, s, least)


@kernel
def _small_turn(angle: float) -> tuple[float, float]:
    """Return cosine and sine of at most `_SMALL`, exact but for rounding (Taylor series)."""
    z = angle * angle
    return (
        1.0 - z * (0.5 - z * (1.0 / 24.0 - z / 720.0)),
        angle * (1.0 - z * (1.0 / 6.0 - z * (1.0 / 120.0 - z / 5040.0))),
    )


@kernel
def _turned(c: float, s: float, angle: float) -> tuple[float, float]:
    """Return a unit vector turned by a small angle."""
    dc, ds = _small_turn(angle)
    return c * dc - s * ds, s * dc + c * ds


@kernel
def free_share(
    walls: Array,
    pillars: Array,
    outline: Array,
    radius: float,
    x: float,
    y: float,
    yaw: float,
    crab: float,
    way: float,
    turn: float,
) -> float:
    """Return the share of an arc that a robot can drive before it touches a wall, 0 to 1.

    A robot in contact may move if its gap does not shrink. ``outline`` is as in `outline_gap`,
    ``radius`` its rounding, m.
    """
    gap = outline_gap(walls, pillars, outline, x, y, yaw)
    least, extent = min(radius - _TOUCHING, gap - _ROUNDING), extent_of(outline)
    if _is_clear_after(walls, pillars, outline, extent, x, y, yaw, crab, way, turn, least):
        return 1.0
    mx, my = math.cos(yaw + crab), math.sin(yaw + crab)
    fx, fy = math.cos(yaw), math.sin(yaw)
    unsure = _UNSURE * (1.0 + extent + abs(x) + abs(y)) if abs(turn) <= _SMALL else math.inf
    free, blocked = 0.0, 1.0
    for _ in range(_HALVINGS):
        share = 0.5 * (free + blocked)
        gone, turned = share * way, share * turn
        # Most decisions need no more than a series: sines are expensive.
        chord = gone * _small_turn(0.5 * turned)[1] / (0.5 * turned) if turned != 0.0 else gone
        ux, uy = _turned(mx, my, 0.5 * turned)
        c, s = _turned(fx, fy, turned)
        px, py = x + chord * ux, y + chord * uy
        clear = is_clear(walls, pillars, outline, extent, px, py, c, s, least + unsure)
        if not clear and is_clear(walls, pillars, outline, extent, px, py, c, s, least - unsure):
            clear = _is_clear_after(
                walls, pillars, outline, extent, x, y, yaw, crab, gone, turned, least
            )
        if clear:
            free = share
        else:
            blocked = share
    return free


def add_kinematic(
    builder: DiagramBuilder, parts: EnvironmentParts, model: RobotModel, tick: float
) -> ControlledRobot:
    """Add a base without masses and forces; people who touch it are pushed anyway."""
    base = builder.AddNamedSystem("robot_state", KinematicBase(parts, model, tick))
    return ControlledRobot(
        state=base,
        desired=base.GetInputPort(ports.DESIRED_STATE),
        desire=lambda v, w, vy: (v, w, vy),
        desired_size=3,
        push=Push(2, None, 0.0),
        push_port=None,
        place=base.place,
        rig=None,
    )
