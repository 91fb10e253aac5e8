"""Parameters of people's response to robots: one object, and records for compiled code."""

from __future__ import annotations

import math
from dataclasses import dataclass

from crowdbot.core.support.records import Rows, record_type, record_values, rows_in


class DecisionResponse:
    """Parameters of `crowdbot.core.crowd.response.evasion`; meanings as in `Human`.

    Attributes:
        view_cosine: cosine of half the field of view.
        lateral, braking, total: largest accelerations.
        decision: time between decisions, s.
        seen_standing, seen_moving: `Human.standing_speed`, `Human.moving_speed`.
        all_stop: 1 if `Human.all_stop_short`.
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
    sight_time: float
    hearing_time: float
    clearance_range: float
    clearance_growth: float
    clearance_speed: float
    most_clearance: float
    yield_time: float
    waiting_speed: float
    speeding_up: float
    intent: float


class TickResponse:
    """Parameters of `crowdbot.core.crowd.step.tick`; meanings as in `Human`."""

    standing_speed: float
    moving_speed: float
    least_braking: float
    standing_gap: float
    standing_stiffness: float


DECISION_RESPONSE, TICK_RESPONSE = record_type(DecisionResponse), record_type(TickResponse)


@dataclass(frozen=True, slots=True, kw_only=True)
class Human:
    """People notice a robot, react after a delay, and evade it within human limits.

    Attributes:
        sight: surface gap within which attentive people notice, and beyond which all forget, m.
        field_of_view: full angle around the facing direction in which people notice, rad.
        late_time, late_time_standing: time to contact at which late people notice a moving and a
            standing robot, s.
        late_gap: surface gap at which late people always notice, m.
        reaction_time: from noticing to reacting, s.
        horizon: time horizon, s.
        clearance: desired gap when passing, m.
        lateral_acceleration: largest sideways, m/s^2.
        braking: largest deceleration, m/s^2.
        total_acceleration: largest sum of desired acceleration and evasion, m/s^2.
        stop_gap: gap after braking, m.
        standing_speed, moving_speed: a robot stands below the first and moves above the second,
            with a smooth transition, m/s.
        standing_gap: gap to a standing robot, m.
        standing_stiffness: stiffness of that gap, 1/s^2.
        shown_to_policies: True if policies of attentive people also see robots.
        all_stop_short: True if people who ignore robots stop in front of a standing one.
        sight_time: time to contact within which attentive people notice beyond ``sight``, s.
        hearing_time: the same for robots faster than ``clearance_speed`` that come from behind,
            s; 0: people do not hear.
        clearance_range: half the range of the desired gap over people, m: attentive people keep
            more, inattentive ones less.
        clearance_growth: growth of the desired gap with the robot's speed above
            ``clearance_speed``, s.
        clearance_speed: m/s.
        most_clearance: largest desired gap by growth, m.
        yield_time: people pass behind a crossing robot, even by a longer way, if it is longer by
            less than the robot drives in this time, s.
        waiting_speed: people wait for a faster robot that crosses their way, however long it is,
            m/s.
        speeding_up: largest acceleration in one's own direction by which people evade, m/s^2.
        intent: time over which people's desired acceleration counts in their prediction, s:
            people who wait expect to walk on.
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
    sight_time: float = 0.0
    hearing_time: float = 0.0
    clearance_range: float = 0.0
    clearance_growth: float = 0.0
    clearance_speed: float = 1.0
    most_clearance: float = 0.0
    yield_time: float = 0.0
    waiting_speed: float = math.inf
    speeding_up: float = math.inf
    intent: float = 0.0

    def by_decision(self, dt: float) -> Rows[DecisionResponse]:
        """Return the record (1,) for decisions every ``dt`` seconds."""
        numbers = record_values(
            DECISION_RESPONSE,
            self,
            view_cosine=math.cos(0.5 * self.field_of_view),
            lateral=self.lateral_acceleration,
            total=self.total_acceleration,
            decision=dt,
            seen_standing=self.standing_speed,
            seen_moving=self.moving_speed,
            all_stop=self.all_stop_short,
        )
        return rows_in(numbers, DECISION_RESPONSE)

    @property
    def by_tick(self) -> Rows[TickResponse]:
        """Return the record (1,) for ticks."""
        numbers = record_values(TICK_RESPONSE, self, least_braking=self.braking)
        return rows_in(numbers, TICK_RESPONSE)
