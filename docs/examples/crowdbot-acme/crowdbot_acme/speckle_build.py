"""Speckle, computed."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from crowdbot_acme.speckle import SpeckleSpec

Array = NDArray[np.float64]


class Speckle:
    """Draws for every beam, so that what one hits does not change the noise of the others."""

    random = True

    def __init__(self, spec: SpeckleSpec) -> None:
        self._relative = spec.relative

    def errors(self, distance: Array, rng: np.random.Generator) -> Array:
        """Errors (N,), m; 0 where nothing was hit."""
        drawn = rng.standard_normal(len(distance))
        return self._relative * drawn * np.where(np.isfinite(distance), distance, 0.0)


def build(spec: SpeckleSpec) -> Speckle:
    """A generator from its spec."""
    return Speckle(spec)
