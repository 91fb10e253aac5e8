"""The robots that the sensors of another one see: upright bodies over their outlines."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from crowdbot.core.geometry.footprint import Footprint
from crowdbot.core.types.arrays import Array
from crowdbot.core.types.motion import Pose

#: Where what has left is, m: out of the reach of every sensor, and still a number.
FAR = 1e6


@dataclass(frozen=True, slots=True)
class OtherRobot:
    """A robot as others see it: solid from the floor up to its height, m."""

    footprint: Footprint
    height: float


class OtherRobots:
    """Where the sides of several robots are: a disc is a cylinder, all else are plates.

    Attributes:
        robots: what they are.
        poses: where they are.
        plates, plate_heights: (S, 4), (S, 2), m, as walls of a scene.
        discs, disc_heights: (D, 3), (D, 2), m, as pillars of a scene.
    """

    def __init__(self, robots: Sequence[OtherRobot]) -> None:
        self.robots = tuple(robots)
        self.poses: tuple[Pose | None, ...] = (None,) * len(robots)
        sides = [0 if len(r.footprint.corners) == 0 else len(_outline(r)) for r in robots]
        heights = [(0.0, r.height) for r in robots]
        self.plates = np.full((sum(sides), 4), FAR)
        self.plate_heights = np.repeat(np.reshape(heights, (-1, 2)), sides, axis=0)
        round_ones = [k for k, count in enumerate(sides) if count == 0]
        self.discs = np.full((len(round_ones), 3), FAR)
        self.discs[:, 2] = [robots[k].footprint.radius for k in round_ones]
        self.disc_heights = np.reshape([heights[k] for k in round_ones], (-1, 2))

    def __len__(self) -> int:
        return len(self.robots)

    def place(self, poses: Sequence[Pose | None]) -> None:
        """Put them where they are; None has left."""
        self.poses = tuple(poses)
        side = disc = 0
        for robot, pose in zip(self.robots, poses, strict=True):
            if len(robot.footprint.corners) == 0:
                self.discs[disc, :2] = FAR if pose is None else pose[:2]
                disc += 1
                continue
            corners = _outline(robot, pose)
            end = side + len(corners)
            self.plates[side:end, :2] = corners
            self.plates[side:end, 2:] = np.roll(corners, -1, axis=0)
            if pose is None:
                self.plates[side:end] = FAR
            side = end


def _outline(robot: OtherRobot, pose: Pose | None = None) -> Array:
    x, y, yaw = pose or (0.0, 0.0, 0.0)
    return robot.footprint.outline(x, y, yaw)
