"""The interface of cost functions, compiled or vectorised.

A cost is split into a *base*, which depends on the candidate alone as seen in the frame of the
preferred velocity, and an *excess* >= 0 caused by everything else: ``C(u) = base(u) + excess(u)``.
The base is a lower bound of the cost, so that candidates that cannot win are skipped. Either part
may be zero; either may be ``inf``, which forbids the candidate (never a huge number). Neither may
be NaN.

`CompiledCost`: module-level functions, compiled with ``@njit(SIGNATURE, cache=True,
error_model="numpy")``; float64 everywhere, SI units, world frame unless said otherwise:

- ``base(ux, uy, preferred, max_speed, params) -> cost``: candidate in the preferred frame, in
  which the preferred velocity is ``(preferred, 0)``, preferred > 0.
- ``prepare(agent, near, near_count, walls, wall_count, params, work) -> items``: once per agent and
  decision; writes data for the functions below to ``work``, whose row 0 is for counts and is not
  cleared between agents: write it always. If it returns 0 the excess is zero and not called. If
  it returns `MORE_WALLS` it is called again with all walls in range; see `CompiledCost.wall_reach`.
- ``excess(ux, uy, budget, agent, work, params) -> cost``: may stop and return anything above
  ``budget`` as soon as the cost exceeds it. Called for many candidates, in any order.
- ``lower_bound(count, ux, uy, agent, work, params, out) -> 1``: optional; into ``out`` a lower
  bound >= 0 of the excess for each of ``count`` candidates, exact up to rounding. Useful if a few
  operations on all candidates at once, without branches, exclude most of them.
- ``gradient(ux, uy, agent, work, params, out) -> 1``: optional; derivatives of the whole cost
  along x and y into ``out[0]`` and ``out[1]``; 0 if there is none to write. Without the function:
  central differences over 0.1 m/s of base plus excess. Called after ``prepare``, also where that
  returned 0.
- ``optimum(agent, work, params, out) -> 1``: optional; the velocity of least cost, where it is
  known in closed form, for the method ``global``; 0 if it is not known for this agent. Called
  after ``prepare``, also where that returned 0.

``agent``, ``near[j]`` and ``walls[s]`` are records, whose fields have names; see
`crowdbot.core.crowd.velocity_search.records`. The other arguments that are not numbers are pointers
to float64: otherwise ten thousands of calls per decision would spend most of their time on passing
arrays. A function names its own with `as_record` and `as_rows`, free of charge. Functions that ask
for the first collision share `crowdbot.core.crowd.velocity_search.collision`.

`NumpyCost`: one function over all candidates of an agent, if speed is not needed.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numba import njit, types
from numpy.typing import NDArray

from crowdbot.core.crowd.velocity_search.records import AGENT, COST_PARAMS, NEIGHBOUR, WALL
from crowdbot.core.registry.plugin_boundary import PluginCall
from crowdbot.core.support.records import as_record, record_argument, rows_argument
from crowdbot.core.types.arrays import Array

#: Type in compiled code instead of an array of float64; indexed like one.
Pointer = Any

_F, _I = types.float64, types.int64
_P = types.CPointer(_F)  # type: ignore[no-untyped-call]
_AGENT = record_argument(AGENT)
BASE = types.float64(_F, _F, _F, _F, _P)
PREPARE = types.int64(_AGENT, rows_argument(NEIGHBOUR), _I, rows_argument(WALL), _I, _P, _P)
EXCESS = types.float64(_F, _F, _F, _AGENT, _P, _P)
GRADIENT = types.int64(_F, _F, _AGENT, _P, _P, _P)
OPTIMUM = types.int64(_AGENT, _P, _P, _P)
LOWER_BOUND = types.int64(_I, _P, _P, _AGENT, _P, _P, _P)
#: Field of `CompiledCost` -> signature of its function, in the order of `agent_costs.BASES` etc.
SIGNATURES: Mapping[str, Any] = {
    "base": BASE, "prepare": PREPARE, "excess": EXCESS, "lower_bound": LOWER_BOUND,
    "gradient": GRADIENT, "optimum": OPTIMUM,
}  # fmt: skip


#: Result of ``prepare`` where walls that were not given may matter.
MORE_WALLS = -1
#: ``wall_reach`` that suits functions whose farther walls are looked up by `first_collision`, m.
NEAR_WALLS = 4.0


def work_rows(others: int) -> int:
    """Return the number of rows of ``work`` for this many neighbours and walls.

    One header row, two rows for each, and 8 spare ones.
    """
    return 1 + 2 * others + 8


@dataclass(frozen=True, slots=True, kw_only=True)
class CompiledCost:
    """A cost function as numba functions, with its parameters and weight.

    Attributes:
        base, prepare, excess: numba functions of the signatures above.
        params: (P,), begins with the fields of `CostParams`.
        weight: factor of the cost, >= 0.
        gradient, optimum, lower_bound: numba functions of the signatures above, or None.
        ordered: True if excess must be called for every candidate in order, because it draws random
            numbers.
        call: call boundary to its plugin, with its name, or None.
        wall_reach: metres, and seconds at the fastest speed of a decision: a wall whose distance
            from the agent's surface is larger than the sum of both never changes a result. None:
            every wall in range may.
        reach_with_own: True if those seconds count at the fastest and the agent's own speed
            together: the root of the sum of their squares.
        reach_at_preferred: True if those seconds count at the preferred speed, where no function of
            the crowd needs more; `prepare` then checks that it has all walls that it needs.
        looks_farther: True if farther walls may change a result, and the functions look for them
            where they do: by `first_collision`, or by `MORE_WALLS`.
        points: reach and fading, m: the function looks up the nearest points of walls by
            `write_nearest_points`, up to the reach, and those beyond count exp(-1) times less for
            each fading; (0, 0) if it does not.
        walls_on_the_way: True if, where gradients are followed, only those walls may change a
            result that the agent comes within the metres of ``wall_reach`` of, in its seconds, at
            the present velocity.
        optimum_by_nearby_walls: True if an optimum that differs by less than d from the present
            velocity is the same bit by bit without most walls: those farther than the metres of
            ``wall_reach`` plus one second at d and the own speed from the agent, and farther than
            the metres plus the seconds at d from its way at the present velocity in these seconds.
    """

    base: Callable[..., Any]
    prepare: Callable[..., Any]
    excess: Callable[..., Any]
    params: Array
    weight: float
    gradient: Callable[..., Any] | None = None
    optimum: Callable[..., Any] | None = None
    lower_bound: Callable[..., Any] | None = None
    ordered: bool = False
    call: PluginCall | None = None
    wall_reach: tuple[float, float] | None = None
    reach_with_own: bool = False
    reach_at_preferred: bool = False
    looks_farther: bool = False
    points: tuple[float, float] = (0.0, 0.0)
    walls_on_the_way: bool = False
    optimum_by_nearby_walls: bool = False

    def reach(self, radius: float, largest_radius: float) -> float:
        """Return the centre distance beyond which no neighbour counts, m."""
        distance, from_surface = self.params[:2]
        return _reach(distance, bool(from_surface), radius, largest_radius)


@dataclass(frozen=True, slots=True, kw_only=True)
class AgentView:
    """The agent as a vectorised cost function sees it; SI units.

    Attributes:
        position, velocity, preferred_velocity, goal: (2,).
        radius, preferred_speed, max_speed, max_acceleration, time_step, relaxation_time: numbers.
    """

    position: Array
    velocity: Array
    preferred_velocity: Array
    goal: Array
    radius: float
    preferred_speed: float
    max_speed: float
    max_acceleration: float
    time_step: float
    relaxation_time: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Neighbours:
    """The others within its range, as a vectorised cost function sees them; SI units.

    Attributes:
        offset, velocity, preferred_velocity: (M, 2), positions relative to the agent.
        radius: (M,).
        fixed: (M,) True for pillars.
        walls: (W, 4) both ends of wall segments relative to the agent.
    """

    offset: Array
    velocity: Array
    preferred_velocity: Array
    radius: Array
    fixed: NDArray[np.bool_]
    walls: Array


@dataclass(frozen=True, slots=True, kw_only=True)
class NumpyCost:
    """One cost function without compiled code; slower.

    Attributes:
        evaluate: candidates (S, 2), agent, neighbours -> costs (S,); ``inf`` forbids.
        range: range of its neighbours and walls, m.
        from_surface: True if the range is measured between surfaces.
        weight: factor of the cost, >= 0.
        call: as in `CompiledCost`.
    """

    evaluate: Callable[[Array, AgentView, Neighbours], Array]
    range: float
    weight: float
    from_surface: bool = False
    call: PluginCall | None = None

    def reach(self, radius: float, largest_radius: float) -> float:
        """Return the centre distance beyond which no neighbour counts, m."""
        return _reach(self.range, self.from_surface, radius, largest_radius)


def _reach(distance: float, from_surface: bool, radius: float, largest_radius: float) -> float:
    return float(distance) + (radius + largest_radius if from_surface else 0.0)


@njit(cache=True, inline="always")
def in_range(d2: float, radii: float, params: Pointer) -> bool:
    """Return True if a squared distance is within a function's range, strictly.

    Args:
        d2: squared centre distance to a neighbour, or squared distance to a wall, m^2.
        radii: subtracted if the range is measured between surfaces: the sum of the radii, or the
            agent's radius for a wall, m.
    """
    own = as_record(params, COST_PARAMS)
    reach = own.range + own.from_surface * radii
    return bool(d2 < reach * reach)
