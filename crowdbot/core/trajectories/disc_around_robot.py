"""A robot with an outline, read as the disc around it."""

from __future__ import annotations

from dataclasses import replace

from crowdbot.core.trajectories.footprint_of_run import footprint_of
from crowdbot.core.trajectories.trajectories import Trajectories


def as_disc(run: Trajectories) -> Trajectories:
    """The same run of the least disc about the robot's origin that its outline is in.

    Many benchmarks know robots only so. It is the run itself where the robot is a disc, or where
    there is none.
    """
    return run.cached("as_disc", lambda: _as_disc(run))


def _as_disc(run: Trajectories) -> Trajectories:
    footprint = footprint_of(run)
    if footprint is None or run.robot is None:
        return run
    return replace(run, robot=replace(run.robot, radius=footprint.reach), robot_footprint=None)
