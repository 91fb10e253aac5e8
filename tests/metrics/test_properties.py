"""What must hold for every metric and variant, whatever the world."""

import dataclasses
import math

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from crowdbot.core.evaluate import Scores, score
from crowdbot.core.trajectory import Trajectories

from .scenes import (
    REGISTRY,
    Body,
    Change,
    grid,
    later,
    line,
    moved,
    perturbed,
    random_scene,
    scene,
    scores_of,
    value_of,
    with_columns,
)

SEEDS = st.integers(0, 2**32 - 1)
many = settings(max_examples=60, deadline=None)


def all_scores(run: Trajectories, alone: Trajectories) -> Scores:
    return score(REGISTRY, run, alone, alone)


def assert_same(a: Scores, b: Scores) -> None:
    assert [(s.metric, s.variant) for s in a] == [(s.metric, s.variant) for s in b]
    for one, two in zip(a, b, strict=True):
        assert (one.status, one.reason) == (two.status, two.reason)
        for name in ("value", "lower", "upper"):
            x, y = getattr(one, name), getattr(two, name)
            assert (x is None) == (y is None), (one, two)
            if x is not None:
                assert x == pytest.approx(y, rel=1e-7, abs=1e-9), (one, two)


def backwards(run: Trajectories) -> Trajectories:
    assert run.agents is not None
    return with_columns(run, range(len(run.agents.id))[::-1])


@pytest.mark.parametrize(
    "change",
    [
        pytest.param(lambda run: moved(run, shift=(17.0, -4.0)), id="translate"),
        pytest.param(lambda run: moved(run, angle=2.1), id="rotate"),
        pytest.param(lambda run: moved(run, mirror=-1), id="reflect"),
        pytest.param(lambda run: later(run, 64.0), id="later"),
        pytest.param(backwards, id="permute"),
    ],
)
@given(seed=SEEDS)
@many
def test_the_view_does_not_matter(change: Change, seed: int) -> None:
    run, alone = random_scene(seed), random_scene(seed + 1)
    assert_same(all_scores(run, alone), all_scores(change(run), alone))
    assert_same(all_scores(run, alone), all_scores(run, change(alone)))


@given(seed=SEEDS)
@many
def test_a_run_against_itself(seed: int) -> None:
    run = random_scene(seed)
    found = all_scores(run, dataclasses.replace(run, robot=run.robot))
    for metric in ("relative_time_to_goal", "relative_path_length"):
        for variant in ("literal", "corrected"):
            s = found.find(metric, variant)
            assert s.value in (None, 1.0)
            assert s.status == "ok" or s.reason in (
                "reference_goal_not_reached",
                "zero_denominator",
            )


@given(seed=SEEDS)
@many
def test_a_crowd_against_itself(seed: int) -> None:
    run = random_scene(seed)
    alone = dataclasses.replace(run, robot=None)
    for s in score(REGISTRY, alone, None, alone, metrics="effect_on_velocity"):
        assert s.value == 1.0 or s.status == "undefined"


@given(seed=SEEDS)
@many
def test_numbers_are_finite_and_go_with_the_status(seed: int) -> None:
    for s in all_scores(random_scene(seed), random_scene(seed + 1)):
        assert (s.value is None) == (s.status != "ok")
        assert bool(s.reason) == (s.status != "ok")
        numbers = [s.value, s.lower, s.upper, *s.extras.values()]
        assert all(math.isfinite(n) for n in numbers if n is not None)
        assert s.status != "censored" or s.value is None
        assert s.status == "censored" or (s.lower is None and s.upper is None)


@given(seed=SEEDS)
@many
def test_bounds(seed: int) -> None:
    run = random_scene(seed)
    risk, count = scores_of("risk", run), scores_of("collision_count", run)
    assume(risk["corrected"].status == "ok")
    imminence, exposed = value_of(risk), value_of(risk, "exposed_time")
    assert -1e-12 <= imminence <= exposed + 1e-9 <= run.t[-1] - run.t[0] + 2e-9
    assert 0 <= risk["corrected"].extras["mean"] <= 1 + 1e-12
    literal, corrected = value_of(count, "literal"), value_of(count)
    assert literal == int(literal) >= 0
    assert corrected == int(corrected) >= min(literal, 1)


@given(seed=SEEDS)
@many
def test_more_people_never_lower_risk_or_collisions(seed: int) -> None:
    run = random_scene(seed)
    assert run.agents is not None
    columns = range(len(run.agents.id))
    fewer = with_columns(run, columns[:-1])
    risk, less_risk = scores_of("risk", run), scores_of("risk", fewer)
    for variant in ("corrected", "exposed_time"):
        assume(risk[variant].status == "ok")
        assert value_of(risk, variant) >= value_of(less_risk, variant) - 1e-12
    count, lower_count = scores_of("collision_count", run), scores_of("collision_count", fewer)
    for variant in ("literal", "corrected"):
        assert value_of(count, variant) >= value_of(lower_count, variant)
        alone = [scores_of("collision_count", with_columns(run, [c])) for c in columns]
        assert value_of(count, variant) == sum(value_of(f, variant) for f in alone)


@given(seed=SEEDS, short=st.floats(0.5, 5), longer=st.floats(0, 5))
@many
def test_risk_grows_with_the_horizon(seed: int, short: float, longer: float) -> None:
    run = random_scene(seed)
    near = scores_of("risk", run, risk_horizon=short)
    far = scores_of("risk", run, risk_horizon=short + longer)
    assume(near["corrected"].status == "ok")
    for variant in ("corrected", "exposed_time"):
        assert value_of(near, variant) <= value_of(far, variant) + 1e-9


@given(seed=SEEDS)
@many
def test_rounding_never_changes_a_status_or_a_count(seed: int) -> None:
    run, alone = random_scene(seed), random_scene(seed + 1)
    found = all_scores(run, alone)
    again = all_scores(perturbed(run, 1e-12, seed), perturbed(alone, 1e-12, seed))
    assert [(s.status, s.reason) for s in found] == [(s.status, s.reason) for s in again]
    for variant in ("literal", "corrected"):
        name = "collision_count"
        assert found.find(name, variant).value == again.find(name, variant).value


T = grid(10)
_EXACT = {
    "touch": scene(T, line(T, (0, 0), (0, 0)), [line(T, (0.43, 0), (0, 0))]),
    "graze": scene(T, line(T, (0, 0), (1, 0)), [line(T, (10, 0.43), (-1, 0))]),
    "release": scene(
        T,
        line(T, (0, 0), (0, 0)),
        [Body(0.43 + 0.05 * (np.arange(101, dtype=np.float64) % 2), T * 0, T * 0, T * 0)],
    ),
    "teleport": scene(
        T, line(T, (0, 0), (10, 0)), [line(T, (0, 5), (10, 0))], velocities=False, goal_time=10.0
    ),
    "standing": scene(T, line(T, (0, 0), (0, 0)), [line(T, (5, 5), (0, 0))], goal_time=10.0),
}


@pytest.mark.parametrize("name", _EXACT)
@pytest.mark.parametrize("seed", range(5))
def test_rounding_on_a_threshold(name: str, seed: int) -> None:
    """Everything here lies exactly on a threshold."""
    run = _EXACT[name]
    found = all_scores(run, run)
    again = all_scores(perturbed(run, 1e-12, seed), perturbed(run, 1e-12, seed + 100))
    assert [(s.status, s.reason) for s in found] == [(s.status, s.reason) for s in again]
    for one, two in zip(found, again, strict=True):
        if one.value is not None:  # both have a value: their status is the same
            assert one.value == pytest.approx(two.value, rel=1e-5, abs=1e-9), (one, two)


@given(seed=SEEDS, dt=st.sampled_from([0.05, 0.1]))
@many
def test_sampling_twice_as_often(seed: int, dt: float) -> None:
    """Constant velocities: literal risk doubles, collisions stay, corrected risk converges."""
    rng = np.random.default_rng(seed)
    starts, velocities = rng.uniform(-4, 4, (4, 2)), rng.uniform(-1, 1, (4, 2))

    def world(dt: float) -> Trajectories:
        t = grid(12, dt)
        bodies = [
            line(t, (float(p[0]), float(p[1])), (float(v[0]), float(v[1])))
            for p, v in zip(starts, velocities, strict=True)
        ]
        return scene(t, bodies[0], bodies[1:])

    coarse, fine = world(dt), world(dt / 2)
    risk, finer_risk = scores_of("risk", coarse), scores_of("risk", fine)
    # whoever leaves or enters contact between two samples shifts the sum by up to two of them
    assert value_of(risk) == pytest.approx(value_of(finer_risk), abs=8 * dt)
    largest = 2 * value_of(risk, "literal")
    assert value_of(finer_risk, "literal") == pytest.approx(largest, rel=0.2, abs=40)
    if largest > 200:
        assert value_of(finer_risk, "literal") > 0.75 * largest
    count, finer_count = (scores_of("collision_count", r) for r in (coarse, fine))
    assert value_of(count) == value_of(finer_count)


@given(seed=SEEDS)
@many
def test_teleports_add_nothing(seed: int) -> None:
    """A body that jumps away and back: no length, no speed, no contact on the way."""
    run = random_scene(seed)
    robot = run.robot
    assume(len(run.t) > 6)
    assert robot is not None
    x = robot.x.copy()
    x[3:] += 1000.0
    far = dataclasses.replace(run, robot=dataclasses.replace(robot, x=x))
    step = float(np.hypot(x[3] - x[2] - 1000.0, robot.y[3] - robot.y[2]))
    ends = run.robot is not None and (robot.goal_time is None or robot.goal_time >= run.t[3])
    reference = scene(grid(5), line(grid(5), (0, 0), (1, 0)), goal_time=5.0)
    for name in ("relative_path_length",):
        a, b = (scores_of(name, r, reference)["corrected"] for r in (run, far))
        la, lb = (s.extras.get("crowded", 5.0 / s.upper if s.upper else 0.0) for s in (a, b))
        assert lb == pytest.approx(la - (step if ends else 0.0), abs=1e-9)
    kept = dataclasses.replace(run, agents=None)
    assert scores_of("collision_count", kept)["corrected"].value == 0


@pytest.mark.parametrize("n", [1, 2, 3])
def test_the_shortest_records(n: int) -> None:
    t = np.arange(n, dtype=np.float64) * 0.1
    run = scene(t, line(t, (0, 0), (1, 0)), [line(t, (3, 0), (-1, 0))], goal_time=float(t[-1]))
    found = all_scores(run, run)
    assert all((s.value is None) == (s.status != "ok") for s in found)
    assert len(found) == 11


@given(
    seed=SEEDS,
    field=st.sampled_from(["x", "y", "vx", "vy"]),
    bad=st.sampled_from([np.inf, -np.inf]),
)
@many
def test_infinite_entries_are_unknown_ones(seed: int, field: str, bad: float) -> None:
    run, rng = random_scene(seed), np.random.default_rng(seed)
    assert run.agents is not None
    hit = rng.random(run.agents.x.shape) < 0.1

    def with_value(value: float) -> Trajectories:
        assert run.agents is not None
        rows = np.where(hit, value, getattr(run.agents, field))
        return dataclasses.replace(run, agents=dataclasses.replace(run.agents, **{field: rows}))

    assert_same(all_scores(with_value(bad), run), all_scores(with_value(np.nan), run))
