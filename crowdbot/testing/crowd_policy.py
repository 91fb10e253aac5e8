"""Checks for every crowd policy."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

import crowdbot.testing.crowd_views as crowd_views
from crowdbot.core.crowd import Agents, CrowdEngine, CrowdPolicy, CrowdView, CrowdWorld
from crowdbot.core.crowd.desired_acceleration import desired_acceleration
from crowdbot.core.registry.registry import Registry
from crowdbot.core.types.arrays import Array
from crowdbot.dsl.spec.component import Component
from crowdbot.testing.around import around, built, specs_of

#: Builds a new policy for a set of agents.
Factory = Callable[[Agents], CrowdPolicy]

#: Results that differ by less are equal, since sums may be in another order, m/s or m/s^2.
_ROUNDING = 1e-6
_TURN = 0.7  # rad


def check_answer_is_numbers(component: Component[Any], registry: Registry | None = None) -> None:
    """The result is float64 (N, 2), finite for every agent that decides.

    If this fails, the policy returns something else for the named crowd: check divisions by the
    distance of people at the same position, or by the speed of standing people.
    """
    for make in _factories(component, registry):
        for seed in crowd_views.SEEDS:
            _assert_answer(f"crowd {seed}", make, crowd_views.random_view(seed))


def check_nobody_and_one(component: Component[Any], registry: Registry | None = None) -> None:
    """The policy returns numbers for edge cases.

    These are no one, one person, and people who are absent, stand, overlap or have arrived.

    If this fails, the policy makes an assumption that the named crowd does not satisfy.
    """
    for make in _factories(component, registry):
        for name, view in crowd_views.odd_views().items():
            _assert_answer(name, make, view)


def check_input_is_not_changed(component: Component[Any], registry: Registry | None = None) -> None:
    """The policy does not write to the view's arrays.

    If this fails, copy before you change an array: all agents share the view.
    """
    for make, view in _in_crowds(component, registry):
        before = crowd_views.arrays_of(view)
        _answer(make(view.agents), view)
        changed = [
            name for name, data in crowd_views.arrays_of(view).items() if before[name] != data
        ]
        assert not changed, f"changed {', '.join(changed)}"


def check_same_view_twice(component: Component[Any], registry: Registry | None = None) -> None:
    """Two policies with the same spec give bitwise equal results for the same views.

    If this fails, the policy draws from a generator that is not its own, or depends on the time.
    """
    for make in _factories(component, registry):
        views = [crowd_views.random_view(0)] * 3
        one, two = make(views[0].agents), make(views[0].agents)
        for view in views:
            same = np.array_equal(_answer(one, view), _answer(two, view))
            assert same, "the same views were answered differently"


def check_permutation_equivariant(
    component: Component[Any], registry: Registry | None = None
) -> None:
    """Decisions do not depend on the order of people.

    If this fails, decisions depend on earlier decisions of others, or people are identified by row
    instead of id.
    """
    for make in _factories(component, registry):
        for seed in crowd_views.SEEDS:
            view = crowd_views.random_view(seed)
            order = np.random.default_rng(seed).permutation(len(view.agents))
            again = crowd_views.permuted(view, order)
            _assert_same(_will(make, view)[order], _will(make, again), "another order")


def check_translation_invariant(
    component: Component[Any], registry: Registry | None = None
) -> None:
    """Decisions do not change if the crowd is moved elsewhere.

    If this fails, an absolute coordinate is used. A policy that depends on places declares
    ``Component(exceptions={"check_translation_invariant": "why"})``.
    """
    for make, view in _in_crowds(component, registry):
        there = crowd_views.moved(view, np.array([16.0, -8.0]))
        _assert_same(_will(make, view), _will(make, there), "16 m along x, -8 m along y")


def check_rotation_equivariant(component: Component[Any], registry: Registry | None = None) -> None:
    """Decisions are rotated if the crowd is rotated.

    If this fails, the axes are treated differently. A policy that depends on directions declares
    ``Component(exceptions={"check_rotation_equivariant": "why"})``.
    """
    for make, view in _in_crowds(component, registry):
        found = _will(make, crowd_views.turned(view, _TURN))
        _assert_same(crowd_views.turn(_will(make, view), _TURN), found, f"turned by {_TURN} rad")


def check_time_step_is_no_unit(component: Component[Any], registry: Registry | None = None) -> None:
    """People who decide twice as often get about as far.

    If this fails, the result is a step instead of a velocity, or a velocity instead of an
    acceleration: it must not shrink or grow with ``dt``.
    """
    for make in _factories(component, registry):
        seldom, often = (_walked(make, rate) for rate in (16.0, 32.0))
        way = np.hypot(*(seldom[-1] - seldom[0]).T)
        apart = np.hypot(*(often[-1] - seldom[-1]).T)
        limit = 0.25 * float(way.max()) + 0.05
        assert np.all(apart < limit), (
            f"with decisions twice as often people are {apart.max():.2f} m elsewhere after "
            f"{way.max():.2f} m"
        )


def _in_crowds(
    component: Component[Any], registry: Registry | None
) -> Iterator[tuple[Factory, CrowdView]]:
    """Yield each factory with random crowds."""
    for make in _factories(component, registry):
        yield from ((make, crowd_views.random_view(seed)) for seed in crowd_views.SEEDS)


def _factories(component: Component[Any], registry: Registry | None) -> Iterator[Factory]:
    """Yield one factory per example; policies that need cost functions get ``ttca_dca``."""
    known = around(component, registry)
    for spec in specs_of(component, known):
        costs = []
        if getattr(spec, "needs_costs", False):
            (words,) = specs_of(known.find("cost function", "ttca_dca"), known)
            costs = [built(known, words)]

        def make(agents: Agents, spec: Any = spec, costs: Any = costs) -> CrowdPolicy:
            policy: CrowdPolicy = built(known, spec, costs, agents)
            return policy

        yield make


def _answer(policy: CrowdPolicy, view: CrowdView) -> Array:
    if hasattr(policy, "accelerations"):
        return policy.accelerations(view)
    assert hasattr(policy, "velocities"), "what was built has no velocities and no accelerations"
    return policy.velocities(view, view.dt)


def _assert_answer(name: str, make: Factory, view: CrowdView) -> None:
    found = _answer(make(view.agents), view)
    assert isinstance(found, np.ndarray), f"{name}: returned a {type(found).__name__}"
    assert found.dtype == np.float64, f"{name}: returned {found.dtype}"
    assert found.shape == view.position.shape, f"{name}: {found.shape} for {view.position.shape}"
    assert np.all(np.isfinite(found[view.present])), f"{name}: {found.tolist()}"


def _will(make: Factory, view: CrowdView) -> Array:
    """Return the accelerations (N, 2), m/s^2, that a newly built policy requests."""
    return desired_acceleration(make(view.agents), view)


def _assert_same(one: Array, two: Array, change: str) -> None:
    off = float(np.max(np.abs(one - two), initial=0.0))
    assert off < _ROUNDING, f"{change}: answers differ by {off:.3g} m/s^2"


def _walked(make: Factory, rate: float) -> Array:
    """Return positions (T, N, 2), m, of three people who walk far apart for 1.5 s."""
    agents = Agents.of(
        x=[0.0, 0.5, 1.0],
        y=[0.0, 3.0, 6.0],
        id=[0, 1, 2],
        routes=[[(12.0, 0.0)], [(12.5, 3.0)], [(13.0, 6.0)]],
    )
    engine = CrowdEngine(agents, CrowdWorld(decision_rate=rate), make)
    _, positions = engine.run(1.5)
    return positions
