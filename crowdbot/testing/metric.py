"""What every metric must keep to. Its label and its laws say which numbers to expect.

Worlds are random, but the same in each test run.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from crowdbot.core.commands import Commands
from crowdbot.core.component import Component
from crowdbot.core.score import Score
from crowdbot.core.score_label import MetricComponent
from crowdbot.core.trajectory import Trajectories
from crowdbot.testing import degenerate
from crowdbot.testing.card import check_card_examples_run, check_card_says_what_the_scores_say
from crowdbot.testing.scored import Scored, laws_of, scores_of, signalled, variants_of
from crowdbot.testing.views import (
    COMMAND_VIEWS,
    VIEWS,
    arrays_of,
    heavier,
    perturbed,
    with_people,
    writable,
)
from crowdbot.testing.worlds import World, portal_world, random_world, straight_world

#: Random worlds that each check looks at.
_SEEDS = range(10)
_DIRECTIONS = ("higher", "lower", "reference", "none")


def check_label(component: Component[Any]) -> None:
    """Symbol, category, unit, direction and variants are declared, and laws name variants.

    If this fails, use ``MetricComponent(label=ScoreLabel(...))``; ``units``, ``betters`` and
    ``laws`` are keyed by variant.
    """
    assert isinstance(component, MetricComponent), "no MetricComponent: where is its label?"
    label = component.label
    assert label.metric == component.kind, f"the label is that of {label.metric}"
    for name in ("symbol", "category", "unit"):
        assert getattr(label, name).strip(), f"the label has no {name}"
    assert label.variants, "the label has no variant"
    assert len(set(label.variants)) == len(label.variants), "a variant is listed twice"
    assert {label.better, *label.betters.values()} <= set(_DIRECTIONS), "no such direction"
    for name, keyed in (("units", label.units), ("betters", label.betters)):
        assert set(keyed) <= set(label.variants), f"{name}: no such variant"
    assert set(component.laws) <= set(label.variants), "laws: no such variant"


def check_scores_are_well_formed(component: Component[Any]) -> None:
    """Each variant is scored once; numbers are finite and within their bounds, or there is none.

    If this fails, return one score a variant, made by the label, with a status and a reason
    instead of NaN, infinity or an exception; or correct ``least``, ``most`` and ``whole``.
    """
    for seed in _SEEDS:
        world = signalled(component, random_world(seed))
        for part in (world, replace(world, robot_alone=None, crowd_alone=None)):
            _assert_well_formed(component, scores_of(component, part))


def check_degenerate_runs(component: Component[Any]) -> None:
    """Nobody, one sample, no robot, everybody standing or absent: a status, never an exception.

    If this fails, look at the run that is named: the metric took something for granted.
    """
    for name, world in degenerate.worlds().items():
        try:
            _assert_well_formed(component, scores_of(component, world))
            _assert_well_formed(component, scores_of(component, signalled(component, world)))
        except Exception as error:
            raise AssertionError(f"{name}: {error}") from error


def check_pure(component: Component[Any]) -> None:
    """Inputs stay as they are, and the same input gives the same scores.

    If this fails, copy before you change an array, and keep nothing between two calls.
    """
    for seed in _SEEDS:
        world = signalled(component, random_world(seed))
        open_world = writable(world)
        before = arrays_of(open_world)
        first = scores_of(component, open_world)
        changed = [name for name, data in arrays_of(open_world).items() if before[name] != data]
        assert not changed, f"changed its input: {', '.join(changed)}"
        assert scores_of(component, writable(world)) == first, "the same run scored differently"
        assert scores_of(component, world) == first, "the same run scored differently"


def check_point_of_view(component: Component[Any]) -> None:
    """Translation, rotation, reflection, a later start and another order of people change nothing.

    If this fails, an angle is not wrapped, a coordinate is used for itself, or time counts from
    zero; or name the view in ``Laws(exceptions=...)`` and say why.
    """
    for seed in _SEEDS:
        world = signalled(component, random_world(seed))
        found = scores_of(component, world)
        for name, view in VIEWS.items():
            seen = _each_command(_each_run(world, view), COMMAND_VIEWS.get(name))
            again = scores_of(component, seen)
            _assert_same(component, found, again, name)


def check_itself(component: Component[Any]) -> None:
    """A run that is its own reference scores what ``Laws(itself=...)`` says.

    If this fails, numerator and denominator are not computed alike.
    """
    for seed in _SEEDS:
        run = signalled(component, random_world(seed)).run
        found = scores_of(component, World(run=run, robot_alone=run, crowd_alone=run))
        for variant, one in found.items():
            expected = laws_of(component, variant).itself
            if expected is not None and one.value is not None:
                assert _near(one.value, expected), f"{variant}: {one.value}, not {expected}"


def check_sampling(component: Component[Any]) -> None:
    """The same straight motion, sampled twice as often, scores as ``Laws(finer=...)`` says.

    If this fails, a sum over samples lacks its dt, or has one too many.
    """
    for seed in range(4):
        coarse = scores_of(component, signalled(component, straight_world(seed, 32.0)))
        fine = scores_of(component, signalled(component, straight_world(seed, 64.0)))
        for variant, one in coarse.items():
            _assert_sampled(variant, laws_of(component, variant).finer, one, fine[variant])


def check_more_people(component: Component[Any]) -> None:
    """One person more moves the value only the way that ``Laws(more_people=...)`` says.

    If this fails, people are averaged where the nearest, or the sum, was meant.
    """
    promised = {v: laws_of(component, v).more_people for v in variants_of(component)}
    if set(promised.values()) == {"free"}:
        return

    for seed in _SEEDS:
        world = signalled(component, random_world(seed))
        assert world.run.agents is not None
        columns = range(len(world.run.agents.id))
        more = scores_of(component, world)
        for left_out in columns:
            fewer = with_people(world.run, [c for c in columns if c != left_out])
            for variant, one in scores_of(component, replace(world, run=fewer)).items():
                _assert_ordered(variant, promised[variant], one, more[variant])


def check_masses(component: Component[Any]) -> None:
    """All masses times c multiply the value by c to the power ``Laws(mass=...)``.

    If this fails, masses enter where they should not, or not where they should.
    """
    for seed in _SEEDS:
        world = signalled(component, random_world(seed))
        light = scores_of(component, world)
        heavy = scores_of(component, _each_run(world, lambda run: heavier(run, 4.0)))
        for variant, one in light.items():
            assert one.status == heavy[variant].status, variant
            if one.value is not None:
                expected = one.value * 4.0 ** laws_of(component, variant).mass
                assert _near(heavy[variant].value, expected), f"{variant}: {heavy[variant]}"


def check_teleports_add_nothing(component: Component[Any]) -> None:
    """People who pass a portal score like people who walk on.

    If this fails, a flagged jump counts as a step: as length, as speed, as a contact. Declare
    ``teleport`` in ``Laws(exceptions=...)`` only where places themselves are compared.
    """
    for seed in range(4):
        walked = scores_of(component, signalled(component, portal_world(seed, through=False)))
        jumped = scores_of(component, signalled(component, portal_world(seed, through=True)))
        _assert_same(component, walked, jumped, "teleport")


def check_rounding(component: Component[Any]) -> None:
    """Inputs that are off by 1e-12 change no status and no integer.

    If this fails, compare with a tolerance instead of with equality.
    """
    for seed in _SEEDS:
        _assert_robust(component, signalled(component, random_world(seed)), seed)
    for name, world in degenerate.on_thresholds().items():
        for seed in range(3):
            try:
                _assert_robust(component, world, seed)
            except AssertionError as error:
                raise AssertionError(f"{name}: {error}") from error


CHECKS: tuple[Callable[[Component[Any]], None], ...] = (
    check_label,
    check_card_says_what_the_scores_say,
    check_card_examples_run,
    check_scores_are_well_formed,
    check_degenerate_runs,
    check_pure,
    check_point_of_view,
    check_itself,
    check_sampling,
    check_more_people,
    check_masses,
    check_teleports_add_nothing,
    check_rounding,
)


# ------------------------------------------------------------------------- details
def _each_run(world: World, change: Callable[[Trajectories], Trajectories]) -> World:
    def changed(run: Trajectories | None) -> Trajectories | None:
        return None if run is None else change(run)

    return replace(
        world,
        run=change(world.run),
        robot_alone=changed(world.robot_alone),
        crowd_alone=changed(world.crowd_alone),
    )


def _each_command(world: World, change: Callable[[Commands], Commands] | None) -> World:
    def changed(commands: Commands | None) -> Commands | None:
        return None if commands is None or change is None else change(commands)

    if change is None:
        return world
    return replace(
        world,
        commands=changed(world.commands),
        commands_baseline=changed(world.commands_baseline),
    )


# --------------------------------------------------------------------- assertions
def _assert_well_formed(component: Component[Any], found: Scored) -> None:
    assert tuple(found) == variants_of(component), f"scored {', '.join(found)}"
    for variant, one in found.items():
        _assert_numbers(one)
        _assert_labelled(component, one)
        if one.value is not None:
            laws = laws_of(component, variant)
            slack = 1e-9 * max(1.0, abs(one.value))
            bounds = f"{variant}: {one.value} is not within {laws.least} to {laws.most}"
            assert laws.least - slack <= one.value <= laws.most + slack, bounds
            assert not laws.whole or one.value == int(one.value), f"{variant}: {one.value}"


def _assert_numbers(one: Score) -> None:
    assert (one.value is None) == (one.status != "ok"), f"{one.variant}: {one}"
    assert bool(one.reason) == (one.status != "ok"), f"{one.variant}: a reason goes with no value"
    numbers = [one.value, one.lower, one.upper, *one.extras.values()]
    assert all(math.isfinite(n) for n in numbers if n is not None), f"{one.variant}: {one}"
    bounded = one.lower is not None or one.upper is not None
    assert one.status == "censored" or not bounded, f"{one.variant}: bounds without being censored"
    if one.lower is not None and one.upper is not None:
        assert one.lower <= one.upper, f"{one.variant}: bounds in the wrong order"


def _assert_labelled(component: Component[Any], one: Score) -> None:
    assert isinstance(component, MetricComponent)
    label = component.label
    expected = (
        label.metric,
        label.symbol,
        label.category,
        label.units.get(one.variant, label.unit),
        label.betters.get(one.variant, label.better),
    )
    found = (one.metric, one.symbol, one.category, one.unit, one.better)
    assert found == expected, f"{one.variant} says {found}, its label {expected}"


def _assert_same(component: Component[Any], one: Scored, two: Scored, change: str) -> None:
    for variant, a in one.items():
        if change in laws_of(component, variant).exceptions:
            continue
        b = two[variant]
        assert (a.status, a.reason) == (b.status, b.reason), f"{change}, {variant}: {a} {b}"
        for name in ("value", "lower", "upper"):
            assert _near(getattr(a, name), getattr(b, name)), (
                f"{change}, {variant}: {name} {getattr(a, name)} became {getattr(b, name)}"
            )


def _assert_sampled(variant: str, law: str, coarse: Score, fine: Score) -> None:
    if law == "free":
        return
    assert coarse.status == fine.status, f"{variant}: {coarse.status} became {fine.status}"
    if coarse.value is None or fine.value is None:
        return
    factor, slack = {"same": (1, 1e-9), "near": (1, 0.05), "double": (2, 0.05)}[law]
    expected = factor * coarse.value
    close = math.isclose(
        fine.value, expected, rel_tol=slack, abs_tol=1e-9 + slack * (law == "near")
    )
    assert close, f"{variant}: {coarse.value} became {fine.value}, which is not {law}"


def _assert_ordered(variant: str, law: str, fewer: Score, more: Score) -> None:
    if law == "free" or fewer.value is None or more.value is None:
        return
    up = more.value - fewer.value if law == "up" else fewer.value - more.value
    assert up >= -1e-9 * max(1.0, abs(more.value)), (
        f"{variant}: {fewer.value} became {more.value} with one person more"
    )


def _assert_robust(component: Component[Any], world: World, seed: int) -> None:
    found = scores_of(component, world)
    again = scores_of(component, _each_run(world, lambda run: perturbed(run, 1e-12, seed)))
    for variant, a in found.items():
        b = again[variant]
        assert (a.status, a.reason) == (b.status, b.reason), f"{variant}: {a} became {b}"
        if laws_of(component, variant).whole:
            assert a.value == b.value, f"{variant}: {a.value} became {b.value}"


def _near(a: float | None, b: float | None) -> bool:
    if a is None or b is None:
        return a is b
    return bool(np.isclose(a, b, rtol=1e-6, atol=1e-9))
