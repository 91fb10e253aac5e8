"""The grid of segments finds what a search of all finds, in the same order."""

from __future__ import annotations

import numpy as np
import pytest
import shapely  # type: ignore[import-untyped,unused-ignore]
from hypothesis import given, settings
from hypothesis import strategies as st

from crowdbot.core.crowd import Agents, CrowdEngine, CrowdWorld, policy_of
from crowdbot.core.crowd.steering.parameters import Steering
from crowdbot.core.geometry import segment_grid as module
from crowdbot.core.geometry.segment_grid import cell_of, grid_of, segment_grid
from crowdbot.core.types.arrays import Array
from crowdbot.dsl.scenario.steering import SteeringSpec


def _segments(seed: int, count: int, size: float) -> Array:
    rng = np.random.default_rng(seed)
    start = rng.uniform(0.0, size, (count, 2))
    step = rng.standard_normal((count, 2)) * rng.choice([0.0, 0.1, 1.0, 0.4 * size], (count, 1))
    step[rng.random(count) < 0.3, 0] = 0.0
    return np.column_stack([start, start + step])


@settings(deadline=None, max_examples=60)
@given(st.integers(0, 2**32), st.integers(0, 80), st.sampled_from([0.0, 0.3, 2.0, 30.0]))
def test_nothing_within_reach_is_missed(seed: int, count: int, reach: float) -> None:
    segments = _segments(seed, count, 20.0)
    grid = segment_grid(segments, reach)
    lines = [shapely.LineString(row.reshape(2, 2)) for row in segments]
    for x, y in np.random.default_rng(seed).uniform(-10.0, 30.0, (40, 2)).tolist():
        cell = cell_of(grid.frame, x, y)
        listed = [] if cell < 0 else grid.near[grid.first[cell] : grid.first[cell + 1]].tolist()
        assert listed == sorted(set(listed))
        near = [k for k, line in enumerate(lines) if line.distance(shapely.Point(x, y)) <= reach]
        assert set(near) <= set(listed)


def test_few_are_found_where_there_are_many() -> None:
    segments = _segments(1, 2000, 60.0)
    segments = segments[np.hypot(*(segments[:, 2:] - segments[:, :2]).T) < 5.0]
    grid = segment_grid(segments, 1.0)
    assert np.diff(grid.first).mean() < 0.02 * len(segments)
    assert grid_of(segments, 1.0) is grid_of(segments, 1.0)


@pytest.mark.parametrize("method", ["sampling", "gradient"])
def test_people_walk_bit_by_bit_as_with_a_search_of_all_walls(
    method: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    rng = np.random.default_rng(3)
    walls = _segments(2, 60, 15.0)
    at, to = rng.uniform(0.0, 15.0, (2, 25, 2))
    agents = Agents.of(x=at[:, 0], y=at[:, 1], radius=0.2, routes=[[tuple(p)] for p in to.tolist()])
    steering = SteeringSpec.model_validate({"wall_push": {}})

    def walked(few: int) -> bytes:
        monkeypatch.setattr(module, "_FEW", few)
        costs: dict[str, dict[str, object]] = {
            "avoid": {"kind": "social_forces_avoidance", "range": 3.0},
            "goal": {"kind": "goal_reaching_force"},
        }
        policy = policy_of({"kind": "velocity_space", "method": method}, costs)
        world = CrowdWorld(walls=walls.copy(), steering=Steering(steering, key=1), firm=True)
        engine = CrowdEngine(agents, world, policy)
        flat = engine.initial_state()
        for _ in range(128):
            engine.advance(flat)
        return flat.tobytes()

    assert walked(1) == walked(1000)
