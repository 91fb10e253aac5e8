"""Checks for every metric, based on its declaration.

Worlds are random, but the same in each test run.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np

import crowdbot.testing.degenerate as degenerate
from crowdbot.core.types.score import Score
from crowdbot.dsl.spec.component import Component
from crowdbot.dsl.spec.component_specs import MetricSpec
from crowdbot.testing.changed_worlds import (
    each_run,
    perturbed,
    perturbed_threshold,
    perturbed_world,
    symmetric,
    symmetric_world,
)
from crowdbot.testing.scored import Scored, invariants_of, metric_of, scores_of, with_signals
from crowdbot.testing.symmetries import (
    RUN_SYMMETRIES,
    arrays_of,
    scale_masses,
    with_people,
    without_velocities,
    writable_copy,
)
from crowdbot.testing.worlds import World, portal_world, random_world, straight_world

#: Number of random worlds per check.
_SEEDS = range(10)


def check_declaration(component: Component[Any]) -> None:
    """The metric is declared as a metric, by a metric's spec, and has a card.

    If this fails, use ``declare_metric(Spec, symbol=..., unit=..., better=..., category=...)``
    with a spec that derives from ``MetricSpec``, and write ``cards/NAME.md`` beside it.
    """
    metric = metric_of(component)
    assert issubclass(metric.spec, MetricSpec), f"{metric.spec.__name__} is not a MetricSpec"
    place = metric.card_place or "the argument 'card'"
    assert metric.has_card(), f"'{metric.kind}' has no card; it is looked for in {place}"


def check_scores_are_well_formed(component: Component[Any]) -> None:
    """Each variant is scored once; numbers are finite and within bounds, or there is a status.

    If this fails, return one score per variant, built by a ``ScoreFactory``, with a status and a
    reason instead of NaN, infinity or an exception; or correct ``minimum``, ``maximum`` and
    ``integer``.
    """
    for seed in _SEEDS:
        world = with_signals(component, random_world(seed))
        for part in (world, replace(world, robot_alone=None, crowd_alone=None)):
            _assert_well_formed(component, scores_of(component, part))


def check_degenerate_runs(component: Component[Any]) -> None:
    """Degenerate runs (no one, one sample, no robot, all standing or absent) give a status.

    If this fails, look at the named run: the metric makes an assumption that it does not satisfy.
    """
    for name, world in degenerate.worlds().items():
        try:
            _assert_well_formed(component, scores_of(component, world))
            _assert_well_formed(component, scores_of(component, with_signals(component, world)))
        except Exception as error:
            raise AssertionError(f"{name}: {error}") from error


def check_pure(component: Component[Any]) -> None:
    """Inputs are not changed, and the same input gives the same scores.

    If this fails, copy before you change an array, and keep nothing between two calls.
    """
    for seed in _SEEDS:
        world = with_signals(component, random_world(seed))
        unprotected, another = writable_copy(world), writable_copy(world)
        before = arrays_of(unprotected)
        first = scores_of(component, unprotected)
        changed = [name for name, data in arrays_of(unprotected).items() if before[name] != data]
        assert not changed, f"changed its input: {', '.join(changed)}"
        assert scores_of(component, another) == first, "the same run scored differently"
        assert scores_of(component, world) == first, "the same run scored differently"


def check_symmetries(component: Component[Any]) -> None:
    """Translation, rotation, reflection, a later start and another order of people change nothing.

    If this fails, an angle is not wrapped, an absolute coordinate is used, or time counts from
    zero; or declare ``changes_with={"rotate": why}``.
    """
    for seed in _SEEDS:
        world = with_signals(component, random_world(seed))
        found = scores_of(component, world)
        for name in RUN_SYMMETRIES:
            plain = world is random_world(seed)
            changed = symmetric_world(seed, name) if plain else symmetric(world, name)
            _assert_same(component, found, scores_of(component, changed), name)


def check_self_value(component: Component[Any]) -> None:
    """A run that is its own reference scores the declared ``self_value``.

    If this fails, numerator and denominator are not computed alike.
    """
    for seed in _SEEDS:
        run = with_signals(component, random_world(seed)).run
        found = scores_of(component, World(run=run, robot_alone=run, crowd_alone=run))
        for variant, one in found.items():
            expected = invariants_of(component, variant).self_value
            if expected is not None and one.value is not None:
                assert _near(one.value, expected), f"{variant}: {one.value}, not {expected}"


def check_refinement(component: Component[Any]) -> None:
    """The same straight motion, sampled twice as often, changes scores as ``refinement`` declares.

    If this fails, a sum over samples lacks dt, or has an extra one.
    """
    for seed in range(4):
        coarse = scores_of(component, with_signals(component, straight_world(seed, 32.0)))
        fine = scores_of(component, with_signals(component, straight_world(seed, 64.0)))
        for variant, one in coarse.items():
            _assert_refined(
                variant, invariants_of(component, variant).refinement, one, fine[variant]
            )


def check_more_people(component: Component[Any]) -> None:
    """An additional person changes the value only as ``more_people`` declares.

    If this fails, people are averaged where the nearest, or the sum, was meant.
    """
    declared = {v: invariants_of(component, v).more_people for v in metric_of(component).variants}
    if set(declared.values()) == {"free"}:
        return

    for seed in _SEEDS:
        world = with_signals(component, random_world(seed))
        assert world.run.agents is not None
        columns = range(len(world.run.agents.id))
        more = scores_of(component, world)
        for left_out in columns:
            fewer = with_people(world.run, [c for c in columns if c != left_out])
            for variant, one in scores_of(component, replace(world, run=fewer)).items():
                _assert_ordered(variant, declared[variant], one, more[variant])


def check_masses(component: Component[Any]) -> None:
    """Multiplying all masses by c multiplies the value by c to the power ``mass_exponent``.

    If this fails, masses are used in the wrong places.
    """
    for seed in _SEEDS:
        world = with_signals(component, random_world(seed))
        light = scores_of(component, world)
        heavy = scores_of(component, each_run(world, lambda run: scale_masses(run, 4.0)))
        for variant, one in light.items():
            assert one.status == heavy[variant].status, variant
            if one.value is not None:
                expected = one.value * 4.0 ** invariants_of(component, variant).mass_exponent
                assert _near(heavy[variant].value, expected), f"{variant}: {heavy[variant]}"


def check_teleports_add_nothing(component: Component[Any]) -> None:
    """People who pass a portal score like people who walk on.

    If this fails, a flagged jump counts as a step: as length, as speed, as a contact. Declare
    ``changes_with={"teleport": why}`` only if positions themselves are compared.
    """
    for seed in range(4):
        walked = scores_of(component, with_signals(component, portal_world(seed, through=False)))
        jumped = scores_of(component, with_signals(component, portal_world(seed, through=True)))
        _assert_same(component, walked, jumped, "teleport")


def check_velocities_left_out(component: Component[Any]) -> None:
    """A recording without velocities scores like one with velocities derived from positions.

    Missing velocities are derived before a metric runs. If this fails, the metric checks if a
    velocity was recorded, or compares for equality.
    """
    for seed in range(4):
        world = with_signals(component, straight_world(seed, 32.0))
        silent = each_run(world, without_velocities)
        found = scores_of(component, world)
        _assert_same(component, found, scores_of(component, silent), "velocities")


def check_rounding(component: Component[Any]) -> None:
    """Changing inputs by 1e-12 changes no status and no integer.

    If this fails, compare with a tolerance instead of with equality.
    """
    for seed in _SEEDS:
        world = with_signals(component, random_world(seed))
        plain = world is random_world(seed)
        _assert_robust(component, world, perturbed_world(seed) if plain else perturbed(world, seed))
    for name, world in degenerate.on_thresholds().items():
        for seed in range(3):
            try:
                _assert_robust(component, world, perturbed_threshold(name, seed))
            except AssertionError as error:
                raise AssertionError(f"{name}: {error}") from error


# --------------------------------------------------------------------- assertions
def _assert_well_formed(component: Component[Any], scored: Scored) -> None:
    declared = tuple(metric_of(component).variants)
    assert tuple(scored) == declared, f"scored {', '.join(scored)}, declared {', '.join(declared)}"
    for variant, one in scored.items():
        _assert_numbers(one)
        _assert_as_declared(component, one)
        if one.value is not None:
            known = invariants_of(component, variant)
            slack = 1e-9 * max(1.0, abs(one.value))
            bounds = f"{variant}: {one.value} is not within {known.minimum} to {known.maximum}"
            assert known.minimum - slack <= one.value <= known.maximum + slack, bounds
            assert not known.integer or one.value == int(one.value), (
                f"{variant}: {one.value} is not an integer"
            )


def _assert_numbers(one: Score) -> None:
    assert (one.value is None) == (one.status != "ok"), f"{one.variant}: {one}"
    assert bool(one.reason) == (one.status != "ok"), f"{one.variant}: a reason goes with no value"
    numbers = [one.value, one.lower, one.upper, *one.extras.values()]
    assert all(math.isfinite(n) for n in numbers if n is not None), f"{one.variant}: {one}"
    bounded = one.lower is not None or one.upper is not None
    assert one.status == "censored" or not bounded, f"{one.variant}: bounds without being censored"
    if one.lower is not None and one.upper is not None:
        assert one.lower <= one.upper, f"{one.variant}: bounds in the wrong order"


def _assert_as_declared(component: Component[Any], one: Score) -> None:
    declared = metric_of(component)
    variant = declared.variants[one.variant]
    expected = (
        declared.kind,
        declared.symbol,
        declared.score_category,
        variant.unit,
        variant.better,
    )
    found = (one.metric, one.symbol, one.category, one.unit, one.better)
    assert found == expected, f"{one.variant} says {found}, its declaration {expected}"


def _assert_same(component: Component[Any], one: Scored, two: Scored, change: str) -> None:
    for variant, a in one.items():
        if change in invariants_of(component, variant).changes_with:
            continue
        b = two[variant]
        assert (a.status, a.reason) == (b.status, b.reason), f"{change}, {variant}: {a} {b}"
        for name in ("value", "lower", "upper"):
            assert _near(getattr(a, name), getattr(b, name)), (
                f"{change}, {variant}: {name} {getattr(a, name)} became {getattr(b, name)}"
            )


def _assert_refined(variant: str, refinement: str, coarse: Score, fine: Score) -> None:
    if refinement == "free":
        return
    assert coarse.status == fine.status, f"{variant}: {coarse.status} became {fine.status}"
    if coarse.value is None or fine.value is None:
        return
    factor, slack = {"same": (1, 1e-9), "near": (1, 0.05), "double": (2, 0.05)}[refinement]
    expected = factor * coarse.value
    close = math.isclose(
        fine.value, expected, rel_tol=slack, abs_tol=1e-9 + slack * (refinement == "near")
    )
    assert close, f"{variant}: {coarse.value} became {fine.value}, which is not {refinement}"


def _assert_ordered(variant: str, monotony: str, fewer: Score, more: Score) -> None:
    if monotony == "free" or fewer.value is None or more.value is None:
        return
    up = more.value - fewer.value if monotony == "up" else fewer.value - more.value
    assert up >= -1e-9 * max(1.0, abs(more.value)), (
        f"{variant}: {fewer.value} became {more.value} with one person more"
    )


def _assert_robust(component: Component[Any], world: World, changed: World) -> None:
    found, again = scores_of(component, world), scores_of(component, changed)
    for variant, a in found.items():
        b = again[variant]
        assert (a.status, a.reason) == (b.status, b.reason), f"{variant}: {a} became {b}"
        if invariants_of(component, variant).integer:
            assert a.value == b.value, f"{variant}: {a.value} became {b.value}"


def _near(a: float | None, b: float | None) -> bool:
    if a is None or b is None:
        return a is b
    return bool(np.isclose(a, b, rtol=1e-6, atol=1e-9))
