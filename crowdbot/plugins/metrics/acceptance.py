"""Metric of the opinion of people on a drive: a small monotone model, fitted to ratings."""

from __future__ import annotations

from functools import partial
from typing import Annotated, Literal

from annotated_types import Ge

import crowdbot.plugins.metrics.parameters as parameters
from crowdbot.plugin import MetricSpec, declare_metric, default

declare = partial(declare_metric, category="task")
_Weight = Annotated[float, Ge(0)]


class AcceptanceSpec(MetricSpec):
    """Opinion of people on the drive, estimated: 1 is fine, 0 is unacceptable."""

    kind: Literal["acceptance"] = "acceptance"
    not_arrived: _Weight = default(1.0, "Weight of not reaching the goal.")
    touched: _Weight = default(0.3, "Weight of touching people.")
    wall: _Weight = default(0.3, "Weight of touching walls.")
    near: _Weight = default(0.3, "Weight of 1 minus the rating of the smallest distance.")
    crowding: _Weight = default(1.5, "Weight of the share of time with a person within 0.25 m.")
    fast: _Weight = default(
        2.0,
        "Weight of the largest product of the robot's speed and what is missing to "
        "0.5 m of room, s/m².",
    )
    forcing: _Weight = default(0.3, "Weight of the largest demanded evasion, relative to 3 m/s².")
    demand_time: parameters.DemandTime
    demand_room: parameters.DemandRoom
    contact_tol: parameters.ContactTol
    release_gap: parameters.ReleaseGap
    jump_speed: parameters.JumpSpeed


ACCEPTANCE = declare(
    AcceptanceSpec,
    symbol="A",
    unit="1",
    better="higher",
    minimum=0.0,
    maximum=1.0,
    more_people="down",
)
