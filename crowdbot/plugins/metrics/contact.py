"""Metrics of contact forces, from the simulator or the robot's skin."""

from __future__ import annotations

from functools import partial
from typing import Literal

from crowdbot.plugin import MetricSpec, declare_metric

declare = partial(declare_metric, category="contact", better="lower", minimum=0.0, more_people="up")


class MaxContactForceSpec(MetricSpec):
    """Largest force between robot and people."""

    kind: Literal["max_contact_force"] = "max_contact_force"


MAX_CONTACT_FORCE = declare(MaxContactForceSpec, symbol="F_max", unit="N", mass_exponent=1)


class ContactImpulseSpec(MetricSpec):
    """Sum of the impulses between robot and people."""

    kind: Literal["contact_impulse"] = "contact_impulse"


CONTACT_IMPULSE = declare(ContactImpulseSpec, symbol="I", unit="N s", mass_exponent=1)


class ContactTimeSpec(MetricSpec):
    """Sum of the durations of contacts between robot and people."""

    kind: Literal["contact_time"] = "contact_time"


CONTACT_TIME = declare(ContactTimeSpec, symbol="T_c", unit="s")
