"""The stick of the person who drives a robot, as one of the robot's sensors."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from crowdbot.core.live.person.seat import Seat
from crowdbot.core.live.person.stick import Stick, command_of
from crowdbot.core.sensing.scene import Scene
from crowdbot.core.sim.built_run import BuiltRun
from crowdbot.core.types.arrays import Array
from crowdbot.core.types.motion import Command, Pose
from crowdbot.core.types.robot import RobotLimits
from crowdbot.core.types.sensor import SensorInfo, SensorMessage

#: Name of the sensor of a robot that has no joystick of its own.
JOYSTICK = "joystick"


class SeatStick:
    """Sensor whose reading is v (m/s), w (rad/s), and vy (m/s) if the drive can move sideways.

    A reading waits until its simulated time has come in real time.
    """

    def __init__(self, seat: Seat, limits: RobotLimits, info: SensorInfo) -> None:
        self._seat, self._limits, self._info = seat, limits, info

    def info(self) -> SensorInfo:
        """Return the constant description."""
        return self._info

    def read(self, scene: Scene, pose: Pose, t: float, rng: np.random.Generator) -> Array:
        """Return the command at the stick's present position."""
        del scene, pose, rng
        self._seat.pace(t)
        taken = self._seat.take(t)
        command = command_of(taken, self._limits) if isinstance(taken, Stick) else taken
        return reading_of(command, self._limits, self._info)


def reading_of(command: Command, limits: RobotLimits, info: SensorInfo) -> Array:
    """Return a command within the limits as a reading."""
    inside = (
        min(max(command.v, limits.v_min), limits.v_max),
        min(max(command.w, -limits.w_max), limits.w_max),
        min(max(command.vy, -limits.vy_max), limits.vy_max),
    )
    return np.array(inside[: info.shape[0]])


def with_stick(built: BuiltRun, make: Any, *, sideways: bool) -> BuiltRun:
    """Return the run of a robot with a stick that a person holds.

    It replaces the robot's joystick, if it has one, and is read at each step of the planner.

    Args:
        make: function from limits and description to a sensor.
        sideways: True for a third value, if the drive can use it.
    """
    name = stick_name(built)
    limits = built.model.limits
    info = SensorInfo(
        category="joystick",
        frame=name,
        mount=(0.0, 0.0, 0.0, 0.0),
        rate=built.scenario.rates.planner,
        shape=(3 if sideways and limits.vy_max else 2,),
        ros_type="geometry_msgs/msg/TwistStamped",
        message=SensorMessage(fields=_twist, topic="cmd_vel"),
        random=False,
        sees=False,
    )
    visible = built.visible if name in built.visible else (*built.visible, name)
    return replace(
        built,
        sensors={**built.sensors, name: make(limits, info)},
        infos={**built.infos, name: info},
        visible=visible,
    )


def stick_name(built: BuiltRun) -> str:
    """Return the name of the robot's joystick, or a default name."""
    own = (n for n, info in built.infos.items() if info.category == "joystick")
    return next(own, JOYSTICK)


def _twist(values: Array) -> dict[str, Any]:
    """Return the fields of a TwistStamped of a reading."""
    v, w, *aside = values.tolist()
    return {
        "twist": {
            "linear": {"x": v, "y": aside[0] if aside else 0.0, "z": 0.0},
            "angular": {"x": 0.0, "y": 0.0, "z": w},
        }
    }
