"""Weighted cost functions, prepared for the decisions of one set of agents."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.crowd.agents import Agents
from crowdbot.core.crowd.policy import CrowdView
from crowdbot.core.crowd.velocity_search.agent_costs import (
    FUNCTION_COLUMNS,
    PARAMS,
    WORK,
)
from crowdbot.core.crowd.velocity_search.cost import SIGNATURES, CompiledCost, NumpyCost, work_rows
from crowdbot.core.crowd.velocity_search.cost_calls import address_of
from crowdbot.core.crowd.velocity_search.floor import floor_of
from crowdbot.core.crowd.velocity_search.minstd import seeds
from crowdbot.core.crowd.velocity_search.neighbour_discs import most_discs
from crowdbot.core.crowd.velocity_search.neighbours import DISC, START_ROWS, DiscRecord, Starts
from crowdbot.core.crowd.velocity_search.records import (
    AGENT,
    NEIGHBOUR,
    WALL,
    WORK_COLUMNS,
    AgentRecord,
    NeighbourRecord,
    WallRecord,
)
from crowdbot.core.crowd.velocity_search.surroundings import (
    SETTINGS,
    TRAITS,
    SettingsRecord,
    Surroundings,
    sort_surroundings,
)
from crowdbot.core.geometry.segment_grid import SegmentGrid, grid_of
from crowdbot.core.support.records import Rows, rows_of
from crowdbot.core.types.arrays import Array, Indices

_Addresses = NDArray[np.intp]
_NO_BOX = np.zeros(4)
#: Speeds up to these multiples of the largest maximum, and of the largest preferred one where
#: only the present speed counts, find their walls by the grid.
_PUSHED, _HURRIED = 1.05, 1.25
#: Added against rounding.
_SLACK = 1e-6
#: Fields of `SettingsRecord` that depend on the walls.
_WALL_SETTINGS = (
    "wall_metres",
    "wall_seconds",
    "wall_own",
    "wall_preferred",
    "wall_grid",
    "wall_way",
    "wall_more",
    "floor",
)


class DecisionTables(NamedTuple):
    """Records for the decisions of one set of agents; all but the settings are scratch.

    Attributes:
        discs, table, near, found, deciding, settings: as in `Surroundings`; ``discs`` are those of
            ``table`` before sorting.
        starts, order: for `neighbours.sort_discs`.
    """

    discs: Rows[DiscRecord]
    table: Rows[DiscRecord]
    near: Rows[NeighbourRecord]
    found: Rows[WallRecord]
    deciding: Rows[AgentRecord]
    settings: Rows[SettingsRecord]
    starts: Starts
    order: Indices


class WeightedCosts:
    """Weighted cost functions for one set of agents.

    Args:
        relaxation_time: relaxation time of the policy, s.
        parity: reproduce the original engine, defects included; for comparisons only.
        weight: (N,) see `AgentRecord`; 1 by default.
    """

    def __init__(
        self,
        costs: Sequence[CompiledCost | NumpyCost],
        agents: Agents,
        *,
        relaxation_time: float = 0.0,
        parity: bool = False,
        weight: Array | None = None,
    ) -> None:
        self.agents, self.parity, self.relaxation_time = agents, parity, relaxation_time
        self._all = tuple(costs)
        self.largest = float(np.max(agents.avoided_radius, initial=0.0))
        # Functions with few neighbours first: their excess is cheaper.
        self.compiled = sorted(
            (c for c in costs if isinstance(c, CompiledCost)),
            key=lambda c: c.reach(self.largest, self.largest),
        )
        self.vectorised = [c for c in costs if isinstance(c, NumpyCost)]
        self.ordered = any(c.ordered for c in self.compiled)
        self.functions = np.zeros((len(self.compiled), FUNCTION_COLUMNS), np.intp)
        for part, (name, signature) in enumerate(SIGNATURES.items()):
            found = [getattr(c, name) for c in self.compiled]
            self.functions[:, part] = _addresses(found, signature)
        width = max((len(c.params) for c in self.compiled), default=2)
        self.params = np.zeros((len(self.compiled), width))
        for row, cost in zip(self.params, self.compiled, strict=True):
            row[: len(cost.params)] = cost.params
        self.functions[:, PARAMS] = layers(self.params)
        self.weights = np.array([c.weight for c in self.compiled], np.float64)
        # Scratch of compiled loops: functions whose excess may be nonzero.
        self.active = np.zeros(len(self.compiled), np.int64)
        ones = np.ones(len(agents)) if weight is None else weight
        self.traits = rows_of(len(agents), TRAITS)
        self.traits["preferred"][:] = agents.preferred_speed
        self.traits["max_speed"][:] = agents.max_speed
        self.traits["max_acceleration"][:] = agents.max_acceleration
        self.traits["weight"][:] = ones
        self.random = seeds(agents.id)
        self._settings, self._deciding = rows_of(1, SETTINGS), rows_of(1, AGENT)
        self._settings["relaxation"][:], self._settings["parity"][:] = relaxation_time, parity
        self._time_step, self._broken = self._settings["time_step"], self._deciding["broken"]
        self._largest_seen, self._reach = math.nan, 0.0
        #: Largest distance from the present velocity at which costs are asked for, m/s; 0 if they
        #: are asked for anywhere.
        self.around = 0.0
        self._grid: tuple[Array, float, SegmentGrid] | None = None
        self._discs, self._found = rows_of(0, DISC), rows_of(0, WALL)
        self._starts = np.zeros((START_ROWS, 2), np.int64)
        self._make_room(1, 0)

    def reach(self, view: CrowdView) -> float:
        """Return the centre distance beyond which no disc matters to a person, m."""
        largest = self.largest
        for discs in (view.robot, view.pillars):
            if len(discs):
                largest = max(largest, float(discs[:, -1].max()))
        if largest != self._largest_seen:
            self._largest_seen = largest
            self._reach = self.reach_of(largest)
        return self._reach

    def reach_of(self, largest: float) -> float:
        """Return the centre distance beyond which discs up to a radius never matter, m."""
        return max((c.reach(self.largest, largest) for c in self._all), default=0.0)

    def wall_grid(self, walls: Array, largest: float) -> SegmentGrid:
        """Return the grid for looking up walls; its range becomes that of later decisions.

        Args:
            walls: (S, 4), m.
            largest: the largest radius of a disc, m.
        """
        if self._grid is None or self._grid[0] is not walls or self._grid[1] != largest:
            self._grid = walls, largest, self._built_grid(walls, largest)
        return self._grid[2]

    def nearby_walls(self, walls: Array, change: float) -> tuple[SegmentGrid, float]:
        """Return the grid of walls that matter to an optimum near the velocity, and its reach (m).

        Args:
            change: largest difference from the present velocity, m/s.
        """
        if self.parity:
            return grid_of(walls, math.inf), 0.0
        walked = _HURRIED * self._preferred_speed()
        metres, seconds = self._walls_matter(self._largest_seen)
        covered = metres + seconds * (walked + change)
        return grid_of(walls, covered), covered

    def _built_grid(self, walls: Array, largest: float) -> SegmentGrid:
        reach, (metres, seconds) = self.reach_of(largest), self._walls_matter(largest)
        own = any(c.reach_with_own for c in self.compiled)
        preferred = all(c.reach_at_preferred for c in self.compiled)
        speed = self._preferred_speed() if preferred else self._usual_speed(own=own)
        covered = min(reach, metres + seconds * speed)
        more = any(c.looks_farther for c in self.compiled)
        way = not more and all(
            c.walls_on_the_way or c.wall_reach == (0.0, 0.0) for c in self.compiled
        )
        if self.parity or self.vectorised:
            metres, seconds, own, preferred = reach, 0.0, False, False
            covered, way, more = reach, False, False
        reaches, fadings = zip((0.0, 0.0), *(c.points for c in self.compiled), strict=True)
        self._floor, floor = floor_of(walls, self.largest, (max(reaches), max(fadings)))
        values = metres, seconds, own, preferred, covered, way, more, floor
        for name, value in zip(_WALL_SETTINGS, values, strict=True):
            self._settings[name][:] = value
        return grid_of(walls, covered)

    def _usual_speed(self, *, own: bool) -> float:
        """Return a speed that most decisions do not exceed in their search for walls, m/s."""
        walked = _HURRIED * self._preferred_speed()
        fastest = _PUSHED * float(np.max(self.agents.max_speed, initial=0.0))
        fastest_asked = min(fastest, walked + self.around) if self.around > 0.0 else fastest
        return math.hypot(fastest_asked, walked) if own else fastest_asked

    def _preferred_speed(self) -> float:
        """Return the largest preferred speed of the agents, m/s."""
        return float(np.max(self.agents.preferred_speed, initial=0.0))

    def _walls_matter(self, largest: float) -> tuple[float, float]:
        """Return the distance within which walls matter: metres, and seconds at full speed."""
        each = [
            (c.reach(self.largest, largest), 0.0)
            if c.wall_reach is None
            else (c.wall_reach[0] + self.largest + _SLACK, c.wall_reach[1] * (1.0 + _SLACK))
            for c in self.compiled
        ]
        return max((m for m, _ in each), default=0.0), max((s for _, s in each), default=0.0)

    def tables(self, discs: int, walls: int, dt: float) -> DecisionTables:
        """Return the tables for decisions every ``dt`` seconds; larger ones where needed."""
        self._make_room(discs, walls)
        self._time_step[0] = dt
        return DecisionTables(
            self._discs, self._table, self._near, self._found, self._deciding, self._settings,
            self._starts, self._order,
        )  # fmt: skip

    def surroundings(self, view: CrowdView) -> Surroundings:
        """Sort all discs of a view, and return the data for compiled loops.

        Tables and scratch are reused if large enough.
        """
        reach, boundary, walls = self.reach(view), view.periodic_boundary, len(view.walls)
        self._make_room(
            most_discs(
                len(view.position), len(view.robot) + len(view.pillars), boundary is not None
            ),
            walls,
        )
        count, height, low, strips = sort_surroundings(
            view.position, view.velocity, view.goal, view.agents.avoided_radius,
            view.agents.preferred_speed, view.present, view.robot, view.pillars,
            _NO_BOX if boundary is None else np.array(boundary), view.diagonal, reach,
            self._discs, self._table, self._starts, self._order,
        )  # fmt: skip
        self._time_step[0], self._broken[0] = view.dt, 0.0
        grid = self.wall_grid(view.walls, self._largest_seen)
        return Surroundings(
            self._table[:count], self._starts[: strips + 1], low, height,
            view.present if view.decides is None else view.present & view.decides,
            view.goal, view.walls, *grid, reach, self.traits,
            self._settings, self.random, self._near, self._found, self._deciding,
        )  # fmt: skip

    def _make_room(self, discs: int, walls: int) -> None:
        if self._discs.shape[0] < discs or self._found.shape[0] < walls:
            self._discs, self._table = rows_of(discs, DISC), rows_of(discs, DISC)
            self._near, self._found = rows_of(discs, NEIGHBOUR), rows_of(walls, WALL)
            self._order = np.zeros((2, discs), np.int64)
            self.work = np.zeros((len(self.compiled), work_rows(discs + walls), WORK_COLUMNS))
            self.functions[:, WORK] = layers(self.work)


def _addresses(functions: Sequence[object], signature: object) -> _Addresses:
    return np.array([0 if f is None else address_of(f, signature) for f in functions], np.intp)


def layers(array: Array) -> _Addresses:
    """Return the addresses of an array's parts along its first axis; valid while it lives."""
    return np.asarray(array.ctypes.data + array.strides[0] * np.arange(len(array)), np.intp)
