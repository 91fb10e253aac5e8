"""Velocities among which people choose, which make recordings smaller."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from crowdbot.core.types.arrays import Array


@dataclass(frozen=True, slots=True)
class VelocityCandidates:
    """Candidates for everyone who follows a policy, relative to the goal direction.

    A person of preferred speed s whose goal lies in the direction (cos b, sin b) chooses one of the
    velocities s R(b) c, where c is one of the candidates and R(b) turns by b, and approaches it as
    far as the largest acceleration allows: a = (s R(b) c - v) / ``relaxation_time``.

    Attributes:
        unit: (S, 2) candidates of a person with speed 1 m/s who walks along x.
        relaxation_time: s.

    Raises:
        ValueError: a number is not finite, or the relaxation time not positive.
    """

    unit: Array
    relaxation_time: float

    def __post_init__(self) -> None:
        if self.unit.ndim != 2 or self.unit.shape[1] != 2 or not np.all(np.isfinite(self.unit)):
            raise ValueError(f"candidates must be finite numbers (S, 2), not {self.unit.shape}")
        if not (np.isfinite(self.relaxation_time) and self.relaxation_time > 0.0):
            raise ValueError(f"the relaxation time is {self.relaxation_time!r} s")
