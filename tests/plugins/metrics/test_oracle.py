"""The package's arrays against loops that were written from the text, on random worlds."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.core.trajectories.trips import Durations
from tests.plugins.metrics import oracle
from tests.plugins.metrics.scenes import random_scene, scores_of

SEEDS = st.integers(0, 2**32 - 1)
some = settings(max_examples=40)


def crowded(seed: int) -> Trajectories:
    """A random scene with a finite duration before the arrival."""
    while True:
        run = random_scene(seed)
        world = oracle.World(run)
        if world.n > 2:
            return run
        seed += 1


def stream(seed: int) -> Trajectories:
    """People who walk one way at different speeds, some level with each other; they overtake."""
    run, rng = crowded(seed), np.random.default_rng(seed)
    assert run.agents is not None
    assert run.robot is not None
    shape = run.agents.x.shape
    # speeds and starts of a coarse grid: ties, and bodies exactly side by side
    speed = rng.choice([-0.5, 0.0, 0.5, 0.5, 1.0, 1.5, 1.5], shape[1])
    x = rng.choice([-1.0, -0.5, 0.0, 0.5, 1.0], shape[1]) + run.t[:, None] * speed
    x = np.where(np.isfinite(run.agents.x), x, np.nan)
    y = np.where(np.isfinite(x), rng.choice([0.0, 1.0, 2.5, 4.0], shape[1]), np.nan)
    vx = np.where(np.isfinite(x), speed, np.nan)
    agents = dataclasses.replace(run.agents, x=x, y=y, vx=vx, vy=0 * vx)
    own = 0 * run.t
    robot = dataclasses.replace(
        run.robot, x=run.t * 1.0, y=own, theta=own, v=own + 1, goal_time=None
    )
    return dataclasses.replace(run, agents=agents, robot=robot)


def assert_agrees(found: float | None, expected: float | None) -> None:
    assert (found is None) == (expected is None)
    if expected is not None:
        assert found == pytest.approx(expected, rel=1e-6, abs=1e-9)


@given(seed=SEEDS)
@some
def test_risk_and_severity(seed: int) -> None:
    run = crowded(seed)
    expected = oracle.risk(oracle.World(run))
    times = oracle.World(run).t
    span = times[-1] - times[0]
    expected |= dict.fromkeys(("rate", "disc"), expected["corrected"] / span)
    expected |= {"severity_rate": expected["severity_corrected"] / span}
    for variant, s in scores_of("risk", run).items():
        assert s.value == pytest.approx(expected[variant], rel=1e-6, abs=1e-6)
    for variant, s in scores_of("expected_severity", run).items():
        assert s.value == pytest.approx(expected[f"severity_{variant}"], rel=1e-6, abs=1e-6)


@given(seed=SEEDS)
@some
def test_collisions(seed: int) -> None:
    run = crowded(seed)
    expected = oracle.collisions(oracle.World(run))
    count, severity = scores_of("collision_count", run), scores_of("collision_severity", run)
    assert count["literal"].value == expected["literal"]
    assert count["corrected"].value == expected["corrected"]
    names = {"literal": "per_sample", "per_event": "per_event", "corrected": "energy"}
    for variant, name in {**names, "impulse": "impulse"}.items():
        assert_agrees(severity[variant].value, expected[name])


@pytest.mark.slow
@pytest.mark.parametrize("world", [crowded, stream])
@given(seed=SEEDS)
@some
def test_overtaking(world: Callable[[int], Trajectories], seed: int) -> None:
    run = world(seed)
    n = oracle.overtakes(oracle.World(run))
    found = scores_of("overtaking_count", run)
    columns = [row[0] for row in n]
    net = [[max(0, n[a][b] - n[b][a]) for b in range(len(n))] for a in range(len(n))]
    for variant, table in (("literal", n), ("corrected", net)):
        assert found[variant].value == sum(table[0])
        mean = sum(map(sum, table[1:])) / len(table[1:])
        assert found[variant].extras["agent_mean"] == pytest.approx(mean)
        assert found[variant].extras["excess"] == pytest.approx(sum(table[0]) - mean)
        assert found[variant].extras["overtaken_by"] == sum(columns)


def test_streams_do_overtake() -> None:
    """Or else the test above would be empty."""
    counts = [scores_of("overtaking_count", stream(s))["literal"].value or 0 for s in range(60)]
    assert sum(counts) > 10


@given(seed=SEEDS)
@some
def test_proximity(seed: int) -> None:
    run = crowded(seed)
    expected = oracle.proximity(oracle.World(run))
    found, spread = scores_of("proximity", run), scores_of("normalized_proximity", run)
    for variant in ("literal", "corrected"):
        assert_agrees(found[variant].value, expected[variant])
        assert_agrees(spread[variant].value, expected[f"cv_{variant}"])
    assert_agrees(spread["barycentre"].value, expected["barycentre"])


@given(seed=SEEDS)
@some
def test_similarity(seed: int) -> None:
    run = crowded(seed)
    world = oracle.World(run)
    for metric, expected in (
        ("heading_similarity", oracle.heading_similarity(world)),
        ("velocity_similarity", oracle.velocity_similarity(world, math.inf)),
        ("neighbour_velocity_similarity", oracle.velocity_similarity(world, 3.0)),
    ):
        for variant, s in scores_of(metric, run).items():
            assert_agrees(s.value, expected[variant])


@given(
    rows=st.lists(st.tuples(st.integers(1, 12), st.booleans()), min_size=1, max_size=12),
    part=st.floats(0.1, 1.0),
)
@some
def test_kaplan_meier(rows: list[tuple[int, bool]], part: float) -> None:
    seconds, reached = [float(r[0]) for r in rows], [r[1] for r in rows]
    limit = part * max(seconds)
    ours = Durations(np.array(seconds), np.array(reached)).restricted_mean(limit)
    assert ours == pytest.approx(oracle.kaplan_meier(seconds, reached, limit))
