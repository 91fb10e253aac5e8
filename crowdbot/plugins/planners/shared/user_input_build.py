"""The command of the robot's user."""

from __future__ import annotations

from collections.abc import Mapping

from crowdbot.plugin import Command, Observation, RobotLimits, SensorInfo

#: Category of sensors whose readings are v (m/s) and w (rad/s) of a user.
JOYSTICK = "joystick"


class UserInput:
    """Reads the first joystick of a robot."""

    def __init__(self) -> None:
        self._name = ""
        self._limits: RobotLimits | None = None

    def reset(self, sensors: Mapping[str, SensorInfo], limits: RobotLimits) -> None:
        """Find the joystick."""
        self._name = next((n for n, s in sensors.items() if s.category == JOYSTICK), "")
        self._limits = limits

    def command(self, obs: Observation) -> Command:
        """Return the user's command within the limits; zero before the first reading."""
        reading = obs.readings.get(self._name)
        if reading is None or self._limits is None:
            return Command(0.0, 0.0)
        v, w = reading.values.tolist()
        limits = self._limits
        return Command(
            min(max(v, limits.v_min), limits.v_max), min(max(w, -limits.w_max), limits.w_max)
        )
