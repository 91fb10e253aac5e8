"""Constant offset, without random draws."""

from __future__ import annotations

import numpy as np

from crowdbot.plugin import Array
from crowdbot.plugins.noise.offset import OffsetSpec


class Offset:
    """Adds the same distance to every hit."""

    random = False

    def __init__(self, spec: OffsetSpec) -> None:
        self._value = spec.value

    def errors(self, distance: Array, rng: np.random.Generator) -> Array:
        """Return errors (N,), m."""
        del rng
        return np.full(len(distance), self._value)


build = Offset
