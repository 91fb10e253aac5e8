from __future__ import annotations

import math

from numba import njit

from crowdbot.plugin import (
    BASE,
    COST_PARAMS,
    EXCESS,
    PREPARE,
    WORK_COLUMNS,
    AgentRecord,
    CompiledCost,
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
from my_costs import QuickElbowRoomSpec
from my_costs.numpy_build import AHEAD


class Header:
    """Row 0 of ``work``."""

    count: float


class Place:
    """Future places of a neighbour, and the least distance to it; the other rows, m."""

    x: float
    y: float
    reach: float


HEADER, PLACE = record_type(Header), record_type(Place, WORK_COLUMNS)


@njit(BASE, cache=True, error_model="numpy")
def base(ux: float, uy: float, preferred: float, max_speed: float, params: Pointer) -> float:
    return math.hypot(ux - preferred, uy)


@njit(PREPARE, cache=True, error_model="numpy")
def prepare(
    agent: AgentRecord,
    near: Rows[NeighbourRecord],
    near_count: int,
    walls: Rows[WallRecord],
    wall_count: int,
    params: Pointer,
    work: Pointer,
) -> int:
    header, places = as_record(work, HEADER), as_rows(work, PLACE)
    items = 0
    for k in range(near_count):
        other = near[k]
        if in_range(other.d2, other.reach, params):
            items += 1
            place = places[items]
            place.x = other.rx + AHEAD * other.nvx
            place.y = other.ry + AHEAD * other.nvy
            place.reach = other.reach
    header.count = items
    return items


@njit(EXCESS, cache=True, error_model="numpy")
def excess(
    ux: float, uy: float, budget: float, agent: AgentRecord, work: Pointer, params: Pointer
) -> float:
    header, places, total = as_record(work, HEADER), as_rows(work, PLACE), 0.0
    for k in range(1, int(header.count) + 1):
        place = places[k]
        gap = math.hypot(place.x - AHEAD * ux, place.y - AHEAD * uy) - place.reach
        total += math.exp(-max(gap, 0.0))
        if total > budget:
            break
    return total


def build(spec: QuickElbowRoomSpec) -> CompiledCost:
    return CompiledCost(
        base=base,
        prepare=prepare,
        excess=excess,
        params=record_values(COST_PARAMS, range=spec.range, from_surface=0.0),
        weight=spec.weight,
    )
