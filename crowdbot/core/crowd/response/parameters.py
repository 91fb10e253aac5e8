"""Parameters of the response to robots, as an object and as the records that kernels take."""

from __future__ import annotations

import math
from dataclasses import dataclass

from crowdbot.core.support.records import Rows, record_type, record_values, rows_in


class DecisionResponse:
    """Parameters of `crowdbot.core.crowd.response.evasion`; as of `Human`, where not said.

    Attributes:
        view_cosine: of half the field of view.
        lateral, braking, total: largest accelerations.
        decision: time between decisions, s.
        seen_standing, seen_moving: `Human.standing_speed`, `Human.moving_speed`.
        all_stop: 1 if all stop short.
    """

    sight: float
    view_cosine: float
    late_time: float
    late_gap: float
    reaction_time: float
    horizon: float
    clearance: float
    lateral: float
    braking: float
    total: float
    stop_gap: float
    decision: float
    late_time_standing: float
    seen_standing: float
    seen_moving: float
    all_stop: float


class TickResponse:
    """Parameters of `crowdbot.core.crowd.step.tick`; as of `Human`."""

    standing_speed: float
    moving_speed: float
    least_braking: float
    standing_gap: float
    standing_stiffness: float


DECISION_RESPONSE, TICK_RESPONSE = record_type(DecisionResponse), record_type(TickResponse)


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

    def by_decision(self, dt: float) -> Rows[DecisionResponse]:
        """(1,) the numbers for decisions that come every ``dt`` seconds."""
        numbers = record_values(
            DECISION_RESPONSE,
            sight=self.sight,
            view_cosine=math.cos(0.5 * self.field_of_view),
            late_time=self.late_time,
            late_gap=self.late_gap,
            reaction_time=self.reaction_time,
            horizon=self.horizon,
            clearance=self.clearance,
            lateral=self.lateral_acceleration,
            braking=self.braking,
            total=self.total_acceleration,
            stop_gap=self.stop_gap,
            decision=dt,
            late_time_standing=self.late_time_standing,
            seen_standing=self.standing_speed,
            seen_moving=self.moving_speed,
            all_stop=self.all_stop_short,
        )
        return rows_in(numbers, DECISION_RESPONSE)

    @property
    def by_tick(self) -> Rows[TickResponse]:
        """(1,) the numbers for ticks."""
        numbers = record_values(
            TICK_RESPONSE,
            standing_speed=self.standing_speed,
            moving_speed=self.moving_speed,
            least_braking=self.braking,
            standing_gap=self.standing_gap,
            standing_stiffness=self.standing_stiffness,
        )
        return rows_in(numbers, TICK_RESPONSE)
