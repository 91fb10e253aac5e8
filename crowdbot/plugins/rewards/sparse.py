"""Sparse reward: arrival, contact, and little space around people."""

from __future__ import annotations

from typing import Annotated, Literal

from annotated_types import Ge, Le

from crowdbot.plugin import Component, NonNegativeLength, RewardSpec, default

Amount = Annotated[float, Ge(0.0), Le(1e6)]


class SparseSpec(RewardSpec):
    """1 for arrival, less for contact and for little room, as in CADRL.

    Source: Chen, Liu, Everett, How, "Decentralized non-communicating multiagent collision avoidance
    with deep reinforcement learning", ICRA 2017, equation 6: -0.25 for a contact, and
    -0.1 - d/2 where the gap d to the nearest person is below 0.2 m. There, contact ends the
    episode; here it counts in every step with contact, unless the environment ends it.
    """

    kind: Literal["sparse"] = "sparse"
    arrival: Amount = default(1.0, "For arriving, a number.")
    contact: Amount = default(0.25, "Taken off for a step with contact, a number.")
    near: NonNegativeLength = default(0.2, "Gap to people without cost, m.")
    nearness: Amount = default(0.1, "Taken off for any smaller gap, a number.")
    slope: Amount = default(0.5, "Taken off besides, for each metre of gap, 1/m.")


SPARSE = Component(spec=SparseSpec, summary="arrival, contact and little room, as in CADRL")
