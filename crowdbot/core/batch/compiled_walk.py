"""CompiledWalk: predicts people on an empty floor over many decisions in one compiled call.

The result equals that of `CrowdEngine.decide` bit by bit, in a third of the time: most time of a
decision among forty people goes into calls from Python.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from crowdbot.core.batch.array_tables import ArrayTable, ScratchPool, floats1, floats2
from crowdbot.core.batch.crowd_tables import (
    FLAT,
    G_SHOWN,
    SEEN,
    crowd_table,
    group_tables,
    searches,
)
from crowdbot.core.batch.decide import decide_group, evade, look
from crowdbot.core.crowd import state as s
from crowdbot.core.crowd.contact.robot_contact import DISC as ROUND
from crowdbot.core.crowd.desired_acceleration import relaxation_time_of
from crowdbot.core.crowd.engine import LATER, CrowdEngine
from crowdbot.core.crowd.steering.parts import part_numbers, steer_among_discs
from crowdbot.core.crowd.steering.sorted_discs import sort_people
from crowdbot.core.crowd.velocity_search.neighbour_discs import most_discs
from crowdbot.core.crowd.velocity_search.neighbours import DISC, DiscRecord
from crowdbot.core.support.compiling.compile import kernel
from crowdbot.core.support.records import Rows, as_rows, rows_of
from crowdbot.core.support.ticks import TICK
from crowdbot.core.types.arrays import Array, Indices, Mask


def walks_compiled(engine: CrowdEngine) -> bool:
    """True if all people of a crowd without walls and routing sample velocities."""
    return all(searches(group) for group in engine.groups)


class CompiledWalk:
    """Decisions of an engine's people with one robot, which is a disc.

    Args:
        engine: without walls, pillars, routing, groups, border and wandering.
        radius: that people see, m.
    """

    def __init__(self, engine: CrowdEngine, radius: float) -> None:
        people, world = len(engine.agents), engine.world
        flat, self._robot = s.blank(people, 1), np.zeros((1, 8))
        flat[s.TICK] = LATER
        self._robot[0, 4:6] = radius
        self._blank, self._now = flat.copy(), LATER * TICK
        pool = ScratchPool()
        crowd = crowd_table(engine, flat, self._robot, ROUND[np.newaxis], np.zeros(1), pool)
        groups = group_tables(engine, self._robot, pool)
        self._kept: tuple[ArrayTable, ...] = (crowd, *groups)
        self._crowd, self._groups = crowd.entries, np.stack([g.entries for g in groups])
        dt = engine.ticks_per_decision * TICK
        self._relaxation = np.array(
            [max(relaxation_time_of(g.policy), dt) for g in engine.groups], np.float64
        )
        self._members = np.stack([g.members for g in engine.groups])
        self._parts = part_numbers(world.steering.spec)
        a, room = engine.agents, most_discs(people, 1, periodic=False)
        self._traits = np.array([a.avoided_radius, a.preferred_speed, a.max_acceleration])
        self._discs: tuple[Any, Any] = (rows_of(room, DISC), rows_of(room, DISC))
        self._scratch = (
            np.zeros((3, room), np.int64), np.zeros(people, np.bool_),
            np.zeros((people, 2)), np.zeros((people, 2)), np.zeros((1, 4)),
        )  # fmt: skip

    def walk(
        self, position: Array, velocity: Array, goal: Array, present: Mask, robots: Array, dt: float
    ) -> tuple[Array, Array, Array]:
        """Return positions, velocities and accelerations at each decision, (K, N, 2), SI units.

        Args:
            position, velocity, goal: (N, 2) at first, m and m/s.
            present: (N,) False for people to leave out.
            robots: (K, 4) x, y, vx, vy at each decision.
            dt: between two decisions, in which accelerations are kept, s.
        """
        found = np.zeros((3, len(robots), len(position), 2))
        walk(
            self._crowd, self._groups, (self._relaxation, self._members),
            self._parts, self._traits, *self._discs, self._scratch,
            self._blank, self._robot, np.ascontiguousarray(robots), position, velocity, goal,
            present, (dt, self._now), found,
        )  # fmt: skip
        return found[0], found[1], found[2]


@kernel
def walk(
    crowd: Indices, groups: Indices, of_groups: tuple[Array, Mask],
    parts: Array, traits: Array, discs: Rows[DiscRecord], ordered: Rows[DiscRecord],
    scratch: tuple[Indices, Mask, Array, Array, Array],
    blank: Array, robot: Array, robots: Array,
    position: Array, velocity: Array, goal: Array, present: Mask,
    times: tuple[float, float], found: Array,
) -> None:  # fmt: skip
    """Write positions, velocities and accelerations of people at each decision.

    Args:
        crowd, groups: as in `crowdbot.core.batch.decide.decide`.
        of_groups: relaxation times (G,), s, and members (G, N).
        parts: from `part_numbers`; time gap, personal space and lanes are used.
        traits: (3, N) avoided radius, preferred speed, largest acceleration.
        discs, ordered: scratch for all discs, unsorted and sorted.
        scratch: order of discs, who decides, headings, desired accelerations, a row of zeros.
        blank: a state without people.
        robot: (1, 8), changed in place; its rows at each decision are ``robots`` (K, 4).
        position to present: as in `CompiledWalk.walk`; left as they are.
        times: time between decisions; time at which all of them are evaluated, s.
        found: (3, K, N, 2).
    """
    dt, now = times
    flat, count = floats1(crowd, FLAT), position.shape[0]
    people = as_rows(flat[s.HEADER_SIZE : s.HEADER_SIZE + count * s.AGENT_COLUMNS], s.PERSON)
    places, speeds, pulls = found[0], found[1], found[2]
    for k in range(robots.shape[0]):
        _move(k, dt, position, velocity, places, speeds, pulls)
        for c in range(4):
            robot[0, c] = robots[k, c]
        for n in range(flat.shape[0]):
            flat[n] = blank[n]
        _place(people, places[k], speeds[k], goal, present)
        seen = floats2(crowd, SEEN)
        look(people, crowd, robot, seen)
        for g in range(groups.shape[0]):
            decide_group(people, crowd, groups[g], seen)
            _steer(
                people, places[k], speeds[k], goal, present, of_groups[1][g],
                floats2(groups[g], G_SHOWN), of_groups[0][g], parts, traits, discs, ordered,
                scratch,
            )  # fmt: skip
        evade(people, crowd, seen, now)
        for i in range(count):
            if present[i]:
                pulls[k, i, 0], pulls[k, i, 1] = people[i].ax, people[i].ay


@kernel
def _move(
    k: int, dt: float, position: Array, velocity: Array, places: Array, speeds: Array, pulls: Array
) -> None:
    """Write positions and velocities at decision k: the given ones, or moved on by ``dt``."""
    for i in range(position.shape[0]):
        for c in range(2):
            if k == 0:
                places[0, i, c], speeds[0, i, c] = position[i, c], velocity[i, c]
            else:
                after = speeds[k - 1, i, c] + dt * pulls[k - 1, i, c]
                both = speeds[k - 1, i, c] + after
                places[k, i, c] = places[k - 1, i, c] + 0.5 * dt * both
                speeds[k, i, c] = after


@kernel
def _place(people: s.People, position: Array, velocity: Array, goal: Array, present: Mask) -> None:
    """Put people where they are at a decision, each heading for the goal."""
    for i in range(position.shape[0]):
        p = people[i]
        p.x, p.y = position[i, 0], position[i, 1]
        p.vx, p.vy = velocity[i, 0], velocity[i, 1]
        p.goal_x, p.goal_y = goal[i, 0], goal[i, 1]
        p.waiting = s.PRESENT if present[i] else s.NOT_YET
        ax, ay = p.goal_x - p.x, p.goal_y - p.y
        away = max(math.hypot(ax, ay), 1e-9)
        p.dir_x, p.dir_y = ax / away, ay / away


@kernel
def _steer(
    people: s.People, position: Array, velocity: Array, goal: Array, present: Mask, members: Mask,
    robots: Array, relaxation: float, parts: Array, traits: Array, discs: Rows[DiscRecord],
    ordered: Rows[DiscRecord], scratch: tuple[Indices, Mask, Array, Array, Array],
) -> None:  # fmt: skip
    """Change what the members of a group want, as `SteeringParts.steer`."""
    orders, decides, heading, target, nothing = scratch
    count = sort_people(
        position, velocity, goal, traits, present, members, robots, nothing[:0, :3], nothing[0],
        True, discs, ordered, orders, heading, decides,
    )  # fmt: skip
    for i in range(position.shape[0]):
        target[i, 0], target[i, 1] = people[i].ax, people[i].ay
    steer_among_discs(
        parts, ordered[:count], orders, heading, decides, velocity, relaxation, target
    )
    for i in range(position.shape[0]):
        if decides[i]:
            limit, size = traits[2, i], math.hypot(target[i, 0], target[i, 1])
            share = min(1.0, limit / max(size, limit))
            people[i].ax, people[i].ay = target[i, 0] * share, target[i, 1] * share
