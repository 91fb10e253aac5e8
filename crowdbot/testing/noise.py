"""Checks for every noise generator."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from crowdbot.core.registry.registry import Registry
from crowdbot.core.sensing.sensor import NoiseGenerator
from crowdbot.dsl.spec.component import Component
from crowdbot.testing.around import each_built

#: Distances as passed by sensors: near and far hits, no hit, no ray.
_DISTANCES = (
    np.array([0.0, 0.02, 0.5, 1.0, 4.4, 100.0]),
    np.full(6, np.inf),
    np.array([np.inf, 1.0, np.inf, 2.0, 3.0, np.inf]),
    np.zeros(6),
)


def check_errors_are_numbers(component: Component[Any], registry: Registry | None = None) -> None:
    """Errors are finite float64, one per distance, also for beams without a hit.

    If this fails, return ``np.zeros(len(distance))`` plus what you add; inf - inf is NaN.
    """
    for generator in _generators(component, registry):
        for distance in (*_DISTANCES, np.zeros(0), np.array([2.0])):
            errors = generator.errors(distance.copy(), _rng())
            assert isinstance(errors, np.ndarray), f"returned a {type(errors).__name__}"
            assert errors.dtype == np.float64, f"returned {errors.dtype}"
            assert errors.shape == distance.shape, f"{errors.shape} for {distance.shape}"
            assert np.all(np.isfinite(errors)), f"{errors} for distances {distance}"


def check_distances_are_unchanged(
    component: Component[Any], registry: Registry | None = None
) -> None:
    """The given distances are not changed.

    If this fails, return the errors instead of adding them.
    """
    for generator in _generators(component, registry):
        for distance in _DISTANCES:
            given = distance.copy()
            generator.errors(given, _rng())
            assert np.array_equal(given, distance), f"changed {distance} into {given}"


def check_draws_do_not_depend_on_distances(
    component: Component[Any], registry: Registry | None = None
) -> None:
    """The number of random draws does not depend on the distances.

    If this fails, draw for every beam, also for those that need none: otherwise one beam's hit
    changes the noise of the others.
    """
    for generator in _generators(component, registry):
        states = []
        for distance in _DISTANCES:
            rng = _rng()
            generator.errors(distance.copy(), rng)
            states.append(_state(rng))
        assert all(s == states[0] for s in states), "the number of draws depends on the distances"


def check_random_says_whether_it_draws(
    component: Component[Any], registry: Registry | None = None
) -> None:
    """``random`` is true if and only if random numbers are drawn.

    If this fails, correct ``random``: if it is false, the sensor passes a generator that others
    also use.
    """
    for generator in _generators(component, registry):
        assert isinstance(generator.random, bool), "'random' must be True or False"
        rng = _rng()
        for distance in _DISTANCES:
            generator.errors(distance.copy(), rng)
        drew = _state(rng) != _state(_rng())
        assert drew == generator.random, f"random is {generator.random}, numbers drawn: {drew}"


def check_equal_draws_give_equal_errors(
    component: Component[Any], registry: Registry | None = None
) -> None:
    """Equal distances and equal random numbers give equal errors, regardless of earlier calls.

    If this fails, the generator keeps something between two readings, or draws from elsewhere.
    """
    for one, two in zip(
        _generators(component, registry), _generators(component, registry), strict=True
    ):
        first = [one.errors(d.copy(), _rng()) for d in _DISTANCES]
        again = [two.errors(d.copy(), _rng()) for d in reversed(_DISTANCES)][::-1]
        assert all(np.array_equal(a, b) for a, b in zip(first, again, strict=True)), (
            "the same reading got another error"
        )


def _generators(component: Component[Any], registry: Registry | None) -> Iterator[NoiseGenerator]:
    return each_built(component, registry)


def _rng() -> np.random.Generator:
    return np.random.Generator(np.random.Philox(key=7))


def _state(rng: np.random.Generator) -> str:
    return repr(rng.bit_generator.state)
