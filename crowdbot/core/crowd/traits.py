"""Constant traits of a person, for compiled code."""

from __future__ import annotations

from crowdbot.core.support.records import record_type


class TraitsRecord:
    """Constant traits of a person; meanings as in `crowdbot.core.crowd.agents.Agents`.

    Attributes:
        first, end: the rows of its route.
        push: stiffness of contacts with people, walls and pillars, 1/s^2.
        limit: smallest distance of its centre from walls and pillars, m; 0 without a limit.
        chooses_origin: 1 if its origin is an area.
        stays: 1 if it may have reason to stay at a goal for a while.
    """

    id: float
    radius: float
    mass: float
    preferred_speed: float
    max_speed: float
    start_time: float
    at_goal: float
    flow: float
    first: float
    end: float
    push: float
    limit: float
    ahead: float
    guide: float
    abreast: float
    chooses_origin: float
    stays: float


TRAITS = record_type(TraitsRecord)
