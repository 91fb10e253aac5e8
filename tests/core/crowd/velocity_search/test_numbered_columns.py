"""Cost functions of other packages that number their columns work as before."""
# ruff: noqa: ARG001 - the signatures are fixed

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from numba import njit

from crowdbot.core import interfaces
from crowdbot.core.crowd.velocity_search import numbered_columns
from crowdbot.core.crowd.velocity_search.cost import BASE, EXCESS, PREPARE, CompiledCost
from crowdbot.core.crowd.velocity_search.evaluate import Evaluator
from crowdbot.core.crowd.velocity_search.numbered_columns import (
    AX,
    BY,
    NVX,
    PX,
    REACH,
    RX,
    RY,
    STATIC,
    WEIGHT,
    near_table,
    wall_table,
    work_table,
)
from crowdbot.core.crowd.velocity_search.records import AGENT, NEIGHBOUR, WALL, AgentRecord
from crowdbot.core.crowd.velocity_search.weighted_costs import WeightedCosts
from crowdbot.core.interfaces.numbered_columns import NUMBERED_COLUMNS
from crowdbot.core.support.records import Rows, as_record, record_type
from tests.core.crowd.velocity_search.test_sampling import scene


class _Sum:
    value: float


_SUM = record_type(_Sum)


@njit(BASE, cache=True, error_model="numpy")
def _base(ux: float, uy: float, preferred: float, max_speed: float, params: Any) -> float:
    return math.hypot(ux - preferred, uy)


@njit(PREPARE, cache=True, error_model="numpy")
def _by_number(
    agent: Any, near: Any, near_count: int, walls: Any, wall_count: int, params: Any, work: Any
) -> int:
    others, segments, table = near_table(near), wall_table(walls), work_table(work)
    table[0, 0] = agent[PX] * agent[WEIGHT]
    for j in range(near_count):
        table[0, 0] += others[j, RX] * others[j, NVX] + others[j, RY] * others[j, REACH]
        table[0, 0] += others[j, STATIC]
    for s in range(wall_count):
        table[0, 0] += segments[s, AX] * segments[s, BY]
    return 1


@njit(PREPARE, cache=True, error_model="numpy")
def _by_name(
    agent: AgentRecord,
    near: Rows[Any],
    near_count: int,
    walls: Rows[Any],
    wall_count: int,
    params: Any,
    work: Any,
) -> int:
    found = as_record(work, _SUM)
    found.value = agent.px * agent.weight
    for j in range(near_count):
        other = near[j]
        found.value += other.rx * other.nvx + other.ry * other.reach
        found.value += other.static
    for s in range(wall_count):
        found.value += walls[s].ax * walls[s].by
    return 1


@njit(EXCESS, cache=True, error_model="numpy")
def _excess(ux: float, uy: float, budget: float, agent: Any, work: Any, params: Any) -> float:
    return float(abs(work[0]) * (ux * ux + agent[PX] ** 2))


def _costs(prepare: Any) -> Any:
    view = scene(3)
    cost = CompiledCost(
        base=_base, prepare=prepare, excess=_excess, params=np.array([50.0, 0.0]), weight=1.0
    )
    asked = np.random.default_rng(1).normal(0.0, 1.0, (len(view.agents), 5, 2))
    return Evaluator(WeightedCosts([cost], view.agents)).total(view, asked)


def test_numbers_and_names_lead_to_the_same_costs() -> None:
    by_number = _costs(_by_number)
    assert np.count_nonzero(by_number) > 0
    assert np.array_equal(by_number, _costs(_by_name))


@pytest.mark.parametrize("name", sorted(NUMBERED_COLUMNS))
def test_old_names_are_there_with_a_warning(name: str) -> None:
    with pytest.warns(DeprecationWarning, match=f"{name} goes with 1.0"):
        found = getattr(interfaces, name)
    assert found is getattr(numbered_columns, name)


@pytest.mark.parametrize("record", [AGENT, NEIGHBOUR, WALL])
def test_numbers_are_the_places_of_fields(record: Any) -> None:
    for place, name in enumerate(record.names):
        number = "WALL_D2" if (record, name) == (WALL, "d2") else name.upper()
        assert getattr(numbered_columns, number) == place
