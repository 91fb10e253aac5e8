"""A robot with an outline, treated as the disc around it."""

from __future__ import annotations

from dataclasses import replace

from crowdbot.core.trajectories.footprint_of_run import footprint_of
from crowdbot.core.trajectories.trajectories import Trajectories


def as_disc(run: Trajectories) -> Trajectories:
    """Return the run with the smallest disc around the robot's origin that contains its outline.

    Many benchmarks only support discs. If the robot is a disc, or there is none, this is the run
    itself.
    """
    return run.cached("as_disc", lambda: _as_disc(run))


def _as_disc(run: Trajectories) -> Trajectories:
    footprint = footprint_of(run)
    if footprint is None or run.robot is None:
        return run
    return replace(run, robot=replace(run.robot, radius=footprint.reach), robot_footprint=None)
