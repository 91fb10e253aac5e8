"""Range sensors that are read outside compiled loops, by the code of a run.

Level lidars with built-in noise are cast in compiled code for all worlds (`scanner_tables`). Every
other range sensor, such as a sonar, a depth camera, or a tilted or faulty lidar, is read through
the sensor object of a run in the scene of its world.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from crowdbot.core.batch.array_tables import ArrayTable
from crowdbot.core.batch.scan import is_due
from crowdbot.core.batch.scanner_tables import SCANNER, SCANNER_FIELDS, SeenSensor
from crowdbot.core.crowd import state as s
from crowdbot.core.crowd.contact.robot_contact import R_W, R_YAW, RVX, RVY
from crowdbot.core.sensing.noise import SensorStream
from crowdbot.core.sensing.scene import Scene
from crowdbot.core.support.records import rows_of
from crowdbot.core.support.ticks import TICK, TICKS_PER_SECOND
from crowdbot.core.types.arrays import Array
from crowdbot.core.types.motion import Pose
from crowdbot.core.types.robot import RobotModel, RobotState


class SensorReader:
    """A range sensor of one robot in one world, read by Python code.

    Its random numbers are those of a run whose seed is the key of the world's noise.

    Args:
        seen: the sensor.
        names, models: of all robots.
        scene: people and place, with the other robots.

    Attributes:
        table: scanner table with its latest reading; its rate is 0, so it is never due.
    """

    def __init__(
        self, seen: SeenSensor, names: Sequence[str], models: Sequence[RobotModel], scene: Scene
    ) -> None:
        self._sensor, self._info, self._robot = seen.sensor, seen.info, seen.robot
        self._name, self._owner = seen.name, names[seen.robot]
        self._height, self._robots, self._scene = models[seen.robot].base_height, len(names), scene
        self._stream = SensorStream(0, self._owner, self._name)
        shape = self._info.shape
        self.table = ArrayTable(SCANNER_FIELDS)
        self.table.put(
            own=rows_of(1, SCANNER),
            ranges=np.full((1, *shape) if len(shape) == 1 else shape, np.inf),
        )

    def is_steady(self, period: int) -> bool:
        """Return True if readings are due only at ends of steps of ``period`` ticks."""
        ratio = self._info.rate * period / TICKS_PER_SECOND
        return ratio.is_integer() or (1.0 / ratio).is_integer()

    def begin(self, key: int) -> None:
        """Set the key of the random numbers of an episode."""
        self._stream = SensorStream(key, self._owner, self._name)

    def read(self, rows: Array, robots: Array, tick: int) -> None:
        """Read the sensor if a reading is due at a tick.

        Args:
            rows: (N, C) state of all people.
            robots: (R, 8) of all robots as people feel them.
        """
        if not is_due(tick, self._info.rate):
            return
        own, scene, t = robots[self._robot], self._scene, tick * TICK
        pose = Pose(float(own[0]), float(own[1]), float(own[R_YAW]))
        state = RobotState(
            *pose, float(own[RVX]), float(own[RVY]), float(own[R_W]), 0.0, self._height, 0.0, 0.0
        )
        if self._robots > 1:
            others = [row for r, row in enumerate(robots) if r != self._robot]
            scene.show_robots([Pose(*map(float, row[[0, 1, R_YAW]])) for row in others])
        scene.update(
            state, rows[:, s.X : s.VY + 1], rows[:, s.WAITING] == s.PRESENT,
            rows[:, s.DIR_X : s.DIR_Y + 1], rows[:, s.WALKED],
        )  # fmt: skip
        found: Any = self._sensor.read(scene, pose, t, self._stream.at(tick))
        self.table.arrays["ranges"][:] = found
