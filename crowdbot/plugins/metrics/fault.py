"""Metrics of contacts that the robot causes, and contacts per distance."""

from __future__ import annotations

from functools import partial
from typing import Literal

import crowdbot.plugins.metrics.parameters as parameters
from crowdbot.plugin import MetricSpec, declare_metric

declare = partial(declare_metric, category="collision", better="lower", minimum=0.0)


class ContactsAtFaultSpec(MetricSpec):
    """Contacts with people that the robot drives into, and those that people walk into."""

    kind: Literal["contacts_at_fault"] = "contacts_at_fault"
    fault_speed: parameters.FaultSpeed
    fault_reaction: parameters.FaultReaction
    fault_braking: parameters.FaultBraking
    fault_margin: parameters.FaultMargin
    contact_tol: parameters.ContactTol
    release_gap: parameters.ReleaseGap
    jump_speed: parameters.JumpSpeed


CONTACTS_AT_FAULT = declare(
    ContactsAtFaultSpec,
    symbol="C_af",
    spec_version=5,
    unit="1",
    integer=True,
    more_people="up",
    refinement="same",
    variants={"corrected": {}, "person": {"better": "none"}},
)


class ContactsPerKmSpec(MetricSpec):
    """Contacts with people per kilometre of progress towards the goal."""

    kind: Literal["contacts_per_km"] = "contacts_per_km"
    least_way: parameters.LeastWay
    fault_speed: parameters.FaultSpeed
    fault_reaction: parameters.FaultReaction
    fault_braking: parameters.FaultBraking
    fault_margin: parameters.FaultMargin
    contact_tol: parameters.ContactTol
    release_gap: parameters.ReleaseGap
    jump_speed: parameters.JumpSpeed


CONTACTS_PER_KM = declare(
    ContactsPerKmSpec,
    symbol="C_km",
    spec_version=6,
    unit="1/km",
    variants={
        "corrected": {"more_people": "up", "rate_over": "way"},
        "at_fault": {"more_people": "up", "rate_over": "way"},
        "driven": {"more_people": "up", "rate_over": "driven_way"},
        "way": {"unit": "km", "better": "none"},
        "driven_way": {"unit": "km", "better": "none"},
    },
)
