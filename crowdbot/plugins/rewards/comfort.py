"""Reward of progress, less the discomfort of people."""

from __future__ import annotations

from typing import Literal

from crowdbot.plugin import Component, default
from crowdbot.plugins.rewards.progress import Amount, ProgressSpec


class ComfortSpec(ProgressSpec):
    """``progress``, less the distance driven towards people who have little space.

    The distance driven towards people, weighted by what they lack of 0.75 m, is the quantity of the
    score of comfort, ``intrusion.rate``.
    """

    kind: Literal["comfort"] = "comfort"  # type: ignore[assignment]
    advance: Amount = default(1.0, "Taken off for each metre towards people without room, 1/m.")


COMFORT = Component(spec=ComfortSpec, summary="progress that leaves people their room")
