"""Properties of single metrics. What holds for all of them is in the conformance kit."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

import crowdbot
from crowdbot.core.trajectories.commands import Commands
from crowdbot.core.trajectories.tracks import RobotTrack
from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.core.types.arrays import Array
from crowdbot.testing.symmetries import move, with_people
from crowdbot.testing.worlds import World, random_world, straight_world

SEEDS = st.integers(0, 2**32 - 1)
many = settings(max_examples=40)


#: Metrics that have a rate, and what it is the rate of.
RATES = (
    ("risk", "corrected"),
    ("expected_severity", "corrected"),
    ("time_exposed", "corrected"),
    ("integrated_time_to_collision", "corrected"),
)


def scored(world: World, metric: str, **fields: float) -> dict[str, float]:
    """Variant -> value, where there is one."""
    found = crowdbot.score(
        world.run,
        world.robot_alone,
        world.crowd_alone,
        commands=world.commands,
        commands_baseline=world.commands_baseline,
        metrics=metric,
        parameters={metric: fields},
    )
    return {s.variant: s.value for s in found if s.value is not None}


def robot_of(run: Trajectories | None) -> RobotTrack:
    assert run is not None
    assert run.robot is not None
    return run.robot


# --------------------------------------------------------------- risk and contacts
@given(seed=SEEDS, short=st.floats(0.5, 5), longer=st.floats(0, 5))
@many
def test_risk_is_bounded_and_grows_with_the_horizon(seed: int, short: float, longer: float) -> None:
    world = random_world(seed)
    near = scored(world, "risk", risk_horizon=short)
    far = scored(world, "risk", risk_horizon=short + longer)
    span = float(world.run.t[-1] - world.run.t[0])
    assert near["corrected"] <= near["exposed_time"] + 1e-9
    assert near["exposed_time"] <= span + 1e-9
    for variant in ("corrected", "exposed_time"):
        assert near[variant] <= far[variant] + 1e-9


@given(seed=SEEDS)
@many
def test_the_family_of_risk_agrees(seed: int) -> None:
    world = random_world(seed)
    risk = scored(world, "risk")
    assert scored(world, "time_exposed")["corrected"] == pytest.approx(risk["exposed_time"])
    total = scored(world, "integrated_time_to_collision")["corrected"]
    assert total == pytest.approx(5.0 * risk["corrected"])
    severity = scored(world, "expected_severity")["corrected"]
    assert (severity > 1e-12) <= (risk["corrected"] > 0)
    span = float(world.run.t[-1] - world.run.t[0])
    for metric, variant in RATES:
        found = scored(world, metric)
        if world.run.robot and world.run.robot.goal_time is None:
            assert found["rate"] == pytest.approx(found[variant] / span)


@pytest.mark.parametrize("seed", range(5))
def test_literal_risk_times_dt_converges(seed: int) -> None:
    sums = [scored(straight_world(seed, rate), "risk")["literal"] / rate for rate in (64.0, 128.0)]
    assert sums[0] == pytest.approx(sums[1], rel=0.02, abs=0.05)


@given(seed=SEEDS)
@many
def test_collisions_are_counted_person_by_person(seed: int) -> None:
    world = random_world(seed)
    world = replace(world, run=replace(world.run, contacts=None))  # of samples, not of the table
    assert world.run.agents is not None
    counts, severities = scored(world, "collision_count"), scored(world, "collision_severity")
    assert counts["corrected"] >= min(counts["literal"], 1)
    assert severities["per_event"] >= 4 * severities["corrected"] - 1e-9
    columns = range(len(world.run.agents.id))
    each = [replace(world, run=with_people(world.run, [c])) for c in columns]
    for metric, whole in (("collision_count", counts), ("collision_severity", severities)):
        for variant, value in whole.items():
            assert value == pytest.approx(sum(scored(w, metric)[variant] for w in each))


@given(seed=SEEDS, factor=st.floats(0.25, 4))
@many
def test_faster_and_shorter(seed: int, factor: float) -> None:
    """All velocities times c, all times over c: each literal S_R term, v² τ, grows by c."""
    world = random_world(seed)
    world = replace(world, run=replace(world.run, contacts=None))  # their speeds are not hurried
    fast = replace(world, run=_hurried(world.run, factor))
    slow, quick = scored(world, "expected_severity"), scored(fast, "expected_severity")
    assert quick["literal"] == pytest.approx(factor * slow["literal"], rel=1e-5, abs=1e-9)
    for metric in ("collision_count", "proximity", "velocity_similarity"):
        a, b = scored(world, metric), scored(fast, metric)
        assert b == pytest.approx(a, rel=1e-6, abs=1e-9), metric


def _hurried(run: Trajectories, c: float) -> Trajectories:
    robot, agents = robot_of(run), run.agents
    assert agents is not None
    goal_time = None if robot.goal_time is None else robot.goal_time / c
    robot = replace(robot, v=robot.v * c, w=robot.w * c, goal_time=goal_time)
    agents = replace(agents, vx=agents.vx * c, vy=agents.vy * c)
    return replace(run, t=run.t / c, robot=robot, agents=agents, trips=None, contacts=None)


# ------------------------------------------------------------------ path and motion
@given(seed=SEEDS, factor=st.floats(0.25, 4))
@many
def test_jerk_ratios_have_no_unit(seed: int, factor: float) -> None:
    """v and w times c in both runs leave the ratios of integrals as they are."""
    world = random_world(seed)

    def scaled(run: Trajectories | None) -> Trajectories:
        robot = robot_of(run)
        assert run is not None
        return replace(run, robot=replace(robot, v=robot.v * factor, w=robot.w * factor))

    other = replace(world, run=scaled(world.run), robot_alone=scaled(world.robot_alone))
    before, after = scored(world, "relative_jerk"), scored(other, "relative_jerk")
    for variant in ("literal", "corrected", "linear", "angular", "norm"):
        if variant in before and variant in after:
            assert after[variant] == pytest.approx(before[variant], rel=1e-6)


@given(seed=SEEDS)
@many
def test_more_samples_on_the_chords_add_no_length(seed: int) -> None:
    world = random_world(seed)
    robot = robot_of(world.run)
    assume(robot.goal_time is None or robot.goal_time >= world.run.t[-1])
    t = np.sort(np.concatenate([world.run.t, (world.run.t[1:] + world.run.t[:-1]) / 2]))

    def between(values: Array) -> Array:
        filled: Array = np.interp(t, world.run.t, values)
        return filled

    rows: dict[str, Any] = {n: between(getattr(robot, n)) for n in ("x", "y", "theta", "v", "w")}
    finer = Trajectories(t=t, robot=replace(robot, **rows))
    for variant, value in scored(world, "relative_path_length").items():
        found = scored(replace(world, run=finer), "relative_path_length")[variant]
        assert found == pytest.approx(value)


@given(seed=SEEDS)
@many
def test_a_jump_of_the_robot_costs_one_step(seed: int) -> None:
    world = random_world(seed)
    robot, k = robot_of(world.run), 2
    assume(len(world.run.t) > 6 and (robot.goal_time is None or robot.goal_time > world.run.t[4]))
    beyond = np.arange(len(robot.x)) >= k
    far = replace(robot, x=robot.x + 1000.0 * beyond)
    before, after = (
        crowdbot.score(
            replace(world.run, robot=r), world.robot_alone, metrics="relative_path_length"
        )[1].extras
        for r in (robot, far)
    )
    if "crowded" in before and "crowded" in after:
        step = np.hypot(robot.x[k] - robot.x[k - 1], robot.y[k] - robot.y[k - 1])
        assert after["crowded"] == pytest.approx(before["crowded"] - step)


@given(seed=SEEDS, factor=st.floats(0.25, 4))
@many
def test_effect_on_velocity_scales_with_one_run(seed: int, factor: float) -> None:
    world = random_world(seed)
    agents = world.run.agents
    assert agents is not None
    # where no velocity was recorded there is none to scale
    assume(bool(np.array_equal(np.isfinite(agents.vx), np.isfinite(agents.x))))
    faster = replace(agents, vx=agents.vx * factor, vy=agents.vy * factor)
    after = scored(replace(world, run=replace(world.run, agents=faster)), "effect_on_velocity")
    for variant, value in scored(world, "effect_on_velocity").items():
        assert after[variant] == pytest.approx(value / factor)


@given(seed=SEEDS, factor=st.floats(0.3, 1))
@many
def test_normalised_proximity_has_no_scale(seed: int, factor: float) -> None:
    world = random_world(seed)
    robot, agents = robot_of(world.run), world.run.agents
    assert agents is not None
    small = replace(
        world.run,
        robot=replace(robot, x=robot.x * factor, y=robot.y * factor),
        agents=replace(agents, x=agents.x * factor, y=agents.y * factor),
    )
    before = scored(world, "normalized_proximity", neighbour_radius=3.0)
    after = scored(replace(world, run=small), "normalized_proximity", neighbour_radius=3.0 * factor)
    assert after == pytest.approx(before, rel=1e-6)


# ---------------------------------------------------------------------- shared control
@given(seed=SEEDS, factor=st.floats(0.1, 1))
@many
def test_agreement_is_symmetric_and_has_no_scale(seed: int, factor: float) -> None:
    world = random_world(seed)
    c = world.commands
    assert c is not None
    swapped = replace(c, v_user=c.v_sc, w_user=c.w_sc, v_sc=c.v_user, w_sc=c.w_user)
    names = ("v_user", "w_user", "v_sc", "w_sc")
    scaled = replace(c, **{n: getattr(c, n) * factor for n in names})
    before = scored(world, "agreement")
    for other in (swapped, scaled):
        assert scored(replace(world, commands=other), "agreement") == pytest.approx(before)


@given(seed=SEEDS, shift=st.floats(-3, 3), trend=st.floats(-2, 2))
@many
def test_entropy_sees_only_what_was_not_expected(seed: int, shift: float, trend: float) -> None:
    rng = np.random.default_rng(seed)
    t = 0.15 * np.arange(60)
    noise = np.cumsum(rng.normal(0.0, 0.05, 60))

    def drive(angle: Array) -> Commands:
        v, w = np.sin(angle), np.cos(angle)
        return Commands.from_arrays(t=t, v_user=v, w_user=w, v_sc=v, w_sc=w, v_max=1.0, w_max=1.0)

    def entropy(angle: Array, baseline: Array) -> float | None:
        return crowdbot.score(
            None,
            commands=drive(angle),
            commands_baseline=drive(baseline),
            metrics="user_input_entropy",
        )[1].value

    first = entropy(noise, noise[::-1].copy())
    assert entropy(noise + shift, noise[::-1] - shift) == pytest.approx(first)
    assert entropy(noise + trend * t, noise[::-1] + trend * t) == pytest.approx(first)
    assert entropy(-noise, -noise[::-1]) == pytest.approx(first)


# --------------------------------------------------------------------------- unknowns
@given(
    seed=SEEDS,
    name=st.sampled_from(["x", "y", "vx", "vy"]),
    bad=st.sampled_from([np.inf, -np.inf]),
)
@settings(max_examples=15)
def test_infinite_entries_are_unknown_ones(seed: int, name: str, bad: float) -> None:
    world, rng = random_world(seed), np.random.default_rng(seed)
    agents = world.run.agents
    assert agents is not None
    hit = rng.random(agents.x.shape) < 0.1

    def with_entry(value: float) -> Trajectories:
        rows = np.where(hit, value, getattr(agents, name))
        return replace(world.run, agents=replace(agents, **{name: rows}))

    infinite, unknown = (
        crowdbot.score(with_entry(value), world.robot_alone, world.crowd_alone)
        for value in (bad, np.nan)
    )
    assert list(infinite) == list(unknown)


def test_views_can_tell_a_metric_that_looks_at_axes() -> None:
    """The kit's rotation is not the identity: the legacy jerk depends on the axes, and changes."""
    world = random_world(1)
    assert world.robot_alone is not None
    turned = replace(
        world, run=move(world.run, angle=2.1), robot_alone=move(world.robot_alone, angle=1.0)
    )
    before, after = (scored(w, "relative_jerk")["legacy"] for w in (world, turned))
    assert before != pytest.approx(after, rel=1e-3)
