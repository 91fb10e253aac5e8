"""Camera images: the simulation's state contains the scene data, not the pixels.

76 800 pixels in the state would be copied at every event of every block. A camera's view depends on
the robot's state and eight numbers per person; from these an image is computed at its tick and, if
a context was cloned or restored, again on demand (docs/decisions/0009).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.crowd import state as s
from crowdbot.core.sensing.depth_mm import depth_mm
from crowdbot.core.sensing.scene import Scene
from crowdbot.core.sensing.sensor import DepthCamera, Sensor
from crowdbot.core.sim import ports
from crowdbot.core.support.compiling.compile import kernel
from crowdbot.core.types.arrays import Array
from crowdbot.core.types.motion import Pose
from crowdbot.core.types.robot import RobotState
from crowdbot.core.types.sensor import CameraFrame, Reading

_COLUMNS = (s.X, s.Y, s.VX, s.VY, s.DIR_X, s.DIR_Y, s.WALKED, s.WAITING)


#: A function that draws a camera's image: from the scene and the robot's pose to (H, W, 3).
ColourRenderer = Callable[[Scene, Pose], NDArray[np.uint8]]


class Graphics(Protocol):
    """A `ColourRenderer` that holds graphics of one thread."""

    def __call__(self, scene: Scene, pose: Pose, /) -> NDArray[np.uint8]:
        """Return the image (H, W, 3) of a scene, from the robot's pose."""
        ...

    def close(self) -> None:
        """Free the graphics, in the thread that drew; nothing is drawn afterwards."""
        ...


def view_size(people: int, robots: int = 0) -> int:
    """Return the length of a camera's view data; ``robots``: number of others."""
    return ports.ROBOT_STATE_SIZE + len(Pose._fields) * robots + len(_COLUMNS) * people


def capture(
    robot: RobotState, people: Array | None, out: Array, others: Sequence[Pose | None] = ()
) -> None:
    """Write a camera's view data: the robot's state, the others' poses, the crowd's rows (N, C)."""
    out[: ports.ROBOT_STATE_SIZE] = robot
    at = ports.ROBOT_STATE_SIZE
    for pose in others:
        out[at : at + 3] = (math.nan, 0.0, 0.0) if pose is None else pose
        at += 3
    if people is not None:
        _pick(people, out[at:])


@kernel
def _pick(people: Array, out: Array) -> None:
    """Write `_COLUMNS` of all people, one after the other."""
    width = len(_COLUMNS)
    for i in range(people.shape[0]):
        for k in range(width):
            out[i * width + k] = people[i, _COLUMNS[k]]


def show(scene: Scene, view: Array) -> Pose:
    """Restore a scene from ``view``; return the robot's pose."""
    robot = RobotState(*view[: ports.ROBOT_STATE_SIZE].tolist())
    at = ports.ROBOT_STATE_SIZE + len(Pose._fields) * len(scene.others)
    if scene.others.robots:
        poses = view[ports.ROBOT_STATE_SIZE : at].reshape(-1, len(Pose._fields)).tolist()
        scene.show_robots([None if math.isnan(p[0]) else Pose(*p) for p in poses])
    people = view[at:].reshape(-1, len(_COLUMNS))
    scene.update(robot, people[:, :4], people[:, 7] == 0.0, people[:, 4:6], people[:, 6])
    return Pose(robot.x, robot.y, robot.yaw)


class Images:
    """Cache of the latest image of one camera, kept outside the state; valid for one view."""

    def __init__(
        self,
        sensor: Sensor,
        rng: Callable[[float], np.random.Generator],
        renderer: ColourRenderer | None,
    ) -> None:
        """Prepare the images.

        Args:
            sensor: the camera.
            rng: function that returns the random generator for a time (s).
            renderer: function that draws the colour image, if the camera has one.
        """
        self._sensor, self._rng, self._renderer = sensor, rng, renderer
        self._quick = sensor if isinstance(sensor, DepthCamera) else None
        self._stamp, self._view = -1.0, np.zeros(0)
        self._depth: Array | None = None
        self._colour: NDArray[np.uint8] | None = None

    def frame(self, scene: Scene, pose: Pose, stamp: float, view: Array) -> CameraFrame:
        """Return the recorded frame of the current scene, which must match ``view``.

        Depth in m is computed only for a reading.
        """
        self._begin(stamp, view)
        self._render(scene, pose)
        if self._quick is None:
            depth = depth_mm(self._read(scene, pose))
        else:
            depth = self._quick.depth_mm(scene, pose, stamp, self._rng(stamp))
        return CameraFrame(stamp, depth, self._colour)

    def reading(self, scene: Scene, stamp: float, view: Array) -> Reading:
        """Return the reading of ``view``, computed if missing; this may change the scene."""
        fits = self._stamp == stamp and np.array_equal(self._view, view)
        if not fits:
            self._begin(stamp, view)
        depth = self._depth
        if depth is None:
            pose = show(scene, self._view)
            if not fits:
                self._render(scene, pose)
            depth = self._read(scene, pose)
        return Reading(stamp, depth, self._colour)

    def _begin(self, stamp: float, view: Array) -> None:
        """Drop the latest image, so that its memory, still in the processor's cache, is reused."""
        self._stamp, self._view = stamp, view.copy()
        self._depth = self._colour = None

    def _render(self, scene: Scene, pose: Pose) -> None:
        """Draw the colour image, if the camera has one."""
        if self._renderer is not None:
            self._colour = self._renderer(scene, pose)
            self._colour.setflags(write=False)

    def _read(self, scene: Scene, pose: Pose) -> Array:
        """Return depth in m, cached."""
        depth = self._sensor.read(scene, pose, self._stamp, self._rng(self._stamp))
        self._depth = depth = depth.astype(np.float32, copy=False)
        depth.setflags(write=False)
        return depth
