"""Parameters of the response to robots, as an object and as the arrays that kernels take."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from crowdbot.core.types.arrays import Array


@dataclass(frozen=True, slots=True, kw_only=True)
class Human:
    """People notice a robot, think, and evade it within what legs can do.

    Attributes:
        sight: surface gap within which attentive people notice, and beyond which all forget, m.
        field_of_view: full angle about the way faced in which people notice, rad.
        late_time, late_time_standing: time to contact at which late people notice a robot that
            moves, and one that stands, s.
        late_gap: surface gap at which late people notice in any case, m.
        reaction_time: from noticing to doing something, s.
        horizon: how far ahead in time people look, s.
        clearance: gap that they want when they pass, m.
        lateral_acceleration: largest sideways, m/s^2.
        braking: largest against the own way, m/s^2.
        total_acceleration: largest of own will and evasion together, m/s^2.
        stop_gap: gap at which those who brake come to rest, m.
        standing_speed, moving_speed: a robot stands below the first, moves above the second and
            is something between the two in between, m/s.
        standing_gap: gap that people keep to a robot that stands, m.
        standing_stiffness: how firmly they keep it, 1/s^2.
        shown_to_policies: whether crowd policies of attentive people are shown robots, too.
        all_stop_short: whether those who take no notice of robots stop short of one that stands.
    """

    sight: float = 6.0
    field_of_view: float = math.radians(200.0)
    late_time: float = 0.7
    late_time_standing: float = 2.5
    late_gap: float = 0.3
    reaction_time: float = 0.3
    horizon: float = 3.0
    clearance: float = 0.25
    lateral_acceleration: float = 2.0
    braking: float = 3.0
    total_acceleration: float = 3.0
    stop_gap: float = 0.25
    standing_speed: float = 0.05
    moving_speed: float = 0.3
    standing_gap: float = 0.2
    standing_stiffness: float = 100.0
    shown_to_policies: bool = False
    all_stop_short: bool = False

    def by_decision(self, dt: float) -> Array:
        """What `crowdbot.core.crowd.response.evasion` takes; ``dt`` (s) between decisions."""
        return np.array(
            [
                self.sight, math.cos(0.5 * self.field_of_view), self.late_time, self.late_gap,
                self.reaction_time, self.horizon, self.clearance, self.lateral_acceleration,
                self.braking, self.total_acceleration, self.stop_gap, dt,
                self.late_time_standing, self.standing_speed, self.moving_speed,
                self.all_stop_short,
            ]
        )  # fmt: skip

    @property
    def by_tick(self) -> Array:
        """What `crowdbot.core.crowd.step.tick` takes."""
        near = self.braking, self.standing_gap, self.standing_stiffness
        return np.array([self.standing_speed, self.moving_speed, *near])


# Entries of `Human.by_decision`.
(
    SIGHT, VIEW_COSINE, LATE_TIME, LATE_GAP, REACTION_TIME, HORIZON, CLEARANCE, LATERAL, BRAKING,
    TOTAL, STOP_GAP, DECISION, LATE_TIME_STANDING, SEEN_STANDING, SEEN_MOVING, ALL_STOP,
) = range(16)  # fmt: skip
# Entries of `Human.by_tick`.
STANDING_SPEED, MOVING_SPEED, LEAST_BRAKING, STANDING_GAP, STANDING_STIFFNESS = range(5)
