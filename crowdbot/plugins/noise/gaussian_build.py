"""Gaussian noise: one normal number for each beam."""

from __future__ import annotations

import numpy as np

from crowdbot.plugin import Array
from crowdbot.plugins.noise.gaussian import GaussianSpec


class Gaussian:
    """Draws for every beam, so that one beam's noise does not depend on what the others hit."""

    random = True

    def __init__(self, spec: GaussianSpec) -> None:
        self._std, self._mean = spec.std, spec.mean

    def errors(self, distance: Array, rng: np.random.Generator) -> Array:
        """Errors (N,), m."""
        errors = rng.standard_normal(len(distance))
        errors *= self._std
        if self._mean != 0.0:
            errors += self._mean
        return errors


def build(spec: GaussianSpec) -> Gaussian:
    """A generator from its spec."""
    return Gaussian(spec)
