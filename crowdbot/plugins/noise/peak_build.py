"""Peak noise: one beam in a hundred is off by a normally distributed distance."""

from __future__ import annotations

import numpy as np

from crowdbot.plugin import Array
from crowdbot.plugins.noise.peak import PeakSpec


class Peak:
    """Draws chance and size for every beam, so that beams do not depend on each other."""

    random = True

    def __init__(self, spec: PeakSpec) -> None:
        self._probability, self._mean, self._std = spec.probability, spec.mean, spec.std

    def errors(self, distance: Array, rng: np.random.Generator) -> Array:
        """Return errors (N,), m; most are 0."""
        struck = rng.random(len(distance)) < self._probability
        return struck * (self._mean + self._std * rng.standard_normal(len(distance)))


build = Peak
