"""The table that TtcaDca makes of its neighbours."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from crowdbot.core.crowd.velocity_search import cost as c
from crowdbot.core.crowd.velocity_search.cost_calls import address_of, call_prepare
from crowdbot.core.crowd.velocity_search.records import AGENT, NEIGHBOUR, WALL, WORK_COLUMNS
from crowdbot.core.support.compiling.compile import kernel
from crowdbot.core.support.records import rows_of
from crowdbot.core.types.arrays import Array
from crowdbot.plugins.crowd.cost_functions.ttca_dca.ttca_dca import TtcaDcaSpec
from crowdbot.plugins.crowd.cost_functions.ttca_dca.ttca_dca_build import build


@kernel
def _prepare(at: int, agent: Any, near: Any, walls: Any, params: Array, work: Array) -> int:
    return int(
        call_prepare(
            at, agent[0], near, near.shape[0], walls, 0, params, work
        )
    )  # fmt: skip


@pytest.mark.parametrize("count", [0, 1, 2, 7, 8, 9, 16, 17, 33])
@pytest.mark.parametrize("descends", [False, True])
def test_all_who_are_ahead_heaviest_first(count: int, descends: bool) -> None:
    rng = np.random.default_rng(count)
    near: Any = rows_of(count, NEIGHBOUR)
    at = rng.uniform(-1.5, 1.5, (count, 2)).round(1)  # some are as far as others
    near["rx"], near["ry"] = at.T
    near["d2"], near["reach"], near["nvx"] = (at**2).sum(axis=1), 0.2, np.arange(count)
    agent: Any = rows_of(1, AGENT)
    work = np.full((c.work_rows(count) + 1, WORK_COLUMNS), np.nan)
    agent["vx"], agent["fastest"], agent["descends"] = 1.0, 9.0, descends
    cost = build(TtcaDcaSpec.model_validate({"range": 1.0}))

    kept = _prepare(
        address_of(cost.prepare, c.PREPARE), agent, near, rows_of(0, WALL), cost.params, work
    )

    expected = np.flatnonzero((at[:, 0] >= 0.0) & (near["d2"] < 1.0))
    distance = np.sqrt(near["d2"][expected]).clip(1e-6)
    weight = 1.0 / np.maximum((distance - 0.2) * (distance - 0.2), 1e-12)
    order = slice(None) if descends else np.argsort(-weight, kind="stable")
    assert kept == len(expected)
    assert work[0, :2].tolist() == [kept, sum(weight.tolist())]
    dx, dy, qx, qy, who, _, weights, _ = work[1 : kept + 1].T
    assert np.array_equal(who, expected[order])
    assert np.array_equal(weights, weight[order])
    assert np.array_equal(np.column_stack([dx, dy]), at[expected][order])
    shrink = ((distance - 0.2) / distance)[order]
    assert np.array_equal([qx, qy], [dx * shrink, dy * shrink])
    assert np.isnan(work[-1]).all()  # nothing past its rows
