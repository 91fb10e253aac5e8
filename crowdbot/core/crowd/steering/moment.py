"""Moment: input of the steering parts at one decision."""

from __future__ import annotations

from typing import NamedTuple

from crowdbot.core.crowd.policy import CrowdView
from crowdbot.core.crowd.steering.sorted_discs import SortedDiscs


class Moment(NamedTuple):
    """One decision of a crowd.

    Attributes:
        near: people sorted along x, for searches of neighbours.
        relaxation: time in which the policy reaches the velocity that it has chosen, s.
        key: as of `Steering`.
    """

    view: CrowdView
    near: SortedDiscs
    relaxation: float
    key: int = 0
