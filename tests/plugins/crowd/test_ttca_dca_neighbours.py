"""The table that TtcaDca makes of its neighbours."""

from __future__ import annotations

import numpy as np
import pytest

from crowdbot.core.crowd.velocity_search import cost as c
from crowdbot.core.crowd.velocity_search.cost_calls import address_of, call_prepare
from crowdbot.core.support.compile import kernel
from crowdbot.core.types.arrays import Array
from crowdbot.plugins.crowd.cost_functions.ttca_dca import TtcaDcaSpec
from crowdbot.plugins.crowd.cost_functions.ttca_dca_build import build
from crowdbot.plugins.crowd.cost_functions.ttca_dca_params_build import TOTAL, WEIGHT


@kernel
def _prepare(at: int, agent: Array, near: Array, walls: Array, params: Array, work: Array) -> int:
    return int(
        call_prepare(
            at, agent.ctypes.data, near.ctypes.data, near.shape[0], walls.ctypes.data, 0,
            params.ctypes.data, work.ctypes.data,
        )
    )  # fmt: skip


@pytest.mark.parametrize("count", [0, 1, 2, 7, 8, 9, 16, 17, 33])
@pytest.mark.parametrize("descends", [False, True])
def test_all_who_are_ahead_heaviest_first(count: int, descends: bool) -> None:
    rng = np.random.default_rng(count)
    near = np.zeros((count, c.NEAR_COLUMNS))
    at = rng.uniform(-1.5, 1.5, (count, 2)).round(1)  # some are as far as others
    near[:, [c.RX, c.RY]], near[:, c.D2], near[:, c.REACH] = at, (at**2).sum(axis=1), 0.2
    near[:, c.NVX] = np.arange(count)  # who is who
    agent, work = np.zeros(c.AGENT_SIZE), np.full((c.work_rows(count) + 1, c.WORK_COLUMNS), np.nan)
    agent[c.VX], agent[c.FASTEST], agent[c.DESCENDS] = 1.0, 9.0, descends
    cost = build(TtcaDcaSpec.model_validate({"range": 1.0}))

    kept = _prepare(
        address_of(cost.prepare, c.PREPARE), agent, near, np.zeros((0, 7)), cost.params, work
    )

    expected = np.flatnonzero((at[:, 0] >= 0.0) & (near[:, c.D2] < 1.0))
    distance = np.sqrt(near[expected, c.D2]).clip(1e-6)
    weight = 1.0 / np.maximum((distance - 0.2) * (distance - 0.2), 1e-12)
    order = slice(None) if descends else np.argsort(-weight, kind="stable")
    assert kept == work[0, 0] == len(expected)
    assert work[0, TOTAL] == sum(weight.tolist())
    table = work[1 : kept + 1]
    assert np.array_equal(table[:, 4], expected[order])
    assert np.array_equal(table[:, WEIGHT], weight[order])
    assert np.array_equal(table[:, :2], at[expected][order])
    shrink = ((distance - 0.2) / distance)[order, np.newaxis]
    assert np.array_equal(table[:, 2:4], table[:, :2] * shrink)
    assert np.isnan(work[-1]).all()  # nothing past its rows
