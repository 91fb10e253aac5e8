"""Shared parts of the three control modes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from pydrake.systems.framework import InputPort, LeafSystem, OutputPort

from crowdbot.core.sim import ports
from crowdbot.core.sim.plant import RobotPlant
from crowdbot.core.types.arrays import Array
from crowdbot.core.types.motion import Pose


@dataclass(frozen=True, slots=True)
class Push:
    """Layout of a horizontal force on the robot, for the block that receives it.

    Attributes:
        size: length of the vector.
        at: first of the five entries torque x, y, z, force x, y; None: force x, y alone.
        lever: height of the force above the floating body's frame, m.
    """

    size: int
    at: int | None
    lever: float

    def write(self, values: Array, fx: float, fy: float, torque: float = 0.0) -> None:
        """Write a force (N, world frame) and a torque about the base's vertical (N m), in place."""
        if self.at is None:
            values[0], values[1] = fx, fy
        else:
            i = self.at
            values[i : i + 5] = -self.lever * fy, self.lever * fx, torque, fx, fy


@dataclass(frozen=True, slots=True, kw_only=True)
class ControlledRobot:
    """A robot and its controller in a Drake diagram.

    Attributes:
        state: the system with the port ``robot_state``, read by everything downstream.
        desired: port for the result of `desire`.
        desire: v (m/s), w (rad/s), vy (m/s), after slew limits -> values for ``desired``.
        desired_size: their number.
        push: layout of people's force.
        push_port: port for that force; None: the robot cannot be pushed.
        place: function that puts the robot at rest at a pose; gets the root context.
        rig: the multibody plant, or None.
    """

    state: LeafSystem
    desired: InputPort
    desire: Callable[[float, float, float], tuple[float, ...]]
    desired_size: int
    push: Push
    push_port: InputPort | None
    place: Callable[[object, Pose], None]
    rig: RobotPlant | None

    @property
    def port(self) -> OutputPort:
        """Return the port of the robot's state, read by everything downstream."""
        return self.state.GetOutputPort(ports.ROBOT_STATE)


def push_on(rig: RobotPlant) -> Push:
    """Return people's force as a generalised force on a plant's velocities."""
    lever = rig.robot.force_height - rig.robot.base_height + rig.rise
    return Push(rig.plant.num_velocities(), rig.root.floating_velocities_start_in_v(), lever)
