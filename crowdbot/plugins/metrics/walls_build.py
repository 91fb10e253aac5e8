"""Scoring of distance to walls and contacts with them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

import crowdbot.plugins.metrics.walls as specs
from crowdbot.plugin import (
    Array,
    Footprint,
    References,
    RobotTrack,
    Score,
    Trajectories,
    time_weights,
)
from crowdbot.plugin.for_metrics import (
    contact_events,
    footprint_of,
    inf_to_nan,
    robot_of,
    valid_robot_steps,
)
from crowdbot.plugins.metrics.declared_build import RobotMetric, UndefinedError


class WallContactCount(RobotMetric[specs.WallContactCountSpec]):
    """Scores ``wall_contact_count``: contacts with all walls as one body.

    ``recorded`` needs a table of contacts; ``geometric`` needs walls, by the rules of
    ``collision_count``.
    """

    def _scores(self, run: Trajectories, _: References) -> Sequence[Score]:
        return [self._recorded(run), self.geometric(run)]

    def _recorded(self, run: Trajectories) -> Score:
        if run.contacts is None:
            return self.factory.undefined("recorded", "invalid_no_contacts")
        return self.factory.ok("recorded", (run.contacts.agent == -1).sum())

    def geometric(self, run: Trajectories) -> Score:
        """Score contacts between the robot's outline and walls, computed from its motion."""
        tol = self.spec.contact_tol
        try:
            gap = wall_gap(run)
        except UndefinedError:
            return self.factory.undefined("geometric", "invalid_no_walls")
        valid = valid_robot_steps(run.t, robot_of(run), self.spec.jump_speed)[:, None]
        found = contact_events(
            run.t,
            gap[:, None],
            self._first_touch(run, gap)[:, None],
            valid,
            contact_tol=tol,
            release_gap=self.spec.release_gap,
        )
        return self.factory.ok("geometric", len(found.time))

    def _first_touch(self, run: Trajectories, gap: Array) -> Array:
        """Return the fraction of each step (N-1,) at which a wall is first touched; NaN if none is.

        A disc is swept along the step; a footprint, which may turn, is checked at the step's end.
        """
        robot, tol = robot_of(run), self.spec.contact_tol
        first = np.where(gap[1:] <= tol, 1.0, np.inf)
        if footprint_of(run) is None:
            reach = np.array(robot.radius + tol)
            x, y = inf_to_nan(robot.x), inf_to_nan(robot.y)
            for wall in _segments(run):
                swept = wall.first_touch(x[:-1], y[:-1], np.diff(x), np.diff(y), reach)
                first = np.minimum(first, swept)
        first = np.where(gap[:-1] <= tol, 0.0, first)
        return np.where(first <= 1.0, first, np.nan)


def wall_contacts(
    run: Trajectories, contact_tol: float, release_gap: float, jump_speed: float
) -> int:
    """Return the number of contacts with walls: recorded, else by geometry; 0 without walls."""
    if run.contacts is not None:
        return int((run.contacts.agent == -1).sum())
    spec = specs.WallContactCountSpec(
        contact_tol=contact_tol, release_gap=release_gap, jump_speed=jump_speed
    )
    value = WallContactCount(spec).geometric(run).value
    return 0 if value is None else int(value)


class MinWallClearance(RobotMetric[specs.MinWallClearanceSpec]):
    """Scores ``min_wall_clearance``: the smallest gap at any sample. Needs walls."""

    def _scores(self, run: Trajectories, _: References) -> Sequence[Score]:
        return [self.factory.ok("corrected", np.nanmin(wall_gap(run)))]


class AvgWallClearance(RobotMetric[specs.AvgWallClearanceSpec]):
    """Scores ``avg_wall_clearance``: the mean gap over time. Needs walls."""

    def _scores(self, run: Trajectories, _: References) -> Sequence[Score]:
        gap = wall_gap(run)
        known = np.isfinite(gap)
        weights = time_weights(run.t)[known]
        if weights.sum() <= 0:
            raise UndefinedError("too_few_samples")
        return [self.factory.ok("corrected", weights @ gap[known] / weights.sum())]


def wall_gap(run: Trajectories) -> Array:
    """Return the gap to the nearest wall (N,), m.

    At most 0 in contact; the depth is exact for discs only.

    Raises:
        UndefinedError: there is no wall, or no sample.
    """
    if run.walls is None or not run.walls.size:
        raise UndefinedError("invalid_no_walls")
    gap = run.cached("wall_gap", lambda: _gap(run))
    if not np.isfinite(gap).any():
        raise UndefinedError("too_few_samples")
    return gap


def _gap(run: Trajectories) -> Array:
    robot, outline = robot_of(run), footprint_of(run)
    robot = replace(
        robot,
        x=inf_to_nan(robot.x),
        y=inf_to_nan(robot.y),
        theta=inf_to_nan(robot.theta),
    )
    if outline is None:
        gaps = [wall.gap(robot.x, robot.y) - robot.radius for wall in _segments(run)]
    else:
        gaps = [_outline_gap(outline, wall.corners, robot) for wall in _segments(run)]
    nearest: Array = np.min(gaps, axis=0)
    return nearest


def _outline_gap(outline: Footprint, wall: Array, robot: RobotTrack) -> Array:
    """Return the least distance between wall and outline, from wall ends and outline corners."""
    c, s = np.cos(robot.theta), np.sin(robot.theta)
    ends = []
    for wx, wy in wall:
        dx, dy = wx - robot.x, wy - robot.y
        ends.append((c * dx + s * dy, c * dy - s * dx))
    gap = np.minimum(*(outline.gap(*end) for end in ends))
    for cx, cy in outline.corners:
        corner = robot.x + c * cx - s * cy, robot.y + s * cx + c * cy
        gap = np.minimum(gap, Footprint(wall, 0.0).gap(*corner) - outline.radius)
    (ax, ay), (bx, by) = ends
    crossed = outline.first_touch(ax, ay, bx - ax, by - ay, np.zeros(()))
    return np.where(crossed <= 1.0, np.minimum(gap, 0.0), gap)


def _segments(run: Trajectories) -> list[Footprint]:
    assert run.walls is not None
    return [Footprint(row.reshape(2, 2), 0.0) for row in run.walls]
