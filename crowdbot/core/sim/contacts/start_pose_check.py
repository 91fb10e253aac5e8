"""Refuses starts at which a robot stands in a wall, an obstacle, a person or another robot."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import combinations

import numpy as np

from crowdbot.core.crowd import CrowdEngine
from crowdbot.core.crowd import state as s
from crowdbot.core.crowd.contact.robot_contact import R_YAW, overlap
from crowdbot.core.geometry.footprint import footprint_of_model
from crowdbot.core.geometry.polygon import inside
from crowdbot.core.sim.built_run import BuiltRun
from crowdbot.core.sim.contacts.bodies import rows_of
from crowdbot.core.sim.contacts.outline_gap import outline_gap
from crowdbot.core.sim.contacts.outline_overlap import overlap_of_robots
from crowdbot.core.sim.control.kinematic import obstacles
from crowdbot.core.types.environment import EnvironmentParts
from crowdbot.core.types.motion import Pose
from crowdbot.core.types.robot import RobotModel
from crowdbot.errors import InputError

#: Tolerance for rounding of the document's numbers, m.
_TOLERANCE = 1e-6


def check_starts(builts: Mapping[str, BuiltRun], engine: CrowdEngine | None) -> None:
    """Check the start pose of each robot of a run.

    Raises:
        InputError: as `check_start`, or two robots overlap.
    """
    for name, built in builts.items():
        check_start(built.parts, built.model, built.task.start, engine, name)
    models, starts = [b.model for b in builts.values()], [b.task.start for b in builts.values()]
    check_apart(list(builts), models, starts)


def check_apart(names: Sequence[str], models: Sequence[RobotModel], starts: Sequence[Pose]) -> None:
    """Check that no two robots overlap at their starts.

    Raises:
        InputError: two do.
    """
    rows = rows_of(models)
    for row, start in zip(rows, starts, strict=True):
        row[[0, 1, R_YAW]] = start
    corners = [footprint_of_model(model).corners for model in models]
    for i, j in combinations(range(len(names)), 2):
        depth = overlap_of_robots(rows[i], corners[i], rows[j], corners[j])[0]
        if depth > _TOLERANCE:
            raise InputError(
                f"robots '{names[i]}' and '{names[j]}' would start in each other; move task.start"
            )


def check_start(
    parts: EnvironmentParts, robot: RobotModel, start: Pose, engine: CrowdEngine | None, name: str
) -> None:
    """Check the robot's whole outline; touching is allowed.

    Args:
        engine: engine with the people; those present at the start are checked.
        name: the robot's name, for the message.

    Raises:
        InputError: the robot overlaps something, or is inside a solid.
    """
    where = f"robot '{name}' at x {start.x:g} m, y {start.y:g} m"
    body = footprint_of_model(robot)
    walls, pillars = obstacles(parts, robot.height)
    depth = body.radius - outline_gap(walls, pillars, body.corners, *start)
    boxed = any(
        bottom < robot.height and inside(outline, start.x, start.y)
        for outline, (bottom, _) in zip(parts.solids, parts.solid_heights, strict=True)
    )
    if depth > _TOLERANCE or boxed or (depth >= 0.0 and len(body.corners) > 2):
        raise InputError(f"{where} would start in a wall or an obstacle; move task.start")
    if engine is None:
        return
    row = np.array([start.x, start.y, 0.0, 0.0, body.radius, 0.0, start.yaw, 0.0])
    _, people = s.view(engine.initial_state())
    for i in np.flatnonzero(people[:, s.WAITING] == s.PRESENT):
        away = start.x - people[i, s.X], start.y - people[i, s.Y]
        reach = body.radius + engine.agents.radius[i]
        if overlap(float(row[R_YAW]), body.corners, *away, reach)[0] > _TOLERANCE:
            raise InputError(
                f"{where} would start in agent {engine.agents.id[i]}, who stands at "
                f"x {people[i, s.X]:g} m, y {people[i, s.Y]:g} m; move one of them"
            )
