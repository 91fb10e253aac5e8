"""Personal space, compiled: ``|u - preferred| + sum exp(-gap / fade)``."""

from __future__ import annotations

import math

from crowdbot.plugin import (
    BASE,
    EXCESS,
    GRADIENT,
    PREPARE,
    WORK_COLUMNS,
    AgentRecord,
    CompiledCost,
    CostParams,
    NeighbourRecord,
    Pointer,
    Rows,
    WallRecord,
    as_record,
    as_rows,
    in_range,
    record_type,
    record_values,
)
from numba import njit

from crowdbot_acme.personal_space import PersonalSpaceSpec


class _Params(CostParams):
    """Parameters, which begin with the range; units are those of the spec."""

    ahead: float
    fade: float


class _Header:
    """Row 0 of ``work``, which is not cleared between agents."""

    count: float


class _Other:
    """A neighbour in ``work``: relative position, velocity, sum of the radii."""

    x: float
    y: float
    vx: float
    vy: float
    reach: float


_PARAMS, _HEADER = record_type(_Params), record_type(_Header)
_OTHER = record_type(_Other, WORK_COLUMNS)


@njit(BASE, cache=True, error_model="numpy")
def _base(ux: float, uy: float, preferred: float, max_speed: float, params: Pointer) -> float:
    return math.hypot(ux - preferred, uy)


@njit(PREPARE, cache=True, error_model="numpy")
def _prepare(
    agent: AgentRecord,
    near: Rows[NeighbourRecord],
    near_count: int,
    walls: Rows[WallRecord],
    wall_count: int,
    params: Pointer,
    work: Pointer,
) -> int:
    others, items = as_rows(work, _OTHER), 0
    for i in range(near_count):
        if in_range(near[i].d2, near[i].reach, params):
            items += 1
            other = others[items]
            other.x, other.y, other.reach = near[i].rx, near[i].ry, near[i].reach
            other.vx, other.vy = near[i].nvx, near[i].nvy
    as_record(work, _HEADER).count = items
    return items


@njit(cache=True, error_model="numpy")
def _gap(ux: float, uy: float, other: _Other, ahead: float) -> tuple[float, float, float]:
    """Return the future place of a neighbour (m), and the gap between the surfaces there (m)."""
    x = other.x + (other.vx - ux) * ahead
    y = other.y + (other.vy - uy) * ahead
    return x, y, math.hypot(x, y) - other.reach


@njit(EXCESS, cache=True, error_model="numpy")
def _excess(
    ux: float, uy: float, budget: float, agent: AgentRecord, work: Pointer, params: Pointer
) -> float:
    own, header, others = (
        as_record(params, _PARAMS),
        as_record(work, _HEADER),
        as_rows(work, _OTHER),
    )
    cost = 0.0
    for i in range(1, 1 + int(header.count)):
        _, _, gap = _gap(ux, uy, others[i], own.ahead)
        cost += math.exp(-gap / own.fade)
        if cost > budget:  # cannot win any more
            break
    return cost


@njit(GRADIENT, cache=True, error_model="numpy")
def _gradient(
    ux: float, uy: float, agent: AgentRecord, work: Pointer, params: Pointer, out: Pointer
) -> int:
    own, header, others = (
        as_record(params, _PARAMS),
        as_record(work, _HEADER),
        as_rows(work, _OTHER),
    )
    dx, dy = ux - agent.pvx, uy - agent.pvy
    off = max(math.hypot(dx, dy), 1e-9)
    gx, gy = dx / off, dy / off
    for i in range(1, 1 + int(header.count)):
        x, y, gap = _gap(ux, uy, others[i], own.ahead)
        away = max(math.hypot(x, y), 1e-9)
        slope = math.exp(-gap / own.fade) / own.fade * own.ahead / away
        gx, gy = gx + slope * x, gy + slope * y
    out[0], out[1] = gx, gy
    return 1


def build(spec: PersonalSpaceSpec) -> CompiledCost:
    """The functions with this spec's parameters."""
    return CompiledCost(
        base=_base,
        prepare=_prepare,
        excess=_excess,
        gradient=_gradient,
        params=record_values(
            _PARAMS,
            **spec.range.cost_params(),
            ahead=spec.ahead,
            fade=spec.fade,
        ),
        weight=spec.weight,
    )
