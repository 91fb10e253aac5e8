"""Kinematic control: the base moves on exact arcs, whatever pushes it; walls stop it.

Between two ticks v, vy and w are constant, so the path is an arc of a circle; that of a robot which
goes sideways too begins at an angle to where it looks. Wheel angles are those of wheels that roll
without slipping, so that odometry works as in the other modes.
"""

from __future__ import annotations

import math

import numba
import numpy as np
from numpy.typing import NDArray
from pydrake.systems.framework import (
    Context,
    DiagramBuilder,
    DiscreteStateIndex,
    DiscreteValues,
    LeafSystem,
)

from crowdbot.core.interfaces import (
    DifferentialDrive,
    EnvironmentParts,
    Pose,
    RobotModel,
    RobotState,
)
from crowdbot.core.sim import ports
from crowdbot.core.sim.control.controlled import ControlledRobot, Push
from crowdbot.core.ticks import TICK

Array = NDArray[np.float64]
_HALVINGS = 40  # an arc of 5 mm is cut at a wall to less than a picometre
_TOUCHING = 1e-9  # m; how deep a robot that touches a wall stands in it
_ROUNDING = 1e-13  # m; must not hold a robot that drives along a wall


class KinematicBase(LeafSystem):
    """Input: v, w, vy. Output: `ports.ROBOT_STATE`, which is the whole state."""

    def __init__(self, parts: EnvironmentParts, robot: RobotModel) -> None:
        super().__init__()
        self._robot = robot
        self._wheel = _wheel_radius(robot)
        self._walls, self._pillars = obstacles(parts, robot.height)
        self._port = self.DeclareVectorInputPort(ports.DESIRED_STATE, 3)
        index = self.DeclareDiscreteState(ports.ROBOT_STATE_SIZE)
        self.DeclareStateOutputPort(ports.ROBOT_STATE, index)
        self._index = DiscreteStateIndex(index)
        self.DeclarePeriodicDiscreteUpdateEvent(TICK, 0.0, self._update)

    def _update(self, context: Context, values: DiscreteValues) -> None:
        state = values.get_mutable_value(self._index)
        now = RobotState(*state.tolist())
        v, w, vy = self._port.Eval(context).tolist()
        speed, crab = (v, 0.0) if vy == 0.0 else (math.hypot(v, vy), math.atan2(vy, v))
        way = now.yaw + crab
        x, y, _ = arc(now.x, now.y, way, speed, w, TICK)
        share = free_share(
            self._walls, self._pillars, self._robot.footprint_radius,
            now.x, now.y, way, speed * TICK, w * TICK,
        )  # fmt: skip
        if share < 1.0:  # stopped by a wall; turning on the spot goes on
            x, y, _ = arc(now.x, now.y, way, speed * share, w * share, TICK)
            v, vy, speed = v * share, vy * share, speed * share
        yaw = math.remainder(now.yaw + w * TICK, 2.0 * math.pi)
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
            left_angle=now.left_angle + (v - across) * TICK / self._wheel,
            right_angle=now.right_angle + (v + across) * TICK / self._wheel,
            side_angle=now.side_angle + vy * TICK / self._wheel,
        )

    def place(self, context: object, start: Pose) -> None:
        """Put the robot, at rest, at a pose."""
        mine = self.GetMyMutableContextFromRoot(context)
        mine.get_mutable_discrete_state_vector().get_mutable_value()[:] = RobotState(
            start.x, start.y, start.yaw, 0.0, 0.0, 0.0, 0.0, self._robot.base_height, 0.0, 0.0
        )


def _wheel_radius(robot: RobotModel) -> float:
    drive = robot.drive
    return drive.command_radius if isinstance(drive, DifferentialDrive) else drive.wheel_radius


def obstacles(parts: EnvironmentParts, height: float) -> tuple[Array, Array]:
    """Walls (S, 4) and pillars (P, 3) that a robot of some height meets; of solids the sides."""
    tables = [parts.walls[parts.stops_robot & (parts.wall_heights[:, 0] < height)]]
    for outline, (bottom, _) in zip(parts.solids, parts.solid_heights, strict=True):
        if bottom < height:
            tables.append(np.concatenate([outline, np.roll(outline, -1, axis=0)], axis=1))
    low = parts.pillar_heights[:, 0] < height
    return np.concatenate(tables), np.ascontiguousarray(parts.pillars[low])


def arc(
    x: float, y: float, yaw: float, v: float, w: float, dt: float
) -> tuple[float, float, float]:
    """Pose after ``dt`` seconds at constant v and w, exactly; yaw within [-pi, pi]."""
    half = 0.5 * w * dt
    chord = v * dt * (math.sin(half) / half if half != 0.0 else 1.0)
    middle = yaw + half
    return (
        x + chord * math.cos(middle),
        y + chord * math.sin(middle),
        math.remainder(yaw + w * dt, 2.0 * math.pi),
    )


@numba.njit(cache=True, error_model="numpy")
def gap_to_walls(walls: Array, pillars: Array, x: float, y: float) -> float:
    """Distance from a point to the nearest wall or pillar's surface, m; inf without any."""
    nearest = math.inf
    for i in range(walls.shape[0]):
        ex, ey = walls[i, 2] - walls[i, 0], walls[i, 3] - walls[i, 1]
        px, py = x - walls[i, 0], y - walls[i, 1]
        square = ex * ex + ey * ey
        s = 0.0
        if square > 0.0:
            s = min(1.0, max(0.0, (px * ex + py * ey) / square))
        nearest = min(nearest, math.hypot(px - s * ex, py - s * ey))
    for i in range(pillars.shape[0]):
        nearest = min(nearest, math.hypot(x - pillars[i, 0], y - pillars[i, 1]) - pillars[i, 2])
    return nearest


@numba.njit(cache=True, error_model="numpy")
def _gap_on_arc(
    walls: Array, pillars: Array, x: float, y: float, yaw: float, way: float, turn: float
) -> float:
    """Gap of the centre after an arc of length ``way`` (m) that turns by ``turn`` (rad)."""
    half = 0.5 * turn
    chord = way * (math.sin(half) / half if half != 0.0 else 1.0)
    middle = yaw + half
    return float(
        gap_to_walls(walls, pillars, x + chord * math.cos(middle), y + chord * math.sin(middle))
    )


@numba.njit(cache=True, error_model="numpy")
def free_share(
    walls: Array,
    pillars: Array,
    radius: float,
    x: float,
    y: float,
    yaw: float,
    way: float,
    turn: float,
) -> float:
    """Share of an arc that a disc can go before it touches a wall, 0 to 1.

    A disc that touches already may go where its gap does not shrink.
    """
    least = min(radius - _TOUCHING, gap_to_walls(walls, pillars, x, y) - _ROUNDING)
    if _gap_on_arc(walls, pillars, x, y, yaw, way, turn) >= least:
        return 1.0
    free, blocked = 0.0, 1.0
    for _ in range(_HALVINGS):
        share = 0.5 * (free + blocked)
        if _gap_on_arc(walls, pillars, x, y, yaw, share * way, share * turn) >= least:
            free = share
        else:
            blocked = share
    return free


def add_kinematic(
    builder: DiagramBuilder, parts: EnvironmentParts, model: RobotModel
) -> ControlledRobot:
    """A base without masses and forces; people who touch it are pushed all the same."""
    base = builder.AddNamedSystem("robot_state", KinematicBase(parts, model))
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
