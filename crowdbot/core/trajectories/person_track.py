"""The person of a robot's task over a run, and the robot's position relative to that person."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.geometry.footprint import Footprint
from crowdbot.core.geometry.stance import (
    PersonCircle,
    in_place,
    off,
    together,
    wanted_direction,
    wrapped,
)
from crowdbot.core.trajectories.encounters import robot_of, robot_velocities
from crowdbot.core.trajectories.footprint_of_run import footprint_of
from crowdbot.core.trajectories.preprocess import truncate_at_arrival
from crowdbot.core.trajectories.tracks import AgentTracks
from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.core.types.arrays import Array, Mask
from crowdbot.core.types.person_task import PersonTask, TaskPerson

#: People face where they walk when faster than this, m/s, as in the crowd engine.
_TURNS_ABOVE = 0.1


def members_of(agents: AgentTracks, person: TaskPerson) -> NDArray[np.int64]:
    """Return columns of the recorded people that a task is about."""
    return np.flatnonzero(np.isin(agents.id, person.id))


def person_over_time(agents: AgentTracks, person: TaskPerson) -> PersonCircle:
    """Return the person, or the circle around the group: arrays (N,), NaN where absent."""
    columns = members_of(agents, person)
    start = {int(i): f for i, f in zip(person.id, person.facing.tolist(), strict=True)}
    first = np.array([start[int(i)] for i in agents.id[columns]])
    facing = facing_over_time(agents.vx[:, columns], agents.vy[:, columns], first)
    return together(agents.x[:, columns], agents.y[:, columns], facing, agents.radius[columns])


def facing_over_time(vx: Array, vy: Array, first: Array) -> Array:
    """Return people's facing direction (N, M), rad: that of their present or last walking.

    Args:
        vx, vy: (N, M) m/s, NaN where absent.
        first: (M,) at the start, rad.
    """
    walks = np.hypot(vx, vy) > _TURNS_ABOVE
    walks[0] = True
    angle = np.where(walks, np.arctan2(vy, vx), np.nan)
    angle[0] = np.where(np.hypot(vx[0], vy[0]) > _TURNS_ABOVE, angle[0], first)
    latest = np.maximum.accumulate(np.where(walks, np.arange(len(vx))[:, None], 0), axis=0)
    return np.take_along_axis(angle, latest, axis=0)


@dataclass(frozen=True, slots=True, kw_only=True)
class PersonStance:
    """The robot's position relative to its person until the task ends; (N,), NaN where unknown.

    Attributes:
        task: what the robot is to do.
        t: s.
        gap: between the surfaces of robot and person, m.
        aside: how much the direction from the person to the robot is off the wanted one, rad; NaN
            also where the person has no front.
        in_place: True where the robot is in its place.
        advance: speed with which the robot itself comes nearer, m/s; at most that of the gap.
        touched: True if the robot touched the person.
    """

    task: PersonTask
    t: Array
    gap: Array
    aside: Array
    in_place: Mask
    advance: Array
    touched: bool


def person_stance(run: Trajectories, jump_speed: float) -> PersonStance | str:
    """Return the robot's relative position, or the reason why it is not defined.

    Args:
        run: with or without a task about a person.
        jump_speed: a faster step is a teleport, m/s.
    """
    return run.cached(("person_stance", jump_speed), lambda: _stance(run, jump_speed))


def _stance(run: Trajectories, jump_speed: float) -> PersonStance | str:
    if run.robot is None:
        return "invalid_no_robot"
    if run.person is None:
        return "invalid_no_person"
    if run.agents is None or not len(members_of(run.agents, run.person)):
        return "no_agents"
    run = truncate_at_arrival(run)
    assert run.agents is not None
    assert run.person is not None
    robot, task = robot_of(run), run.person.task
    person = person_over_time(run.agents, run.person)
    outline = footprint_of(run) or Footprint(np.zeros((0, 2)), robot.radius)
    found = off(outline, robot.x, robot.y, robot.theta, person)
    if not np.isfinite(found.gap).any():
        return "no_agents"
    return PersonStance(
        task=task,
        t=run.t,
        gap=found.gap,
        aside=np.abs(wrapped(found.around - wanted_direction(task, found.around))),
        in_place=np.asarray(in_place(task, found), np.bool_),
        advance=_advance(run, found.gap, person.x, person.y, jump_speed),
        touched=_touched(run, found.gap),
    )


def _advance(run: Trajectories, gap: Array, x: Array, y: Array, jump_speed: float) -> Array:
    """Return the robot's share of the speed with which the gap closes, (N,), m/s."""
    robot = robot_of(run)
    vx, vy = robot_velocities(run, jump_speed)
    dx, dy = x - robot.x, y - robot.y
    own = (vx * dx + vy * dy) / np.maximum(np.hypot(dx, dy), 1e-9)
    closing = -np.gradient(gap, run.t) if len(run.t) > 1 else np.zeros(len(run.t))
    share: Array = np.clip(np.minimum(own, closing), 0.0, None)
    return share


def _touched(run: Trajectories, gap: Array) -> bool:
    """Return True if a contact with the person was recorded, or the surfaces met."""
    assert run.person is not None
    if run.contacts is not None and np.isin(run.contacts.agent, run.person.id).any():
        return True
    return bool(np.any(gap <= 0.0)) if run.contacts is None else False
