"""Other robots, as seen by a robot's sensors: upright bodies over their outlines."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from crowdbot.core.geometry.footprint import Footprint
from crowdbot.core.support.immutable import immutable, immutable_fields
from crowdbot.core.types.arrays import Array
from crowdbot.core.types.motion import Pose

#: Position of robots that have left, m: out of range of every sensor, but finite.
FAR = 1e6


@dataclass(frozen=True, slots=True)
class OtherRobot:
    """A robot as other robots' sensors see it: solid from the floor to its height, m."""

    footprint: Footprint
    height: float


class RobotSurfaces:
    """Surfaces of several robots: a disc is a cylinder, others are plates.

    Attributes:
        robots: the robots.
        poses: their poses.
        plates, plate_heights: (S, 4), (S, 2), m, as walls of a scene.
        discs, disc_heights: (D, 3), (D, 2), m, as pillars of a scene.
    """

    def __init__(self, robots: Sequence[OtherRobot]) -> None:
        self.robots = tuple(replace(r, footprint=immutable_fields(r.footprint)) for r in robots)
        self.poses: tuple[Pose | None, ...] = (None,) * len(robots)
        sides = [0 if len(r.footprint.corners) == 0 else len(_outline(r)) for r in robots]
        heights = [(0.0, r.height) for r in robots]
        self.plates = immutable(np.full((sum(sides), 4), FAR))
        self.plate_heights = immutable(np.repeat(np.reshape(heights, (-1, 2)), sides, axis=0))
        round_ones = [k for k, count in enumerate(sides) if count == 0]
        discs = np.full((len(round_ones), 3), FAR)
        discs[:, 2] = [robots[k].footprint.radius for k in round_ones]
        self.discs = immutable(discs)
        self.disc_heights = immutable(np.reshape([heights[k] for k in round_ones], (-1, 2)))

    def __len__(self) -> int:
        return len(self.robots)

    def place(self, poses: Sequence[Pose | None]) -> None:
        """Move the robots to their poses; None for a robot that has left."""
        self.poses = tuple(poses)
        plates, discs = self.plates.copy(), self.discs.copy()
        side = disc = 0
        for robot, pose in zip(self.robots, poses, strict=True):
            if len(robot.footprint.corners) == 0:
                discs[disc, :2] = FAR if pose is None else pose[:2]
                disc += 1
                continue
            corners = _outline(robot, pose)
            end = side + len(corners)
            plates[side:end, :2] = corners
            plates[side:end, 2:] = np.roll(corners, -1, axis=0)
            if pose is None:
                plates[side:end] = FAR
            side = end
        self.plates, self.discs = immutable(plates), immutable(discs)


def _outline(robot: OtherRobot, pose: Pose | None = None) -> Array:
    x, y, yaw = pose or (0.0, 0.0, 0.0)
    return robot.footprint.outline(x, y, yaw)
