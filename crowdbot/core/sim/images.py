"""Images of cameras: the simulation's state keeps what a camera saw, not the pixels.

76 800 pixels in the state would be copied at every event of every block. What a camera sees is
the robot's state and eight numbers for each person; from these an image is computed at its tick
and, where a context was cloned or put back, again when somebody asks for it (docs/decisions/0009).
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.crowd import state as s
from crowdbot.core.interfaces import Pose, Reading, RobotState, Sensor
from crowdbot.core.kernel import kernel
from crowdbot.core.sensing.scene import Scene
from crowdbot.core.sim import ports

Array = NDArray[np.float64]
_COLUMNS = (s.X, s.Y, s.VX, s.VY, s.DIR_X, s.DIR_Y, s.WALKED, s.WAITING)
#: Draws what a camera shows: the scene and the robot's pose to (H, W, 3).
Painter = Callable[[Scene, Pose], NDArray[np.uint8]]


def view_size(people: int) -> int:
    """Length of what a camera saw."""
    return ports.ROBOT_STATE_SIZE + len(_COLUMNS) * people


def capture(robot: RobotState, people: Array | None, out: Array) -> None:
    """Write what a camera sees: the robot's state and the crowd's rows (N, C), if any."""
    out[: ports.ROBOT_STATE_SIZE] = robot
    if people is not None:
        _pick(people, out[ports.ROBOT_STATE_SIZE :])


@kernel
def _pick(people: Array, out: Array) -> None:
    """Write `_COLUMNS` of all people, one person after the other."""
    width = len(_COLUMNS)
    for i in range(people.shape[0]):
        for k in range(width):
            out[i * width + k] = people[i, _COLUMNS[k]]


def show(scene: Scene, view: Array) -> Pose:
    """Make a scene look as it did when ``view`` was captured; returns the robot's pose."""
    robot = RobotState(*view[: ports.ROBOT_STATE_SIZE].tolist())
    people = view[ports.ROBOT_STATE_SIZE :].reshape(-1, len(_COLUMNS))
    scene.update(robot, people[:, :4], people[:, 7] == 0.0, people[:, 4:6], people[:, 6])
    return Pose(robot.x, robot.y, robot.yaw)


class Images:
    """The latest image of one camera, kept outside the state for as long as it fits it."""

    def __init__(
        self, sensor: Sensor, rng: Callable[[float], np.random.Generator], painter: Painter | None
    ) -> None:
        """Prepare.

        Args:
            sensor: the camera.
            rng: makes the random numbers of the reading at a time (s).
            painter: draws the colour image of a camera that takes some.
        """
        self._sensor, self._rng, self._painter = sensor, rng, painter
        self._view: Array | None = None
        self._reading = Reading(-1.0, np.zeros(0))

    def take(self, scene: Scene, stamp: float, view: Array) -> Reading:
        """A reading of the scene as it is shown now, which is how ``view`` has it."""
        robot = RobotState(*view[: ports.ROBOT_STATE_SIZE].tolist())
        pose = Pose(robot.x, robot.y, robot.yaw)
        self._reading = Reading(-1.0, np.zeros(0))  # its memory is free for the next, and warm
        image = self._sensor.read(scene, pose, stamp, self._rng(stamp))
        image = image.astype(np.float32, copy=False)
        image.setflags(write=False)
        colour = None if self._painter is None else self._painter(scene, pose)
        if colour is not None:
            colour.setflags(write=False)
        self._view = view.copy()
        self._reading = Reading(stamp, image, colour)
        return self._reading

    def reading(self, scene: Scene, stamp: float, view: Array) -> Reading:
        """The reading that was taken of ``view``; taken again unless it is the latest one."""
        fits = self._view is not None and np.array_equal(self._view, view)
        if fits and self._reading.stamp == stamp:
            return self._reading
        show(scene, view)
        return self.take(scene, stamp, view)
