"""Gaussian noise: one normal number per beam."""

from __future__ import annotations

import numpy as np

from crowdbot.plugin import Array
from crowdbot.plugins.noise.gaussian import GaussianSpec


class Gaussian:
    """Draws one number for every beam, so that beams are independent of each other's hits."""

    random = True

    def __init__(self, spec: GaussianSpec) -> None:
        self._std, self._mean = spec.std, spec.mean

    def errors(self, distance: Array, rng: np.random.Generator) -> Array:
        """Return errors (N,), m."""
        errors = rng.standard_normal(len(distance))
        errors *= self._std
        if self._mean != 0.0:
            errors += self._mean
        return errors


build = Gaussian
