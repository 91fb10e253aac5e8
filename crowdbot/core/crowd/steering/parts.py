"""The steering parts, in the order in which they change accelerations, in one compiled call."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from crowdbot.core.crowd.agents import Agents
from crowdbot.core.crowd.policy import CrowdView
from crowdbot.core.crowd.steering.lanes import keep_all
from crowdbot.core.crowd.steering.parameters import Steering
from crowdbot.core.crowd.steering.personal_space import push_all
from crowdbot.core.crowd.steering.sorted_discs import sort_people
from crowdbot.core.crowd.steering.time_gap import limit_all
from crowdbot.core.crowd.steering.wall_push import LEAST, push_off_walls
from crowdbot.core.crowd.steering.wander import E_FOLD, no_draws, wander_all
from crowdbot.core.crowd.velocity_search.neighbour_discs import most_discs
from crowdbot.core.crowd.velocity_search.neighbours import DISC, DiscRecord
from crowdbot.core.geometry.segment_grid import grid_of
from crowdbot.core.support.compiling.compile import kernel
from crowdbot.core.support.records import Rows, rows_of
from crowdbot.core.types.arrays import Array, Indices, Mask
from crowdbot.dsl.scenario.steering import SteeringSpec

#: Field of `SteeringSpec` -> fields of the part's spec. Parts change accelerations in this order:
#: first limits, then pushes.
PARTS: Mapping[str, tuple[str, ...]] = {
    "time_gap": ("time", "oncoming_time", "room", "half_width"),
    "personal_space": ("strength", "reach", "anticipation", "behind"),
    "lanes": ("strength", "reach", "half_width", "follow"),
    "wall_push": ("strength", "reach"),
    "wander": ("deviation", "time"),
}
GAP, SPACE, LANES, WALLS, WANDER = range(5)
_NO_BOX = np.zeros(4)


def part_numbers(spec: SteeringSpec) -> Array:
    """Return (5, 5) a row for each of `PARTS`: 1 if it is on, then its fields."""
    numbers = np.zeros((len(PARTS), 5))
    for row, (name, fields) in zip(numbers, PARTS.items(), strict=True):
        part = getattr(spec, name)
        if part is not None:
            row[: 1 + len(fields)] = 1.0, *(getattr(part, field) for field in fields)
    return numbers


class SteeringParts:
    """A crowd's steering parts, with scratch arrays."""

    def __init__(self, steering: Steering) -> None:
        self.numbers, self._key = part_numbers(steering.spec), np.uint64(steering.key)
        self._agents: Agents | None = None
        self._make_room(0, 0)

    def steer(self, view: CrowdView, relaxation: float, desired: Array) -> Array:
        """Return accelerations (N, 2) after all parts, within each agent's limit, m/s^2.

        Args:
            relaxation: time in which the policy reaches the velocity that it has chosen, s; 0 is
                the time between decisions.
            desired: (N, 2) accelerations of the policy, m/s^2; not changed.
        """
        agents, boundary, changed = view.agents, view.periodic_boundary, np.array(desired)
        if agents is not self._agents:
            self._meet(agents)
        people = len(changed)
        fixed = len(view.robot) + len(view.pillars)
        room = most_discs(people, fixed, boundary is not None)
        if people > len(self._decides) or room > self._discs[0].shape[0]:
            self._make_room(people, room)
        grid = grid_of(view.walls, self._largest + LEAST * float(self.numbers[WALLS, 2]))
        steer_people(
            self.numbers, self._key, self._traits, agents.id,
            view.position, view.velocity, view.goal, view.present,
            view.present if view.decides is None else view.decides, view.robot, view.pillars,
            _NO_BOX if boundary is None else np.array(boundary), view.diagonal, view.walls, *grid,
            view.t, max(relaxation, view.dt), *self._discs, self._orders, self._heading,
            self._decides, self._draws, changed,
        )  # fmt: skip
        return changed

    def _meet(self, agents: Agents) -> None:
        """Store the traits of agents for `steer`."""
        self._agents = agents
        self._traits = np.array(
            [agents.avoided_radius, agents.preferred_speed, agents.max_acceleration]
        )
        self._largest = float(np.max(agents.avoided_radius, initial=0.0))
        self._draws = no_draws(len(agents))

    def _make_room(self, people: int, room: int) -> None:
        self._discs = rows_of(room, DISC), rows_of(room, DISC)
        self._orders = np.zeros((3, max(room, people)), np.int64)
        self._heading, self._decides = np.zeros((people, 2)), np.zeros(people, np.bool_)


def parts_of(steering: Steering) -> SteeringParts | None:
    """Return a crowd's steering parts; None if all are off."""
    parts = SteeringParts(steering)
    return parts if np.any(parts.numbers[:, 0]) else None


@kernel
def steer_people(
    parts: Array, key: np.uint64, traits: Array, ids: Indices,
    position: Array, velocity: Array, goal: Array, present: Mask, members: Mask,
    robots: Array, pillars: Array, box: Array, diagonal: bool,
    walls: Array, frame: Array, first: Indices, cells: Indices, t: float, relaxation: float,
    unsorted: Rows[DiscRecord], discs: Rows[DiscRecord], orders: Indices, heading: Array,
    decides: Mask, draws: Array, desired: Array,
) -> None:  # fmt: skip
    """Change accelerations (N, 2) by all parts, then limit them, in place, m/s^2.

    Args:
        parts: from `part_numbers`; key: as in `Steering`; ids: (N,) of people.
        traits to diagonal, unsorted to decides: as in `sort_people`.
        walls to cells: as in `push_off_walls`.
        t: s; draws: as in `wander_all`.
        relaxation: s, at least the time between decisions.
    """
    count = sort_people(
        position, velocity, goal, traits, present, members, robots, pillars, box, diagonal,
        unsorted, discs, orders, heading, decides,
    )  # fmt: skip
    steer_among_discs(parts, discs[:count], orders, heading, decides, velocity, relaxation, desired)
    if parts[WALLS, 0] != 0.0:
        push_off_walls(
            decides, position, traits[0], walls, frame, first, cells, parts[WALLS, 1],
            parts[WALLS, 2], desired,
        )  # fmt: skip
    if parts[WANDER, 0] != 0.0:
        knots = t * E_FOLD / parts[WANDER, 2]
        wander_all(decides, ids, knots, parts[WANDER, 1], key, draws, desired)
    for i in range(desired.shape[0]):
        limit, size = traits[2, i], math.hypot(desired[i, 0], desired[i, 1])
        share = min(1.0, limit / max(size, limit))
        desired[i, 0] *= share
        desired[i, 1] *= share


@kernel
def steer_among_discs(
    parts: Array, near: Rows[DiscRecord], orders: Indices, heading: Array, decides: Mask,
    velocity: Array, relaxation: float, desired: Array,
) -> None:  # fmt: skip
    """Change accelerations (N, 2) by time gap, personal space and lanes, in place, m/s^2.

    Args:
        parts: from `part_numbers`.
        near, orders, heading, decides: sorted discs and what `sort_people` writes; but for its last
            row, ``orders`` is scratch.
        velocity, relaxation, desired: as in `steer_people`.
    """
    gap, space, lanes, row = parts[GAP], parts[SPACE], parts[LANES], orders[2]
    if gap[0] != 0.0:
        limit_all(
            near, row, heading, decides, velocity, gap[1], gap[2], gap[3], gap[4], relaxation,
            orders[0], desired,
        )  # fmt: skip
    if space[0] != 0.0:
        push_all(near, heading, decides, space[1], space[2], space[3], space[4], orders[0], desired)
    if lanes[0] != 0.0:
        keep_all(
            near, row, heading, decides, lanes[1], lanes[2], lanes[3], lanes[4], orders[0], desired
        )
