"""Joystick: a simulated driver with a shaky hand steers for the goal; or commands are replayed.

The sideways deflection is proportional to the angle between heading and goal, the forward
deflection to its cosine; near the goal the stick returns to the centre. The hand's error is an
Ornstein-Uhlenbeck process, exact at any step (Gillespie, Physical Review E 54, 1996, p. 2084).
"""

from __future__ import annotations

import bisect
import math
from typing import Any

import numpy as np

from crowdbot.plugin import Array, Pose, Scene, SensorContext, SensorInfo, SensorMessage
from crowdbot.plugins.sensors.described_build import DescribedSensor
from crowdbot.plugins.sensors.joystick import JoystickSpec

#: Layout of the memory: 1 after a reading, its time, and the hand's error ahead and aside, in
#: standard deviations.
STARTED, TIME, AHEAD, ASIDE = range(4)


class Joystick(DescribedSensor):
    """Reading: (2,) v (m/s), w (rad/s)."""

    def __init__(self, spec: JoystickSpec, context: SensorContext) -> None:
        self._spec, limits = spec, context.robot.limits
        self._goal = spec.goal or context.task.goal
        self._most = spec.max_speed or limits.v_max, spec.max_yaw_rate or limits.w_max
        self._recorded = spec.recorded or ()
        self._from = [t for t, _, _ in self._recorded]
        random = spec.noise > 0.0 and not self._recorded
        self._info = stick_info(spec.rate, memory=4, random=random, sees=False)

    def read(
        self, scene: Scene, pose: Pose, t: float, rng: np.random.Generator, memory: Array
    ) -> Array:
        """Return the driver's command; two readings at the same time are equal."""
        del scene  # the driver knows the robot's pose and ignores the people
        if self._recorded:
            return self._played(t)
        if self._info.random and (memory[STARTED] == 0.0 or t > memory[TIME]):
            self._tremble(memory, t, rng)
        ahead, aside = self._deflection(pose)
        noise, (v, w) = self._spec.noise, self._most
        return np.array(
            [v * full(ahead + noise * memory[AHEAD]), w * full(aside + noise * memory[ASIDE])]
        )

    def _played(self, t: float) -> Array:
        """Return the recorded command in effect; before the first one the stick is centred."""
        k = bisect.bisect_right(self._from, t) - 1
        return np.array(self._recorded[k][1:]) if k >= 0 else np.zeros(2)

    def _deflection(self, pose: Pose) -> tuple[float, float]:
        """Return a steady hand's deflection of the stick, ahead and to the left, from -1 to 1."""
        x, y = self._goal[0] - pose.x, self._goal[1] - pose.y
        off = math.remainder(math.atan2(y, x) - pose.yaw, 2.0 * math.pi)
        near = min(1.0, math.hypot(x, y) / self._spec.slow_distance)
        aside = self._spec.steering * off / self._most[1]
        return near * max(0.0, math.cos(off)), near * full(aside)

    def _tremble(self, memory: Array, t: float, rng: np.random.Generator) -> None:
        """Advance the hand's error to time t."""
        stays = 0.0
        if memory[STARTED] != 0.0:
            stays = math.exp((memory[TIME] - t) / self._spec.noise_time)
        fresh = math.sqrt(1.0 - stays * stays) * rng.standard_normal(2)
        memory[AHEAD : ASIDE + 1] = stays * memory[AHEAD : ASIDE + 1] + fresh
        memory[STARTED], memory[TIME] = 1.0, t


def stick_info(rate: float, *, memory: int, random: bool, sees: bool) -> SensorInfo:
    """Return the description of a sensor that reads v (m/s) and w (rad/s) from a driver."""
    return SensorInfo(
        category="joystick",
        frame="joystick",
        mount=(0.0, 0.0, 0.0, 0.0),
        rate=rate,
        shape=(2,),
        ros_type="geometry_msgs/msg/TwistStamped",
        message=SensorMessage(fields=twist, topic="cmd_vel"),
        memory=memory,
        random=random,
        sees=sees,
    )


def twist(values: Array) -> dict[str, Any]:
    """Return the fields of a TwistStamped of a reading."""
    v, w = values.tolist()
    return {
        "twist": {
            "linear": {"x": v, "y": 0.0, "z": 0.0},
            "angular": {"x": 0.0, "y": 0.0, "z": w},
        }
    }


def full(deflection: float) -> float:
    """Return a deflection, limited to -1..1."""
    return min(1.0, max(-1.0, deflection))


build = Joystick
